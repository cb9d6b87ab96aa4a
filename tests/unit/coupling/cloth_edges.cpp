// ranks: 1 3
// Distances of the edges of a cloth: those of open edges, none of closed ones, the same on any number of ranks.
#include "coupling/cloth_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"
#include "dem/templates/rag_settings.hpp"

namespace snag {
namespace {

constexpr double radius = 1e-3;

RagPiece piece(RagSettings::Shape shape, const std::vector<Cut>& cuts) {
  RagSettings settings(shape);
  settings.length = 0.2, settings.width = 0.1, settings.diameter = 0.1, settings.radius = radius;
  RagPiece made = make_piece(settings, "test");
  made.rag.cuts = cuts;
  return made;
}

/// Calls visit(x, y, s) for the particles of this rank, x and y from the middle of the cloth, m; `coverage` at x and y.
template <class Coverage, class Visit>
void with_distances(RagSettings::Shape shape, const Coverage& coverage, const Visit& visit, const std::vector<Cut>& cuts = {},
                    double width = 1e300) {
  RagSystem rags(MPI_COMM_WORLD, {}, {piece(shape, cuts)});
  const Rag& rag = rags.rags()[0];
  TileArrays arrays;
  arrays.reset(rags.tiles(), 3);
  const auto each = [&](const auto& on) {
    for (std::size_t t = 0; t < rags.tiles().size(); ++t) {
      const Tile& tile = rags.tiles()[t];
      for_particles(tile, [&](int k, int i, int j) {
        on(t, k, (2 * (tile.column + i) - rag.n_columns + 1) * radius, (2 * (tile.row + j) - rag.n_rows + 1) * radius);
      });
    }
  };
  each([&](std::size_t t, int k, double x, double y) { arrays.field(t, 0)[k] = coverage(x, y), arrays.field(t, 1)[k] = width; });
  ClothEdges(rags.rags()).find_distances(MPI_COMM_WORLD, rags.tiles(), arrays, {.coverage = 0, .width = 1, .edge_distance = 2});
  each([&](std::size_t t, int k, double x, double y) { visit(x, y, arrays.field(t, 2)[k]); });
}

double open_everywhere(double, double) { return 0.5; }

// At one open edge s is the distance from it; closed edges do not count, half open ones half. The column at the edge is open at its ends.
TEST(ClothEdges, one_edge) {
  const auto expect = [](double coverage_at_edge, const auto& distance) {
    with_distances(
        RagSettings::Shape::rag, [&](double x, double) { return x < -0.098 ? coverage_at_edge : 1.0; },
        [&](double x, double, double s) { EXPECT_TRUE(x < -0.098 || std::abs(s - distance(x)) < 1e-12) << x << " " << s; });
  };
  expect(0.5, [](double x) { return x + 0.1; });
  expect(0.3, [](double x) { return x + 0.1; });
  expect(0.75, [](double x) { return 2 * (x + 0.1); });
  expect(1.2, [](double) { return 1e3; });
}

// The last particle lies r_p inside the edge, where more than half of the kernel is covered. The edge is open all the same.
TEST(ClothEdges, open_edge_and_kernel_of_three_particles) {
  const double width = 3 * radius, coverage_at_last = 0.5 * std::erfc(-radius / (2 * width));
  with_distances(
      RagSettings::Shape::rag, [&](double x, double) { return x < -0.098 ? coverage_at_last : 1.0; },
      [](double x, double, double s) { EXPECT_TRUE(x < -0.098 || std::abs(s - (x + 0.1)) < 1e-12) << x << " " << s; }, {}, width);
}

// The sides of a cut right across are edges as far as they are open, and the edge behind it counts as far as they are closed. It is seen
// along the rows, from both sides.
TEST(ClothEdges, cut) {
  const double cut_at = 0.02;
  for (const double coverage_at_cut : {0.5, 0.75, 1.0}) {
    const double o = 2 * (1 - coverage_at_cut);
    with_distances(
        RagSettings::Shape::rag,
        [&](double x, double) { return x < -0.098                            ? 0.5
                                       : std::abs(x - cut_at) < 1.5 * radius ? coverage_at_cut
                                                                             : 1.0; },
        [&](double x, double, double s) {
          if (x < -0.098 || std::abs(x - cut_at) < 1.5 * radius) return;  // these columns are open at their ends
          const double exact = x < cut_at ? 1 / (x + 0.1) + o / (cut_at - x) : o / (x - cut_at) + (1 - o) / (x + 0.1);
          EXPECT_NEAR(1 / s, std::max(exact, 1e-3), 1e-9 / s) << x << " " << coverage_at_cut;
        },
        {{{cut_at, -1}, {cut_at, 1}}});
  }
}

// A cut along a part of the rows is an edge of the columns that cross it, and of no others.
TEST(ClothEdges, cut_of_a_part) {
  with_distances(
      RagSettings::Shape::rag, [](double, double y) { return std::abs(y) < 1.5 * radius ? 0.5 : 1.0; },
      [](double x, double y, double s) {
        if (std::abs(y) < 1.5 * radius) return;  // these rows are open at their ends
        EXPECT_NEAR(s, x < 0 ? std::abs(y) : 1e3, 1e-9 * s) << x << " " << y;
      },
      {{{-1, 0}, {0, 0}}});
}

// -4 times the Laplacian of the potential's jump over the jump is 1/s^2: on a disc, where the jump is (a^2 - r^2)^(1/2).
TEST(ClothEdges, disc) {
  const double a2 = 0.05 * 0.05;
  with_distances(RagSettings::Shape::disc, open_everywhere, [&](double x, double y, double s) {
    const double r2 = x * x + y * y;
    if (r2 > 0.9 * a2) return;  // at the rim a particle is as far from the edge as its radius, at least
    const double exact = 4 * (2 * a2 - r2) / ((a2 - r2) * (a2 - r2));
    EXPECT_NEAR(1 / (s * s), exact, 1e-9 * exact);
  });
}

}  // namespace
}  // namespace snag
