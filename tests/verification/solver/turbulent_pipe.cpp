// ranks: 1
#include <gtest/gtest.h>

#include "mesh/import/parts.hpp"
#include "tests/verification/solver/developed_turbulence.hpp"
#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double radius = 0.1;  // m

/// Distances of rings from the axis, outwards: of the same width but for those at the wall, the first of which has its centre at y_first.
std::vector<double> rings(int n_core, double y_first) {
  std::vector<double> r{radius};
  for (double width = 2 * y_first; r.back() > width; width = std::min(1.2 * width, radius / n_core)) r.push_back(r.back() - width);
  if (r.back() < 0.5 * radius / n_core) r.pop_back();
  std::reverse(r.begin(), r.end());
  return r;
}

/// A sector of a pipe, 5 degrees wide, of rings at these distances from the axis: a prism at the axis, then hexahedra; two cells along its
/// period.
Mesh pipe_sector(const std::vector<double>& ring) {
  const int n_radial = static_cast<int>(ring.size());
  constexpr double half = 2.5 * pi / 180, length = 0.4;
  constexpr int n_long = 2;
  MeshParts parts;
  parts.comm = MPI_COMM_SELF, parts.source = "pipe sector";
  parts.zones = {"fluid"}, parts.patches = {"wall", "low", "high", "begin", "end"};
  parts.periodic = {{"begin", "end", {length, 0, 0}}};
  const int level = 2 * n_radial + 1;
  const auto axis = [&](int i) { return i * level; };
  const auto low = [&](int i, int j) { return i * level + 2 * j - 1; };  // j-th ring, from 1
  const auto high = [&](int i, int j) { return i * level + 2 * j; };
  for (int i = 0; i <= n_long; ++i) {
    const double x = length * i / n_long;
    parts.node.push_back({x, 0, 0});
    for (int j = 1; j <= n_radial; ++j)  // the chord of the wall is one radius from the axis: hydraulic diameter 2 R
      for (const double side : {-1.0, 1.0}) parts.node.push_back({x, ring[j - 1], side * std::tan(half) * ring[j - 1]});
  }
  for (std::size_t i = 0; i < parts.node.size(); ++i) parts.node_id.push_back(static_cast<std::int64_t>(i));
  const auto face = [&](int patch, std::vector<int> nodes) {
    add_boundary_face(parts, patch, nodes.data(), static_cast<int>(nodes.size()));
  };
  for (int i = 0; i < n_long; ++i) {
    const int a = axis(i), b = axis(i + 1);
    const std::vector<int> prism{a, high(i, 1), low(i, 1), b, high(i + 1, 1), low(i + 1, 1)};
    add_cell(parts, CellShape::prism, prism.data(), 6);
    face(1, {a, low(i, 1), low(i + 1, 1), b}), face(2, {a, high(i, 1), high(i + 1, 1), b});
    if (i == 0) face(3, {a, low(i, 1), high(i, 1)});
    if (i + 1 == n_long) face(4, {b, low(i + 1, 1), high(i + 1, 1)});
    for (int j = 1; j < n_radial; ++j) {
      const std::vector<int> here{low(i, j), low(i, j + 1), high(i, j + 1), high(i, j)};
      const std::vector<int> there{low(i + 1, j), low(i + 1, j + 1), high(i + 1, j + 1), high(i + 1, j)};
      std::vector<int> hexahedron = here;
      hexahedron.insert(hexahedron.end(), there.begin(), there.end());
      add_cell(parts, CellShape::hexahedron, hexahedron.data(), 8);
      face(1, {here[0], here[1], there[1], there[0]}), face(2, {here[3], here[2], there[2], there[3]});
      if (j + 1 == n_radial) face(0, {here[1], here[2], there[2], there[1]});
      if (i == 0) face(3, here);
      if (i + 1 == n_long) face(4, there);
    }
  }
  parts.n_owned = static_cast<int>(parts.shape.size());
  for (int c = 0; c < parts.n_owned; ++c) parts.cell_id.push_back(c), parts.zone.push_back(0);
  return build_mesh(std::move(parts));
}

struct Developed {
  double mean_velocity, y_plus;
};

double mean_velocity(const Flow& flow) {
  double through = 0, volume = 0;
  for (int c = 0; c < flow.mesh.n_cells; ++c) through += flow.mesh.cell_volume[c] * flow.velocity[c].x, volume += flow.mesh.cell_volume[c];
  return sum(flow.mesh.comm, through) / sum(flow.mesh.comm, volume);
}

/// Advance under a constant force until nothing changes.
/// Convection by upwind differences: that along a developed flow is zero, and on tetrahedra at Courant numbers above 20 linear_upwind with
/// one corrector is unstable, with or without a turbulence model.
Developed develop(const Mesh& mesh, const std::string& boundary, double force, double dt) {
  FlowSettings settings;
  settings.convection = "upwind", settings.momentum_tolerance = 1e-6;
  settings.body_force = {force, 0, 0}, settings.initial_velocity = {2.2608, 0, 0};
  FlowSolver solver(mesh, settings, conditions(boundary),
                    read_turbulence(CaseFile::parse(R"(
[turbulence]
model = "k_epsilon"
tolerance = 1e-6
initial_k = "0.02 m2/s2"
initial_epsilon = "0.02 m2/s3"
)")
                                        .root()));
  double before = 0, now = 1;
  int steps = 0;
  for (; steps < 3000 && (steps < 40 || std::abs(now - before) > 2e-6 * dt); ++steps) {
    solver.advance(dt);
    before = now, now = mean_velocity(solver.flow);
  }
  double y_plus = 0;
  for (const double value : solver.flow.y_plus) y_plus = std::max(y_plus, value);
  std::printf("%d cells, %d steps, U %.5f, y+ %.0f\n", mesh.n_cells, steps, now, y_plus);
  return {now, y_plus};
}

const char* const sector_boundary = R"(
[[boundary]]
patch = "wall"
kind = "wall"
[[boundary]]
patches = ["low", "high"]
kind = "symmetry"
)";

}  // namespace

// The pressure gradient of a developed pipe flow at Re 4.5e5 is that of the one-dimensional solution within 1.5 % and Colebrook's within
// 5 %, whether the cells at the wall have y+ 110 or 440.
TEST(TurbulentPipe, pressure_gradient) {
  for (const int n : {10, 20, 40}) {
    constexpr double G = 168;  // Pa/m
    const double U = develop(pipe_sector(rings(n, 0.5 * radius / n)), sector_boundary, G, 0.5).mean_velocity;
    const DevelopedFlow reference{.radius = radius, .m = 1, .n = 100};
    const double Re = reference.rho * U * 2 * radius / reference.mu,
                 by_colebrook = colebrook(Re) * 0.5 * reference.rho * U * U / (2 * radius);
    std::printf("n %d: Re %.0f, one-dimensional %.2f Pa/m, Colebrook %.2f Pa/m, here %.2f Pa/m\n", n, Re, reference.pressure_gradient(U),
                by_colebrook, G);
    EXPECT_NEAR(G / reference.pressure_gradient(U), 1, 0.015);
    EXPECT_NEAR(G / by_colebrook, 1, 0.05);
    EXPECT_NEAR(Re, 4.5e5, 0.1e5);
  }
}

// Cells at the wall that are thinner than the viscous layer do not change friction: at y+ 1, 3 and 5 it is that at y+ 100 within 4 %.
TEST(TurbulentPipe, thin_cells_at_the_wall) {
  constexpr double G = 168, y_plus_one = 1.09e-5;  // Pa/m, m
  const auto velocity = [&](double y_plus, double dt) {
    return develop(pipe_sector(rings(20, y_plus * y_plus_one)), sector_boundary, G, dt).mean_velocity;
  };
  const double thick = velocity(100, 0.5);
  for (const double y_plus : {1.0, 3.0, 5.0}) {
    const double U = velocity(y_plus, 5e-3);
    std::printf("y+ %g: friction over that at 100 - 1: %.4f\n", y_plus, thick * thick / (U * U) - 1);
    EXPECT_NEAR(thick * thick / (U * U), 1, 0.04);
  }
}

// The same of a plane channel on hexahedra within 1.5 %, and on tetrahedra, whose cells at the wall differ in distance, within 3 %.
TEST(TurbulentChannel, pressure_gradient) {
  constexpr double G = 80;
  const char* const half_channel = R"(
[[boundary]]
patch = "z0"
kind = "wall"
[[boundary]]
patch = "z1"
kind = "symmetry"
)";
  const DevelopedFlow reference{.radius = radius, .m = 0, .n = 100};
  const auto difference = [&](const Mesh& mesh, double dt) {
    return G / reference.pressure_gradient(develop(mesh, half_channel, G, dt).mean_velocity) - 1;
  };
  const double hexahedra = difference(structured_box(MPI_COMM_WORLD, {}, {0.4, 0.4, radius}, {2, 2, 20}, {true, true, false}), 0.5);
  const double tetrahedra = difference(
      tetrahedral_box(MPI_COMM_WORLD, {.upper = {0.03, 0.03, radius}, .distortion = 0.1}, {3, 3, 12}, {true, true, false}), 0.02);
  std::printf("channel: pressure gradient over the one-dimensional one - 1: hexahedra %.4f, tetrahedra %.4f\n", hexahedra, tetrahedra);
  EXPECT_NEAR(hexahedra, 0, 0.015);
  EXPECT_NEAR(tetrahedra, 0, 0.03);
}
