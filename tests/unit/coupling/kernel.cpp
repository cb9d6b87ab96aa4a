// ranks: 1 3
// long ranks: 2 5
// Transfers between particles and cells: consistent one way, conservative the other, the same on any number of ranks.
#include "coupling/kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "coupling/distance_kernel.hpp"
#include "mesh/import/import.hpp"
#include "mesh/sliding/turning_mesh.hpp"
#include "parallel/sum.hpp"
#include "tests/unit/coupling/kernel_box.hpp"
#include "tests/unit/mesh/sliding_shells.hpp"

namespace snag {
namespace {

std::vector<double> sizes(std::size_t n) {
  std::vector<double> amounts(n);
  for (std::size_t b = 0; b < n; ++b) amounts[b] = 1 + 0.1 * static_cast<double>(b % 7);
  return amounts;
}

class Kernels : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<KernelShape> shape = kernel_shapes().make(GetParam(), "test");
};

// Requirement: the average of a constant is that constant, at walls and outside the mesh too, for wide and narrow kernels.
TEST_P(Kernels, ConstantIsReproduced) {
  const Mesh mesh = box(world);
  auto points = scattered_points(200);
  points.push_back(lower - Vec3{0.01, 0.01, 0});
  points.push_back(upper + Vec3{1, 0, 3});
  const std::vector<double> constant(mesh.n_all_cells(), 3.7);
  for (const double width : {h / 100, h, 3 * h}) {
    Kernel kernel(*shape, width, mesh);
    kernel.locate(dealt(points));
    for (const double value : averaged(kernel, constant)) EXPECT_NEAR(value, 3.7, 1e-14 * 3.7 * 4) << "width " << width;
  }
}

// Requirement: what is spread is kept to round-off, whatever lies at walls or outside.
TEST_P(Kernels, SumIsKept) {
  const Mesh mesh = box(world);
  auto points = scattered_points(300);
  points.push_back(lower - Vec3{0.01, 0.01, 0});
  points.push_back(upper + Vec3{1, 0, 3});
  const auto all = sizes(points.size());
  for (const double width : {h / 100, h, 3 * h}) {
    Kernel kernel(*shape, width, mesh);
    kernel.locate(dealt(points));
    std::vector<double> field(mesh.n_cells, 0.0);
    kernel.spread(dealt(all), 1, field);
    for (int c = 0; c < mesh.n_cells; ++c) field[c] *= mesh.cell_volume[c];
    const double given = sum(world, std::span<const double>(dealt(all)));
    EXPECT_NEAR(sum(world, std::span<const double>(field)), given, 1e-14 * given) << "width " << width;
  }
}

// Requirement: particles that fill the box evenly give evenly to its cells, at walls, edges and corners too, and average their own gift
// evenly. Of the 33 points of a satellite kernel few lie in the octant of a corner. (Without the factors of cells at walls a corner gets
// 0.33.)
TEST_P(Kernels, EvenParticlesGiveEvenlyAtWalls) {
  const Mesh mesh = box(world);
  std::vector<Vec3> points;
  const double spacing = h;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 16; ++k) points.push_back(lower + spacing * Vec3{i + 0.5, j + 0.5, k + 0.5});
  const std::vector<double> volume(dealt(points).size(), spacing * spacing * spacing);
  const bool at_points = GetParam() == "satellite";
  const double given = at_points ? 0.03 : 0.005, returned = at_points ? 0.006 : 0.002;
  for (const double width : {0.8 * h, 1.5 * h}) {
    Kernel kernel(*shape, width, mesh);
    kernel.locate(dealt(points));
    std::vector<double> field(mesh.n_all_cells(), 0.0);
    kernel.spread(volume, 1, field);
    for (int c = 0; c < mesh.n_cells; ++c) EXPECT_NEAR(field[c], 1, given) << "width " << width / h << " cells, cell " << c;
    for (const double value : averaged(kernel, field)) EXPECT_NEAR(value, 1, returned) << "width " << width / h << " cells";
  }
}

// Requirement: averages and spread fields are those of one rank, to 1e-12, however cells and particles are dealt to the ranks.
TEST_P(Kernels, RanksDoNotMatter) {
  const Mesh mesh = box(world), whole = box(MPI_COMM_SELF);
  auto points = scattered_points(150);
  points.push_back(lower - Vec3{0.02, -0.013, 0});
  const auto all = sizes(points.size());
  Kernel kernel(*shape, 1.3 * h, mesh), alone(*shape, 1.3 * h, whole);
  kernel.locate(dealt(points));
  alone.locate(points);

  const auto expected = averaged(alone, field_of(whole, wave));
  const auto mine = averaged(kernel, field_of(mesh, wave));
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_NEAR(mine[i], expected[rank_of(world) + i * size_of(world)], 1e-12);
  EXPECT_EQ(kernel.n_outside(), alone.n_outside());
  EXPECT_EQ(kernel.n_outside(), 1);

  std::vector<double> field(mesh.n_cells, 0.0), field_alone(whole.n_cells, 0.0);
  kernel.spread(dealt(all), 1, field);
  alone.spread(all, 1, field_alone);
  std::map<std::int64_t, double> by_id;
  for (int c = 0; c < whole.n_cells; ++c) by_id[whole.cell_id[c]] = field_alone[c];
  for (int c = 0; c < mesh.n_cells; ++c) EXPECT_NEAR(field[c], by_id.at(mesh.cell_id[c]), 1e-12 * 1.6 / (h * h * h));
}

// Requirement: average and spread are the two sides of one matrix: the work that particles do is the work that the water gets.
TEST_P(Kernels, WorkIsKept) {
  const Mesh mesh = box(world);
  const auto points = scattered_points(200);
  const auto amounts = dealt(sizes(points.size()));
  Kernel kernel(*shape, 1.7 * h, mesh);
  kernel.locate(dealt(points));
  const auto u = field_of(mesh, wave);
  std::vector<double> at_particles = averaged(kernel, u), field(mesh.n_cells, 0.0);
  kernel.spread(amounts, 1, field);
  for (std::size_t b = 0; b < amounts.size(); ++b) at_particles[b] *= amounts[b];
  for (int c = 0; c < mesh.n_cells; ++c) field[c] *= mesh.cell_volume[c] * u[c];
  const double work = sum(world, std::span<const double>(at_particles));
  EXPECT_NEAR(sum(world, std::span<const double>(field)), work, 1e-13 * std::abs(work));
}

// Requirement: a kernel much narrower than the cells is a cell: weight 1 and nothing divided 0/0.
TEST_P(Kernels, NarrowKernelIsOneCell) {
  const Mesh mesh = box(world);
  const Vec3 inside{0.111, 0.413, 0.377};
  const std::vector<Vec3> points = rank_of(world) == 0 ? std::vector{inside} : std::vector<Vec3>{};
  const auto u = field_of(mesh, wave);
  const auto middle = [](double x, double low) { return low + (std::floor((x - low) / h) + 0.5) * h; };
  const double expected = wave({middle(inside.x, lower.x), middle(inside.y, lower.y), middle(inside.z, lower.z)});
  for (const double width : {1e-9 * h, 1e-3 * h, 0.03 * h}) {
    Kernel kernel(*shape, width, mesh);
    kernel.locate(points);
    for (const double value : averaged(kernel, u)) EXPECT_NEAR(value, expected, 1e-12) << "width " << width;
  }
}

// Requirement: a particle on a face or an edge between cells (of two ranks, too) belongs to the cell of the lower number.
TEST_P(Kernels, TieGoesToTheLowerCell) {
  const Mesh mesh = box(world), whole = box(MPI_COMM_SELF);
  std::vector<Vec3> points;
  for (int k = 1; k < 16; ++k) points.push_back({0.125, 0.325, k * 0.05}), points.push_back({0.1, 0.325, k * 0.05});
  Kernel kernel(*shape, 1e-3 * h, mesh), alone(*shape, 1e-3 * h, whole);
  kernel.locate(points), alone.locate(points);
  const auto z = [](const Vec3& x) { return x.z; };
  const auto mine = averaged(kernel, field_of(mesh, z)), expected = averaged(alone, field_of(whole, z));
  for (std::size_t b = 0; b < points.size(); ++b) EXPECT_DOUBLE_EQ(mine[b], expected[b]) << "z " << points[b].z;
  EXPECT_EQ(kernel.n_outside(), 0);
}

// Requirement: near a sliding interface too, at any angle, averages are those of one rank; a kernel reaches across the interface.
TEST_P(Kernels, RanksDoNotMatterAtASlidingInterface) {
  const test::Shells shells;
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  Mesh mesh = import_mesh(file.path(), world), whole = import_mesh(file.path(), MPI_COMM_SELF);
  TurningMesh turning(mesh, shells.description()), turning_alone(whole, shells.description());
  const double width = 0.006;  // cells are as large, the rotor ends at r = 0.05 m
  Kernel kernel(*shape, width, mesh), alone(*shape, width, whole);
  std::vector<Vec3> points;
  for (int i = 0; i < 150; ++i) {
    const double r = 0.05 + 0.004 * std::sin(3 * i), angle = 0.7 * i;
    points.push_back({r * std::cos(angle), r * std::sin(angle), 0.002 + 0.036 * (i % 11) / 11});
  }
  for (const double angle : {0.3, 2.0}) {
    turning.turn(angle), turning_alone.turn(angle);
    kernel.mesh_moved(), alone.mesh_moved();
    kernel.locate(dealt(points)), alone.locate(points);
    const auto smooth = [](const Vec3& x) { return std::sin(50 * x.x) * std::cos(40 * x.y) + 10 * x.z; };
    const auto mine = averaged(kernel, field_of(mesh, smooth)), expected = averaged(alone, field_of(whole, smooth));
    for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_NEAR(mine[i], expected[rank_of(world) + i * size_of(world)], 1e-12) << angle;
    std::vector<double> in_rotor(whole.n_all_cells());
    for (int c = 0; c < whole.n_all_cells(); ++c) in_rotor[c] = whole.cell_zone[c] == whole.turning.zone ? 1 : 0;
    int shared = 0;
    for (const double share : averaged(alone, in_rotor)) shared += share > 0.1 && share < 0.9 ? 1 : 0;
    EXPECT_GE(shared, shape->has_width() ? 75 : 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, Kernels, testing::ValuesIn(kernel_shapes().names()));

// Requirement: the width is the rms width per axis, for every kernel: the average of x^2 about the particle is delta^2, in the mean over
// places of the particle within a cell. Where points count in the cell that holds them, they are moved to its centre: h^2/12 more.
TEST(KernelWidth, IsTheRootMeanSquarePerAxis) {
  const Mesh mesh = structured_box(world, {-1, -1, -1}, {1, 1, 1}, {24, 24, 24});
  constexpr double side = 1.0 / 12, width = 0.2;
  constexpr int n = 6;  // places along each side of a cell
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) points.push_back(side / n * Vec3{i + 0.5, j + 0.5, k + 0.5});
  for (const auto& name : kernel_shapes().names()) {
    const auto shape = kernel_shapes().make(name, "test");
    if (!shape->has_width()) continue;
    Kernel kernel(*shape, width, mesh);
    kernel.locate(points);
    std::vector<Vec3> first(mesh.n_all_cells()), second(mesh.n_all_cells());
    for (int c = 0; c < mesh.n_all_cells(); ++c) {
      const Vec3& x = mesh.cell_centre[c];
      first[c] = x, second[c] = {x.x * x.x, x.y * x.y, x.z * x.z};
    }
    const std::vector<Vec3> x = kernel.average(first), x_squared = kernel.average(second);
    Vec3 found;
    for (std::size_t b = 0; b < points.size(); ++b)
      for (int i = 0; i < 3; ++i)
        found[i] += (x_squared[b][i] - 2 * points[b][i] * x[b][i] + points[b][i] * points[b][i]) / static_cast<double>(points.size());
    const double moved = name == "satellite" || name == "diffusion" ? side / std::sqrt(12) : 0;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(found[i]), std::hypot(width, moved), 0.01 * width) << name << " axis " << i;
  }
}

// Requirement: q says how much of itself a kernel by distance holds: pi^(1/2) delta <1/|x - x'|>, here by pairs of shells of g.
TEST(KernelOverlap, IsTheMeanOfTheInverseDistance) {
  for (const auto& name : kernel_shapes().names()) {
    const auto shape = kernel_shapes().make(name, "test");
    const auto* by_distance = dynamic_cast<const DistanceKernel*>(shape.get());
    if (!by_distance) continue;
    constexpr int n = 4000;
    const double step = by_distance->support_radius(1) / n;
    std::vector<double> g(n);
    for (int i = 0; i < n; ++i) g[i] = std::pow((i + 0.5) * step, 2);
    by_distance->log_weights(g, 1);
    double inside = 0, sum = 0, whole = 0;  // of the shells within this one; over the pairs; of all shells
    for (int i = 0; i < n; ++i) {
      const double r = (i + 0.5) * step, share = r * r * std::exp(g[i]);
      sum += 2 * share * (inside + 0.5 * share) / r;
      whole += share, inside += share;
    }
    EXPECT_NEAR(shape->overlap(), std::sqrt(std::numbers::pi) * sum / (whole * whole), 2e-3) << name;  // a Gaussian is cut
  }
}

// Requirement: what satellite points outside the mesh would carry the others of the particle carry, and they are counted.
TEST(SatelliteKernel, CountsPointsOutside) {
  const Mesh mesh = box(world);
  const auto shape = kernel_shapes().make("satellite", "test");
  Kernel kernel(*shape, h, mesh);
  const Vec3 middle = 0.5 * (lower + upper);
  std::vector<Vec3> points;
  if (rank_of(world) == 0) points = {middle, {lower.x + 1e-6 * h, middle.y, middle.z}, {lower.x - 0.5 * h, middle.y, middle.z}};
  kernel.locate(points);
  EXPECT_EQ(kernel.n_outside(), 1);
  EXPECT_EQ(kernel.n_points_outside(), 16 + 20);  // of 33 points 16 have x < 0 and 20 x < h/2
  for (const double value : averaged(kernel, std::vector<double>(mesh.n_all_cells(), 2.5))) EXPECT_NEAR(value, 2.5, 1e-14);
}

// Requirement: away from walls the average of a linear field is exact to 1e-3 of its change over delta, and that of a smooth one of second
// order in delta (delta = 1.5 h).
TEST(KernelOrder, SecondOrderAwayFromWalls) {
  const Vec3 x{0.013, -0.021, 0.008};
  for (const char* name : {"gaussian", "wendland"}) {
    const auto shape = kernel_shapes().make(name, "test");
    std::vector<double> log_error, log_width;
    for (const int n : {16, 24, 36}) {
      const Mesh mesh = structured_box(world, {-1, -1, -1}, {1, 1, 1}, {n, n, n});
      const double width = 1.5 * 2 / n;
      Kernel kernel(*shape, width, mesh);
      kernel.locate(std::span(&x, 1));
      const double linear = averaged(kernel, field_of(mesh, [](const Vec3& p) { return 2 * p.x - 3 * p.y + p.z; }))[0];
      EXPECT_NEAR(linear, 2 * x.x - 3 * x.y + x.z, 1e-3 * width) << name << ", n = " << n;
      const auto smooth = [](const Vec3& p) { return std::cos(2 * p.x) * std::exp(p.y) + p.z * p.z; };
      const double error = std::abs(averaged(kernel, field_of(mesh, smooth))[0] - smooth(x));
      log_error.push_back(std::log(error)), log_width.push_back(std::log(width));
    }
    const double order = (log_error.back() - log_error.front()) / (log_width.back() - log_width.front());
    if (rank_of(world) == 0)
      std::printf("  %s: errors %.2e %.2e %.2e, order %.2f\n", name, std::exp(log_error[0]), std::exp(log_error[1]), std::exp(log_error[2]),
                  order);
    EXPECT_GT(order, 1.8) << name;
    EXPECT_LT(order, 2.4) << name;
  }
}

// Requirement: once told that the mesh has moved, the kernel finds all particles of a turning zone; ranks that hold a part of it are asked
// by boxes that lie elsewhere after a turn.
TEST(Kernel, FollowsATurningZone) {
  const test::Shells shells;
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  Mesh mesh = import_mesh(file.path(), world);
  TurningMesh turning(mesh, shells.description());
  const auto shape = kernel_shapes().make("cell", "test");
  Kernel kernel(*shape, 1, mesh);
  turning.turn(2);
  std::vector<Vec3> points;
  for (int i = 0; i < 200 && rank_of(world) == 0; ++i) {
    const double r = 0.035 + 0.012 * (i % 7) / 7, angle = 0.1 * i;
    points.push_back({r * std::cos(angle), r * std::sin(angle), 0.002 + 0.036 * (i % 11) / 11});
  }
  kernel.mesh_moved();
  kernel.locate(points);
  EXPECT_EQ(kernel.n_outside(), 0);
}

}  // namespace
}  // namespace snag
