// A rag thrown against a wall: the hardest load of a run, and measures of the result.
#include <gtest/gtest.h>

#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "tests/unit/dem/wall_pieces.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

TEST(RagImpact, CrumplingOnlyLosesEnergy) {
  // Requirement: published cloth thrown corner first against a wall at 15 m/s, spinning, crumples with bonds bent beyond a right angle, and
  // kinetic plus bond energy falls from one millisecond to the next; no particle ends beyond the wall, none is lost.
  RagSettings settings;
  settings.length = 0.08, settings.width = 0.06, settings.density_model = RagSettings::DensityModel::jensen_2018;
  settings.position = {0, 0, 0.07}, settings.velocity = {0, 0, -15}, settings.spin = {10, 30, 50};
  settings.lengthwise = {0.15, 0.5, 1}, settings.crosswise = {0, 1, -0.5};
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  WallSet walls;
  walls.add_plane("wall", {}, {0, 0, 1});
  rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &walls));
  const auto energy = [&] {
    const RagState s = rag_states(rags)[0];
    return s.kinetic_energy + s.bond_energy;
  };
  const double start = energy();
  double before = start, after = start;
  for (int k = 0; k < 15; ++k, before = after) {
    rags.advance(1e-3);
    after = energy();
    EXPECT_LT(after, before * (k < 3 ? 1.001 : 1.05)) << k;  // elastic energy of contacts, not counted, comes back
  }
  EXPECT_LT(after, 0.3 * start);
  EXPECT_GT(rags.contacts()->measures().max_overlap_over_radius, 0);
  EXPECT_EQ(rags.contacts()->measures().beyond_walls[0], 0);
  EXPECT_EQ(rags.check()[0].whole, rags.rags()[0].n_bonds);
}

TEST(RagImpact, BoundsOfTheMotionMissNoContact) {
  // Requirement: a sheet that crumples against a wall moves to the bit as it does where the lists of contacts are made anew in each
  // sub-step: a particle that flies by far away, faster than the lists allow, sees to that.
  RagSettings settings;
  settings.length = 0.08, settings.width = 0.06;
  settings.position = {0, 0, 0.07}, settings.velocity = {0, 0, -15}, settings.spin = {10, 30, 50};
  settings.lengthwise = {0.15, 0.5, 1}, settings.crosswise = {0, 1, -0.5};
  WallSet walls;
  walls.add_plane("wall", {}, {0, 0, 1});
  std::vector<std::int64_t> n_lists;
  std::vector<RagSheet> sheets;
  for (const double speed : {0.0, 1000.0}) {
    RagPiece far = testing_pieces::cloth(1, 1);
    far.centre = {0, 0, 1}, far.velocity = {0, speed, 0};
    RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test"), far});
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &walls));
    rags.advance(8e-3);
    EXPECT_GT(rags.contacts()->measures().n_contacts, 100);
    n_lists.push_back(rags.contacts()->measures().n_lists);
    sheets.push_back(gather_sheet(rags));
  }
  EXPECT_GT(n_lists[1], 2 * n_lists[0]);
  ASSERT_EQ(sheets[0].position.size(), sheets[1].position.size());
  for (std::size_t p = 0; p + 1 < sheets[0].position.size(); ++p) EXPECT_EQ(norm(sheets[0].position[p] - sheets[1].position[p]), 0) << p;
}

TEST(RagImpact, SheetSlidesToRest) {
  // Requirement: a sheet thrown along a floor of triangles slides v^2/(2 mu g) far, as on a plane: within 1 % of it, and stays there.
  WallSet floor;
  floor.add_surface("floor", test::sheet(9, 7, [](double u, double v) { return Vec3{0.1 * u - 0.02, 0.06 * v - 0.03, 0}; }));
  const double speed = 0.3, mu = 0.3, g = 9.81;
  RagPiece piece = testing_pieces::cloth(8, 6);
  piece.rag.bond_damping = 0.5;
  piece.centre = {0, 0, 1e-3}, piece.velocity = {speed, 0, 0};
  RagSystem rags(MPI_COMM_SELF, {}, {piece});
  ContactSettings settings;
  settings.wall_friction = mu, settings.wall_restitution = 0.3;
  rags.set_contacts(std::make_unique<ContactSolver>(settings, rags.rags(), &floor));
  rags.set_gravity({0, 0, -g});
  const double start = rag_states(rags)[0].centre.x;
  rags.advance(1.5 * speed / (mu * g));
  const double stop = rag_states(rags)[0].centre.x;
  EXPECT_NEAR((stop - start) / (speed * speed / (2 * mu * g)), 1, 0.01);
  rags.advance(0.05);
  EXPECT_NEAR(rag_states(rags)[0].centre.x, stop, 1e-6);
}

TEST(RagMeasures, KnowAFlatSheet) {
  // Requirement: exact values for a flat sheet stretched lengthwise by 1 %: centre, sides, tension, strain, ratio of axes, triangles.
  RagSettings settings;
  settings.length = 0.08, settings.width = 0.04, settings.position = {1, 2, 3};
  RagPiece piece = make_piece(settings, "test");
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 40; ++column) piece.poses.push_back({{2.02e-3 * (column - 19.5), 2e-3 * (row - 9.5), 0}, {}});
  RagSystem rags(MPI_COMM_SELF, {}, {piece});
  const RagState s = rag_states(rags)[0];
  EXPECT_LT(norm(s.centre - Vec3{1, 2, 3}), 1e-14);
  EXPECT_NEAR(s.end_to_end, 39 * 2.02e-3, 1e-14);
  EXPECT_NEAR(s.upper.x - s.lower.x, 39 * 2.02e-3, 1e-14);
  EXPECT_NEAR(s.max_bond_strain, 0.01, 1e-11);
  const double tension = piece.rag.bond[0].normal_stiffness * std::numbers::pi * 1e-6 * 2e-5;
  EXPECT_NEAR(s.max_bond_tension, tension, 1e-9 * tension);
  EXPECT_NEAR(s.bond_energy, 39 * 20 * 0.5 * tension * 2e-5, 1e-9 * s.bond_energy);
  EXPECT_NEAR(s.elongation_ratio, 1.01 * std::sqrt((1600. - 1) / (400. - 1)), 1e-9);
  EXPECT_NEAR(bond_strain_quantile(rags, 0, 0.99), 0.01, 1e-11);
  EXPECT_NEAR(bond_strain_quantile(rags, 0, 0.3), 0, 1e-11);
  const RagSheet sheet = gather_sheet(rags);
  EXPECT_EQ(sheet.id.size(), 800u);
  EXPECT_EQ(sheet.triangles.size(), 2u * 39 * 19);
  EXPECT_NEAR(sheet.tension[5], tension, 1e-9 * tension);
}

}  // namespace
}  // namespace snag
