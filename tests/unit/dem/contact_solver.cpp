// Contacts of many particles: which pairs are found, that nothing depends on ranks or lists, and that history survives new lists, ranks and
// restarts.
#include "dem/contacts/contact_solver.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "base/error.hpp"
#include "dem/walls/walls.hpp"
#include "tests/unit/dem/contact_pieces.hpp"

namespace snag {
namespace {

using test::Pieces;

/// Three crumpled layers of unbonded particles in several tiles, moving at random.
Pieces stack(int columns, int rows, int side) {
  Pieces pieces;
  for (int layer = 0; layer < 3; ++layer) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Rag rag = Pieces::sphere(layer == 1 ? 1.2e-3 : 1e-3, 540);
    pieces.add(rag, columns, rows, side, false, [&](int c, int r) {
      // The generator is asked in the order of tiles: positions must depend on the place alone.
      std::mt19937 place(1000 * layer + 31 * c + r);
      const auto noise = [&] { return 1e-4 * uniform(place); };
      return Vec3{1.9e-3 * c + 0.8e-3 * (layer % 2) + noise(), 1.9e-3 * r + 0.7e-3 * (layer % 2) + noise(),
                  0.9e-3 + 1.6e-3 * layer + noise()};
    });
  }
  for (auto& tile : pieces.tiles)
    for (int j = 0; j < tile->ny; ++j)
      for (int i = 0; i < tile->nx; ++i) {
        std::mt19937 place(77 + 1000 * tile->rag + 31 * (tile->column + i) + (tile->row + j));
        std::uniform_real_distribution<double> uniform(-1, 1);
        const int k = tile->index(i, j);
        for (int f = 0; f < 3; ++f)
          tile->field(Tile::vx + f)[k] = 0.5 * uniform(place), tile->field(Tile::wx + f)[k] = 200 * uniform(place);
      }
  return pieces;
}

/// A tight box about the stack of 9 x 7 columns and rows.
WallSet box_wall() {
  WallSet walls;
  walls.add_box("box", {-1e-3, -1e-3, 0}, {17.0e-3, 13.2e-3, 5.0e-3});
  return walls;
}

std::vector<double> forces(const Pieces& pieces, std::size_t tile) {
  const Tile& t = *pieces.tiles[tile];
  std::vector<double> all;
  for (int f = Tile::fx; f <= Tile::tz; ++f)
    for (int j = 0; j < t.ny; ++j) all.insert(all.end(), t.field(f) + t.index(0, j), t.field(f) + t.index(t.nx, j));
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void copy_state(const Pieces& from, Pieces& to) {
  for (std::size_t t = 0; t < from.tiles.size(); ++t) to.tiles[t]->values = from.tiles[t]->values;
}

// Contacts within a piece and between pieces are two switches: together they are all contacts.
TEST(ContactSolver, ContactsWithinAndBetweenPieces) {
  const auto count = [](bool within, bool between) {
    Pieces pieces = stack(9, 7, 4);
    ContactSettings settings;
    settings.self_contact = within, settings.mutual_contact = between;
    ContactSolver contacts(settings, pieces.rags, nullptr);
    contacts.add_forces(pieces.owned(), {}, 1e-6);
    return contacts.measures().n_contacts;
  };
  EXPECT_GT(count(true, false), 0);
  EXPECT_GT(count(false, true), 0);
  EXPECT_EQ(count(true, false) + count(false, true), count(true, true));
  EXPECT_EQ(count(false, false), 0);
}

// All pairs that touch are found, and each force is the sum of the law over them: compared with a search through all pairs.
TEST(ContactSolver, FindsEveryContact) {
  Pieces pieces = stack(9, 7, 4);
  ContactSettings settings;
  ContactSolver contacts(settings, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  contacts.add_forces(tiles, {}, 1e-6);
  std::int64_t n = 0;
  double worst = 0;
  struct Place {
    const Tile* tile;
    int k;
  };
  std::vector<Place> all;
  for (const auto& tile : pieces.tiles)
    for (int j = 0; j < tile->ny; ++j)
      for (int i = 0; i < tile->nx; ++i) all.push_back({tile.get(), tile->index(i, j)});
  for (std::size_t a = 0; a < all.size(); ++a) {
    double normal_sum = 0;
    for (std::size_t b = 0; b < all.size(); ++b) {
      const double reach = pieces.rags[all[a].tile->rag].radius + pieces.rags[all[b].tile->rag].radius;
      const double d = norm(all[a].tile->vector(Tile::x, all[a].k) - all[b].tile->vector(Tile::x, all[b].k));
      if (a == b || d >= reach) continue;
      n += a < b;
      normal_sum += 1;
    }
    const double force = norm(all[a].tile->vector(Tile::fx, all[a].k));
    EXPECT_EQ(force > 0, normal_sum > 0);
    worst = std::max(worst, force);
  }
  EXPECT_GT(n, 400);
  EXPECT_EQ(contacts.measures().n_contacts, n);
  EXPECT_GT(worst, 0);
}

// Cloth at rest has no contacts; a broken bond makes its two particles partners; a whole one never does, and diagonal neighbours touch when
// sheared together.
TEST(ContactSolver, BondedNeighboursDoNotTouch) {
  Pieces pieces;
  Rag rag = Pieces::sphere(1e-3, 540);
  rag.breakage = true;
  pieces.add(rag, 6, 5, 3, true, [](int c, int r) { return Vec3{1.9e-3 * c, 1.9e-3 * r, 0}; });  // compressed: bonded neighbours overlap
  ContactSolver contacts(ContactSettings{}, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_contacts, 0);

  // Between columns 2 and 3 (two tiles, both hold the mask) and within a tile.
  pieces.tiles[0]->bond_x[pieces.tiles[0]->index(2, 1)] = pieces.tiles[1]->bond_x[pieces.tiles[1]->index(-1, 1)] = 0;
  ++pieces.tiles[0]->n_breaks, ++pieces.tiles[1]->n_breaks;
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_contacts, 1);
  EXPECT_LT(pieces.get(0, Tile::fx, 2, 1).x, 0);
  EXPECT_GT(pieces.get(1, Tile::fx, 0, 1).x, 0);
  pieces.tiles[0]->bond_y[pieces.tiles[0]->index(1, 0)] = 0;
  ++pieces.tiles[0]->n_breaks;
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_contacts, 2);

  // Shear until the short diagonal of a lattice cell is below 2 r.
  Pieces sheared;
  sheared.add(rag, 2, 2, 2, true, [](int c, int r) { return Vec3{2e-3 * c + 1.2e-3 * r, 1.6e-3 * r, 0}; });
  ContactSolver sheared_contacts(ContactSettings{}, sheared.rags, nullptr);
  const auto sheared_tiles = sheared.owned();
  sheared_contacts.add_forces(sheared_tiles, {}, 1e-6);
  EXPECT_EQ(sheared_contacts.measures().n_contacts, 1);
}

// Places outside the mask of a piece take no part.
TEST(ContactSolver, MaskedPlacesDoNotTouch) {
  Pieces pieces = stack(4, 4, 4);
  for (auto& tile : pieces.tiles) std::fill(tile->exists.begin(), tile->exists.end(), 0.0);
  ContactSolver contacts(ContactSettings{}, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_contacts, 0);
}

/// Forces of all tiles after `steps` steps when tiles are shared out: each "rank" owns those of its number and sees the others as ghosts.
std::vector<std::vector<double>> run_shared(int ranks, int steps, double skin, std::size_t& n_lists) {
  Pieces pieces = stack(9, 7, 4);
  const WallSet walls = box_wall();
  ContactSettings settings;
  settings.skin_over_radius = skin;
  std::vector<std::unique_ptr<ContactSolver>> solvers;
  for (int rank = 0; rank < ranks; ++rank) solvers.push_back(std::make_unique<ContactSolver>(settings, pieces.rags, &walls));
  for (int k = 0; k < steps; ++k) {
    pieces.kick(2.5e-6), pieces.drift(5e-6), pieces.clear_forces();
    for (int rank = 0; rank < ranks; ++rank) {
      std::vector<Tile*> owned;
      std::vector<const Tile*> ghosts;
      for (std::size_t t = pieces.tiles.size(); t-- > 0;) {  // another order than that of ids
        if (static_cast<int>(t * 7 % ranks) == rank)
          owned.push_back(pieces.tiles[t].get());
        else
          ghosts.push_back(pieces.tiles[t].get());
      }
      solvers[rank]->add_forces(owned, ghosts, 5e-6);
    }
    pieces.kick(2.5e-6);
  }
  n_lists = static_cast<std::size_t>(solvers[0]->measures().n_lists);
  std::vector<std::vector<double>> all;
  for (std::size_t t = 0; t < pieces.tiles.size(); ++t) all.push_back(forces(pieces, t));
  return all;
}

// The forces after 300 steps are the same to the bit on 1, 2, 3 and 5 ranks, and whatever the skin of the lists: with it history survives
// new lists.
TEST(ContactSolver, ResultsDoNotDependOnRanksOrLists) {
  std::size_t lists = 0, lists_of_thin_skin = 0;
  const auto reference = run_shared(1, 300, 0.3, lists);
  for (int ranks : {2, 3, 5}) {
    const auto shared = run_shared(ranks, 300, 0.3, lists);
    for (std::size_t t = 0; t < reference.size(); ++t) EXPECT_TRUE(same_bits(reference[t], shared[t])) << ranks << " ranks, tile " << t;
  }
  const auto thin = run_shared(1, 300, 0.01, lists_of_thin_skin);
  for (std::size_t t = 0; t < reference.size(); ++t) EXPECT_TRUE(same_bits(reference[t], thin[t])) << "thin skin, tile " << t;
  EXPECT_GT(lists, 1U);
  EXPECT_GT(lists_of_thin_skin, 5 * lists);
  double largest = 0;
  for (const auto& tile : reference)
    for (double f : tile) largest = std::max(largest, std::abs(f));
  EXPECT_GT(largest, 1e-6);
}

// Tiles that move to another rank, or into a new run, take their history along: forces stay the same to the bit. Without it they differ.
TEST(ContactSolver, HistoryIsPackedAndUnpacked) {
  const WallSet walls = box_wall();
  Pieces pieces = stack(9, 7, 4);
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  for (int k = 0; k < 100; ++k) pieces.advance(contacts, 5e-6);
  ASSERT_GT(contacts.measures().n_wall_contacts, 10);
  ASSERT_GT(contacts.measures().n_contacts, 400);

  Pieces resumed = stack(9, 7, 4), split = stack(9, 7, 4), forgetful = stack(9, 7, 4);
  copy_state(pieces, resumed), copy_state(pieces, split), copy_state(pieces, forgetful);
  ContactSolver after(ContactSettings{}, resumed.rags, &walls), forgot(ContactSettings{}, forgetful.rags, &walls);
  std::vector<std::unique_ptr<ContactSolver>> ranks;
  for (int rank = 0; rank < 2; ++rank) ranks.push_back(std::make_unique<ContactSolver>(ContactSettings{}, split.rags, &walls));
  for (std::size_t t = 0; t < pieces.tiles.size(); ++t) {
    const auto packed = contacts.pack(*pieces.tiles[t]);
    after.unpack(*resumed.tiles[t], packed);
    ranks[t % 2]->unpack(*split.tiles[t], packed);
    // A tile that moves on before the next step gives back all that it brought.
    EXPECT_TRUE(same_bits(after.pack(*resumed.tiles[t]), packed)) << t;
  }
  for (int k = 0; k < 20; ++k) {
    pieces.advance(contacts, 5e-6), resumed.advance(after, 5e-6), forgetful.advance(forgot, 5e-6);
    split.kick(2.5e-6), split.drift(5e-6), split.clear_forces();
    for (int rank = 0; rank < 2; ++rank) {
      std::vector<Tile*> owned;
      std::vector<const Tile*> ghosts;
      for (std::size_t t = 0; t < split.tiles.size(); ++t) {
        if (static_cast<int>(t % 2) == rank)
          owned.push_back(split.tiles[t].get());
        else
          ghosts.push_back(split.tiles[t].get());
      }
      ranks[rank]->add_forces(owned, ghosts, 5e-6);
    }
    split.kick(2.5e-6);
  }
  bool differs = false;
  for (std::size_t t = 0; t < pieces.tiles.size(); ++t) {
    EXPECT_TRUE(same_bits(forces(pieces, t), forces(resumed, t))) << t;
    EXPECT_TRUE(same_bits(forces(pieces, t), forces(split, t))) << t;
    differs = differs || !same_bits(forces(pieces, t), forces(forgetful, t));
  }
  EXPECT_TRUE(differs);
  EXPECT_EQ(contacts.measures().n_contacts, after.measures().n_contacts);
  EXPECT_THROW(after.unpack(*resumed.tiles[0], std::vector<double>{1, 0, 0}), Error);
}

// Particles that part and touch again, without leaving the list in between, start without slip; so does a particle on a wall.
TEST(ContactSolver, PartingForgetsSlip) {
  const double r = 1e-3;
  const Rag rag = Pieces::sphere(r, 540);
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1});
  Pieces pieces;
  pieces.add_sphere(rag, {0, 0, 1}), pieces.add_sphere(rag, {1.9 * r, 0, 1}), pieces.add_sphere(rag, {0.1, 0, 0.9 * r});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  const auto tiles = pieces.owned();
  const auto tangential = [&] {
    pieces.clear_forces();
    contacts.add_forces(tiles, {}, 0);
    return Vec3{pieces.get(1, Tile::fx).y, pieces.get(2, Tile::fx).y, 0};
  };
  pieces.set(1, Tile::vx, {0, 1, 0}), pieces.set(2, Tile::vx, {0, 1, 0});
  contacts.add_forces(tiles, {}, 1e-6);
  pieces.set(1, Tile::vx, {}), pieces.set(2, Tile::vx, {});
  EXPECT_LT(tangential().x, 0);
  EXPECT_LT(tangential().y, 0);
  pieces.set(1, Tile::x, {2.01 * r, 0, 1}), pieces.set(2, Tile::x, {0.1, 0, 1.01 * r});
  EXPECT_EQ(norm(tangential()), 0);
  const std::int64_t lists = contacts.measures().n_lists;
  pieces.set(1, Tile::x, {1.9 * r, 0, 1}), pieces.set(2, Tile::x, {0.1, 0, 0.9 * r});
  EXPECT_EQ(norm(tangential()), 0);
  EXPECT_EQ(contacts.measures().n_lists, lists);
  EXPECT_EQ(contacts.measures().n_contacts, 1);
  EXPECT_EQ(contacts.measures().n_wall_contacts, 1);
}

// A particle without a finite position is left out and counted; the others go on.
TEST(ContactSolver, NotFiniteParticlesAreCounted) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(1e-3, 540);
  pieces.add_sphere(rag, {}), pieces.add_sphere(rag, {1.9e-3, 0, 0}), pieces.add_sphere(rag, {std::nan(""), 0, 0});
  ContactSolver contacts(ContactSettings{}, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_not_finite, 1);
  EXPECT_EQ(contacts.measures().n_contacts, 1);
  EXPECT_NEAR(contacts.measures().max_overlap_over_radius, 0.1, 1e-9);
}

// Particles far apart (metres) do not make the search fail or slow: cells widen.
TEST(ContactSolver, FarParticlesAreHarmless) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(1e-3, 540);
  pieces.add_sphere(rag, {-1e6, 0, 0}), pieces.add_sphere(rag, {3e7, 5e7, -2e8}), pieces.add_sphere(rag, {-1e6, 1e-3, 0});
  ContactSolver contacts(ContactSettings{}, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().n_contacts, 1);
}

// The largest step is the least of the Rayleigh and impact bounds, shorter for stiffer walls; the reason names the contact. Bad properties
// are refused.
TEST(ContactSolver, StableStep) {
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(1e-3, 537.2), {});
  ContactSettings settings;
  settings.impact_speed = 1e-6;
  ContactSolver slow(settings, pieces.rags, nullptr);
  EXPECT_NEAR(slow.stable_step(), 7.9e-5 / 3, 0.02 * 7.9e-5 / 3);  // pi r sqrt(rho/G)/(0.1631 nu + 0.8766) = 79 us, by hand
  EXPECT_NE(slow.stable_step_reason().find("Rayleigh"), std::string::npos);
  settings.impact_speed = 5;
  const WallSet walls = box_wall();
  ContactSolver fast(settings, pieces.rags, nullptr), with_wall(settings, pieces.rags, &walls);
  settings.wall_stiffness_factor = 100;
  ContactSolver stiff(settings, pieces.rags, &walls);
  EXPECT_LT(fast.stable_step(), slow.stable_step());
  EXPECT_LT(stiff.stable_step(), 0.3 * with_wall.stable_step());
  EXPECT_NE(stiff.stable_step_reason().find("wall"), std::string::npos);
  EXPECT_NEAR(fast.cutoff(), 2.5e-3, 1e-12);
  pieces.rags[0].mass = 0;
  EXPECT_THROW(ContactSolver(settings, pieces.rags, nullptr), Error);
}

}  // namespace
}  // namespace snag
