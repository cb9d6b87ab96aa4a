// Contact thickness apart from the lattice: a thin cloth enters a gap that is narrower than its particles.
#include <gtest/gtest.h>

#include <cstdio>

#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/wall_gaps.hpp"
#include "tests/unit/dem/wall_pieces.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

constexpr double thickness = 0.77e-3, gap = 1e-3, depth = 0.02;  // of the cloth, of the slot, m

/// Two blocks side by side along y with a slot between them, their upper side at z = 0.
WallSet slot() {
  WallSet walls;
  walls.add_surface("left", test::solid_box({-0.05, -0.03, -depth}, {0.05, -gap / 2, 0}));
  walls.add_surface("right", test::solid_box({-0.05, gap / 2, -depth}, {0.05, 0.03, 0}));
  return walls;
}

/// An upright strip that falls onto the slot, a little beside its middle.
struct Fall {
  explicit Fall(double contact_thickness) : walls(slot()), rags(MPI_COMM_SELF, {}, {strip(contact_thickness)}) {
    ContactSettings settings;
    settings.wall_stiffness_factor = 3;
    rags.set_contacts(std::make_unique<ContactSolver>(settings, rags.rags(), &walls));
    rags.set_gravity({0, 0, -9.81});
    for (int k = 0; k < 100; ++k) {
      rags.advance(1.2e-3);
      const ContactMeasures& seen = rags.contacts()->measures();
      touches = touches || seen.n_wall_contacts > 0;
      EXPECT_EQ(seen.beyond_walls[0], 0);
      EXPECT_LT(seen.max_wall_overlap_over_radius[0], 0.5);
    }
    at_end = rag_states(rags)[0];
    std::printf("contact thickness %.2f mm: z from %.1f to %.1f mm\n", 2e3 * rags.rags()[0].wall_reach(), 1e3 * at_end.lower.z,
                1e3 * at_end.upper.z);
  }
  static RagPiece strip(double contact_thickness) {
    RagPiece piece = cloth(6, 8);
    piece.orientation = rotation_to({1, 0, 0}, {0, 0, 1});
    piece.centre = {0, 0.2e-3, 0.0095};
    piece.rag.bond_damping = 0.5, piece.rag.contact_thickness = contact_thickness;
    return piece;
  }
  WallSet walls;
  RagSystem rags;
  bool touches = false;
  RagState at_end;
};

TEST(ThinCloth, PassesAGapThatIsWiderThanItself) {
  // Requirement: particles 2 mm apart with a contact thickness of 0.77 mm fall through a slot of 1 mm, and touch it on the way.
  const Fall thin(thickness);
  EXPECT_TRUE(thin.touches);
  EXPECT_LT(thin.at_end.upper.z, -depth);
}

TEST(ThinCloth, DoesNotPassWithTheThicknessOfItsParticles) {
  // Requirement: without the key contacts are as before: cloth 2 mm thick stays on top.
  const Fall thick(0);
  EXPECT_TRUE(thick.touches);
  EXPECT_GT(thick.at_end.lower.z, 0);
}

TEST(ThinCloth, SaysWhereContactsBegin) {
  // Requirement: contact with a wall begins at half the contact thickness, of two pieces at the mean of their layer thicknesses; neighbours
  // of a flat sheet never touch; forces at the same overlap and the stable step are those of the particles.
  RagPiece thin = cloth(4, 3), thick = thin;
  thin.rag.contact_thickness = thickness, thin.rag.layer_thickness = 1.6e-3;
  const double overlap = 1e-5;
  double force[2], step[2];
  for (const bool is_thin : {false, true}) {
    for (const double distance : {overlap, -overlap}) {
      RagPiece lower = is_thin ? thin : thick, upper = lower;
      const double layer = 2 * lower.rag.layer_reach() - distance;
      upper.rag.name = "upper", upper.centre = {0, 0, layer};
      WallSet walls;
      walls.add_plane("floor", {0, 0, distance - lower.rag.wall_reach()}, {0, 0, 1});
      RagSystem rags(MPI_COMM_SELF, {}, {lower, upper});
      rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &walls));
      rags.evaluate_contacts();
      const ContactMeasures& seen = rags.contacts()->measures();
      EXPECT_EQ(seen.n_wall_contacts, distance > 0 ? 12 : 0);
      EXPECT_EQ(seen.n_contacts, distance > 0 ? 12 : 0) << "each particle with the one above, no neighbours";
      if (distance < 0) continue;
      EXPECT_NEAR(seen.max_wall_overlap_over_radius[0], overlap / lower.rag.wall_reach(), 1e-9);
      force[is_thin] = norm(rags.contacts()->forces(rags.tiles())[0]), step[is_thin] = rags.contacts()->stable_step();
    }
  }
  EXPECT_NEAR(force[1] / force[0], 1, 1e-9);
  EXPECT_EQ(step[0], step[1]);
}

TEST(ThinCloth, GapsBetweenWallsAreFound) {
  // Requirement: the slot is found with its width, between its two blocks; planes that face each other too; nothing where all is wider.
  const WallSet walls = slot();
  const std::vector<WallGap> gaps = narrow_gaps(walls, 0, 2e-3);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(gaps[0].width, gap, 1e-15);
  EXPECT_EQ(walls.parts()[static_cast<std::size_t>(gaps[0].part_1)] + " " + walls.parts()[static_cast<std::size_t>(gaps[0].part_2)],
            "solid solid");
  EXPECT_NE(gaps[0].part_1, gaps[0].part_2);
  EXPECT_TRUE(narrow_gaps(walls, 0, 0.9e-3).empty());
  WallSet box;
  box.add_box("box", {0, 0, 0}, {0.1, 0.1, 1.5e-3});
  ASSERT_EQ(narrow_gaps(box, 0, 2e-3).size(), 1u);
  EXPECT_NEAR(narrow_gaps(box, 0, 2e-3)[0].width, 1.5e-3, 1e-15);
  // A plane that comes nearer with time faces the block below it.
  WallSet closing = slot();
  closing.add_plane("lid", {0, 0, 5e-3}, {0, 0, -1}, {.axis = {0, 0, 1}, .origin = {}, .speed = 0, .velocity = {0, 0, -1}});
  EXPECT_EQ(narrow_gaps(closing, 0, 2e-3).size(), 1u);
  const std::vector<WallGap> later = narrow_gaps(closing, 4.5e-3, 2e-3);
  ASSERT_EQ(later.size(), 3u);
  EXPECT_NEAR(later[0].width, 0.5e-3, 1e-12);
}

}  // namespace
}  // namespace snag
