// ranks: 1 3
// long ranks: 2 5
// Transfers between particles and cells: consistent one way, conservative the other, the same on any number of ranks.
#include "coupling/kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "../mesh/sliding_shells.hpp"
#include "coupling/cell_owner.hpp"
#include "coupling/cells_around.hpp"
#include "coupling/distance_kernel.hpp"
#include "mesh/import/import.hpp"
#include "mesh/sliding/turning_mesh.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
const Vec3 lower{-0.1, 0.2, 0}, upper{0.5, 0.6, 0.8};
constexpr double h = 0.05;  // cell size of box()

Mesh box(MPI_Comm comm) { return structured_box(comm, lower, upper, {12, 8, 16}); }

/// Points in the box, many of them near walls, edges and corners.
std::vector<Vec3> scattered_points(int n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Vec3> points(n);
  for (Vec3& x : points)
    for (int i = 0; i < 3; ++i) {
      double s = share(random);
      if (share(random) < 0.3) s = s < 0.5 ? 0.02 * s : 1 - 0.02 * s;
      x[i] = lower[i] + s * (upper[i] - lower[i]);
    }
  return points;
}

/// Every size-th point: so that most particles lie in cells of other ranks.
template <class T>
std::vector<T> dealt(const std::vector<T>& all) {
  std::vector<T> mine;
  for (std::size_t b = rank_of(world); b < all.size(); b += size_of(world)) mine.push_back(all[b]);
  return mine;
}

double wave(const Vec3& x) { return std::sin(5 * x.x + 1) * std::cos(4 * x.y) + x.z * x.z; }

std::vector<double> field_of(const Mesh& mesh, double (*f)(const Vec3&)) {
  std::vector<double> field(mesh.n_all_cells());
  for (int c = 0; c < mesh.n_all_cells(); ++c) field[c] = f(mesh.cell_centre[c]);
  return field;
}

std::vector<double> averaged(const Kernel& kernel, const std::vector<double>& field) {
  const CellField one{field.data(), 1};
  return kernel.average(std::span(&one, 1));
}

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
// evenly. Bounds of one wall are 0.976 to 1.024 and 0.994 to 1.009; in a corner there are three, and of 33 points few lie in its octant.
// (Without the factors of cells at walls a corner gets 0.33.)
TEST_P(Kernels, EvenParticlesGiveEvenlyAtWalls) {
  const Mesh mesh = box(world);
  std::vector<Vec3> points;
  const double spacing = h;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 16; ++k) points.push_back(lower + spacing * Vec3{i + 0.5, j + 0.5, k + 0.5});
  const std::vector<double> volume(dealt(points).size(), spacing * spacing * spacing);
  const bool at_points = GetParam() == "satellite";
  const double given = at_points ? 0.16 : 0.08, returned = at_points ? 0.06 : 0.04;
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

// Requirement: the order of a search names every point once, also one that is not a number, and keeps the points of a small box together.
TEST(OrderInSpace, NamesEveryPointOnce) {
  std::vector<Vec3> points = scattered_points(500);
  points[7].y = std::nan("");
  const double radius = 0.5;  // boxes of 0.2 m hold some twenty of the points
  std::vector<int> order = order_in_space(points, radius);
  double steps = 0, at_random = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i] == 7 || order[i - 1] == 7 || i == 7 || i == 8) continue;
    steps += norm(points[order[i]] - points[order[i - 1]]);
    at_random += norm(points[i] - points[i - 1]);
  }
  EXPECT_LT(steps, 0.3 * at_random);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], static_cast<int>(i));
}

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

// Requirement: a point belongs to the rank of its cell; one outside to the rank of the nearest cell; the same answer on every rank.
TEST(CellOwner, FindsTheRankOfTheCell) {
  const Mesh mesh = box(world);
  CellOwner owner(mesh);
  auto points = scattered_points(60);
  points.push_back(upper + Vec3{0.01, 0.02, 0.01});
  const auto found = owner.owner_of(points);
  std::vector<int> of_rank_0 = found;
  MPI_Bcast(of_rank_0.data(), static_cast<int>(of_rank_0.size()), MPI_INT, 0, world);
  EXPECT_EQ(found, of_rank_0);
  const CellLocator locator(mesh);
  for (std::size_t b = 0; b + 1 < points.size(); ++b) {
    EXPECT_EQ(found[b] == rank_of(world), locator.find(points[b]) >= 0);
  }
  EXPECT_EQ(owner.owner_of(points), found) << "hints of the last search must not change the answer";
}

}  // namespace
}  // namespace snag
