// ranks: 1 3
// long ranks: 2 5
// The diffusion kernel at walls, at a sliding interface and on tetrahedra; what all kernels have in common is in kernel.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "coupling/kernel.hpp"
#include "mesh/import/import.hpp"
#include "mesh/sliding/turning_mesh.hpp"
#include "parallel/sum.hpp"
#include "tests/unit/coupling/kernel_box.hpp"
#include "tests/unit/mesh/sliding_shells.hpp"

namespace snag {
namespace {

/// Two rooms of 0.3 m x 0.3 m x 0.2 m, of cells of 0.05 m, on both sides of a wall as thick as 0.01 m; joined by a gap of one cell at y =
/// 0.3 m if there is one. Zones: first, second, gap.
test::Sample two_rooms(bool has_gap) {
  constexpr int n = 6, n_z = 4;
  test::Sample s;
  s.volumes = {{1, "first"}, {2, "second"}, {3, "gap"}};
  if (!has_gap) s.volumes.pop_back();
  s.surfaces = {{1, "wall"}};
  const auto node = [&](int i, int j, int k) { return i + (2 * n + 2) * (j + (n + 1) * k); };
  for (int k = 0; k <= n_z; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= 2 * n + 1; ++i) s.node.push_back({i <= n ? i * 0.05 : i * 0.05 - 0.04, j * 0.05, k * 0.05});
  const auto is_water = [&](int i, int j, int k) {
    return i >= 0 && i <= 2 * n && j >= 0 && j < n && k >= 0 && k < n_z && (i != n || (has_gap && j == n - 1));
  };
  for (int k = 0; k < n_z; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= 2 * n; ++i) {
        if (!is_water(i, j, k)) continue;
        const std::vector<int> c{node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
                                 node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
        s.element.push_back({5, i < n ? 1 : i > n ? 2 : 3, c});
        const auto end = [&](bool is_end, std::array<int, 4> corner) {
          if (is_end) s.element.push_back({3, 1, {c[corner[0]], c[corner[1]], c[corner[2]], c[corner[3]]}});
        };
        end(!is_water(i - 1, j, k), {0, 4, 7, 3}), end(!is_water(i + 1, j, k), {1, 2, 6, 5});
        end(!is_water(i, j - 1, k), {0, 1, 5, 4}), end(!is_water(i, j + 1, k), {3, 7, 6, 2});
        end(!is_water(i, j, k - 1), {0, 3, 2, 1}), end(!is_water(i, j, k + 1), {4, 5, 6, 7});
      }
  return s;
}

// Requirement: a diffusion passes through no wall: a particle at a wall that is thinner than the kernel gives nothing to the water behind
// it, or the little that comes through a gap; kernels by distance and at points reach through.
TEST(DiffusionKernel, PassesThroughNoWall) {
  for (const bool has_gap : {false, true}) {
    const test::TemporaryFile file(two_rooms(has_gap), test::Format::ascii22);
    const Mesh mesh = import_mesh(file.path(), world);
    const std::vector<Vec3> points{{0.29, 0.03, 0.1}};
    std::vector<double> is_second(mesh.n_all_cells());
    for (int c = 0; c < mesh.n_all_cells(); ++c) is_second[c] = mesh.zones[mesh.cell_zone[c]] == "second" ? 1 : 0;
    for (const auto& name : kernel_shapes().names()) {
      const auto shape = kernel_shapes().make(name, "test");
      if (!shape->has_width()) continue;
      Kernel kernel(*shape, 0.06, mesh);
      kernel.locate(points);
      const double behind = averaged(kernel, is_second)[0];
      if (rank_of(world) == 0) std::printf("  %s, %s: share behind the wall %.2e\n", name.c_str(), has_gap ? "gap" : "no gap", behind);
      if (name != "diffusion")
        EXPECT_GT(behind, 0.3) << name;
      else if (has_gap)
        EXPECT_TRUE(behind > 0 && behind < 1e-3) << behind;
      else
        EXPECT_EQ(behind, 0);
    }
  }
}

// Requirement: rows that reach a sliding interface follow it: after a turn they are those of a kernel that is made then.
TEST(DiffusionKernel, FollowsATurningZone) {
  const test::Shells shells;
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  Mesh mesh = import_mesh(file.path(), world);
  TurningMesh turning(mesh, shells.description());
  const auto shape = kernel_shapes().make("diffusion", "test");
  Kernel kernel(*shape, 0.004, mesh);
  std::vector<Vec3> points;
  for (int i = 0; i < 100 && rank_of(world) == 0; ++i) {
    const double r = 0.05 + 0.02 * std::sin(3 * i), angle = 0.7 * i;
    points.push_back({r * std::cos(angle), r * std::sin(angle), 0.002 + 0.036 * (i % 11) / 11});
  }
  for (const double angle : {0.3, 0.9}) {
    turning.turn(angle);
    kernel.mesh_moved();
    kernel.locate(points);
    Kernel fresh(*shape, 0.004, mesh);
    fresh.locate(points);
    const auto field = field_of(mesh, [](const Vec3& x) { return std::sin(50 * x.x) * std::cos(40 * x.y) + 10 * x.z; });
    const auto kept = averaged(kernel, field), anew = averaged(fresh, field);
    for (std::size_t b = 0; b < kept.size(); ++b) EXPECT_NEAR(kept[b], anew[b], 1e-13) << "particle " << b;
  }
}

// Requirement: on tetrahedra, whose faces lie aslant to the lines between centres, a diffusion is as wide as it says within 3 %.
TEST(DiffusionKernel, IsAsWideOnTetrahedra) {
  const Mesh mesh = tetrahedral_box(world, {.lower = {-1, -1, -1}, .upper = {1, 1, 1}, .distortion = 0.15}, {16, 16, 16});
  const auto shape = kernel_shapes().make("diffusion", "test");
  const double width = 0.2;
  Kernel kernel(*shape, width, mesh);
  std::vector<Vec3> points;  // centres of cells near the middle, of all ranks
  for (int c = 0; c < mesh.n_cells; ++c)
    if (norm(mesh.cell_centre[c]) < 0.15) points.push_back(mesh.cell_centre[c]);
  kernel.locate(points);
  std::vector<Vec3> square(mesh.n_all_cells());
  for (int c = 0; c < mesh.n_all_cells(); ++c)
    for (int i = 0; i < 3; ++i) square[c][i] = mesh.cell_centre[c][i] * mesh.cell_centre[c][i];
  const auto x = kernel.average(std::span<const Vec3>(mesh.cell_centre)), x_squared = kernel.average(square);
  std::vector<Vec3> variance(points.size());
  for (std::size_t b = 0; b < points.size(); ++b)
    for (int i = 0; i < 3; ++i) variance[b][i] = x_squared[b][i] - x[b][i] * x[b][i];
  const Vec3 mean = sum(world, std::span<const Vec3>(variance)) / static_cast<double>(sum(world, static_cast<std::int64_t>(points.size())));
  if (rank_of(world) == 0)
    std::printf("  width over delta %.4f %.4f %.4f\n", std::sqrt(mean.x) / width, std::sqrt(mean.y) / width, std::sqrt(mean.z) / width);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(mean[i]), width, 0.03 * width) << "axis " << i;
}

}  // namespace
}  // namespace snag
