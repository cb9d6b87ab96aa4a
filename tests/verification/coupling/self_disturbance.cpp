// timeout: 600
// A sphere that settles through the flow solver's own water, from a tenth of a cell to four cells in diameter: its own wake is taken off
// what the kernel averages.
//
// Exact for creeping flow in a periodic box of side L that a uniform force keeps at rest (Hasimoto 1959): v = F/(3 pi mu d) (1 - 1.4185
// d/L).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/coupled_solver.hpp"
#include "solver/flow_solver.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

struct Settling {
  double cell_per_diameter;
  int n_cells;         // along each side
  std::string kernel;  // keys of [coupling]
  double step;         // s
  int steps;
};

/// Mean velocity over the last half of the way, over the exact one.
double velocity_ratio(const Settling& s, bool corrected) {
  constexpr double d = 1e-3, rho = 1000, mu = 0.1, excess = 500, g = 9.81;
  const double L = s.n_cells * s.cell_per_diameter * d;
  const Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {L, L, L}, {s.n_cells, s.n_cells, s.n_cells}, {true, true, true});
  FlowSettings settings;
  settings.density = rho, settings.dynamic_viscosity = mu;
  FlowSolver water(mesh, settings, {});
  const double force = std::numbers::pi / 6 * d * d * d * excess * g;
  water.flow.body_force = {0, 0, force / (L * L * L)};
  RagSettings sphere(RagSettings::Shape::particle);
  sphere.diameter = d, sphere.density = rho + excess, sphere.position = {0.513 * L, 0.507 * L, 0.55 * L};
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(sphere, "test")});
  const std::string text = "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\n" + s.kernel + "\nforces = [\"schiller_naumann\"" +
                           (corrected ? ", \"self_disturbance\"" : "") + "]\n";
  CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, water.flow, [&](double dt) { water.advance(dt); });
  const int half = s.steps / 2;
  double start = 0;
  const auto height = [&] { return rags.tiles()[0].vector(Tile::x, rags.tiles()[0].index(0, 0)).z; };
  for (int n = 0; n < s.steps; ++n) {
    if (n == half) start = height();
    solver.step(s.step);
  }
  const double velocity = (start - height()) / (s.step * (s.steps - half));
  const double exact = force / (3 * std::numbers::pi * mu * d) * (1 - 1.4185 * d / L);
  return velocity / exact;
}

// Requirement: with the correction the settling velocity is within 2 % of the exact one, and at most a third as wrong as without.
TEST(SelfDisturbance, SettlingSphere) {
  for (const Settling& s : {Settling{10, 8, "kernel = \"cell\"", 0.05, 60}, Settling{1, 16, "kernel_width_mm = 1", 0.005, 60},
                            Settling{0.25, 32, "kernel_width_mm = 1", 0.005, 24}}) {
    const double without = velocity_ratio(s, false), with = velocity_ratio(s, true);
    std::printf("  diameter/cell %5.2f: velocity over exact %.3f without, %.3f with the correction\n", 1 / s.cell_per_diameter, without,
                with);
    EXPECT_NEAR(with, 1, 0.02);
    EXPECT_LT(std::abs(with - 1), std::abs(without - 1) / 3);
  }
}

}  // namespace
}  // namespace snag
