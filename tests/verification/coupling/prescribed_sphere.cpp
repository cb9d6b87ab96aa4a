// A sphere in a prescribed flow against exact motions: falling, relaxing, following an oscillation, stiff.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/coupled_solver.hpp"

namespace snag {
namespace {

constexpr double g = 9.81;               // m/s2
constexpr double rho = 1000, nu = 1e-6;  // kg/m3, m2/s
constexpr double mu = rho * nu;          // Pa s

RagPiece sphere(double diameter, double density, Vec3 velocity = {}) {
  RagSettings settings(RagSettings::Shape::particle);
  settings.diameter = diameter, settings.density = density, settings.velocity = velocity;
  return make_piece(settings, "test");
}

struct SphereRun {
  RagSystem rags;
  CoupledSolver solver;
  SphereRun(const RagPiece& piece, const std::string& case_text, const PrescribedFlow& flow)
      : rags(MPI_COMM_SELF, {}, {piece}), solver(read_coupling(CaseFile::parse(case_text).root(), false), rags, flow) {}
  void advance(double end, int steps) {
    for (int n = 0; n < steps; ++n) solver.step(end / steps);
  }
  Vec3 velocity() const { return rags.tiles()[0].vector(Tile::vx, rags.tiles()[0].index(0, 0)); }
  Vec3 position() const { return rags.tiles()[0].vector(Tile::x, rags.tiles()[0].index(0, 0)); }
};

PrescribedFlow still_water() {
  PrescribedFlow flow;
  flow.density = rho, flow.kinematic_viscosity = nu;
  return flow;
}

std::string with_gravity(const std::string& drag) {
  return "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nforces = [\"" + drag + "\"]\n";
}

/// K of Stokes drag over the mass, 1/s.
double stokes_rate(double d, double density) { return 18 * mu / (density * d * d); }

/// Requirement: a falling small sphere reaches Stokes's terminal velocity, exactly under the law with a Stokes branch.
TEST(PrescribedSphere, TerminalVelocityOfStokes) {
  const double d = 50e-6, density = 2500;
  const double expected = (density - rho) * g * d * d / (18 * mu);
  ASSERT_LT(rho * expected * d / mu, 0.5);
  SphereRun run(sphere(d, density), with_gravity("free_stream_drag"), still_water());
  run.advance(40 / stokes_rate(d, density), 400);
  EXPECT_NEAR(-run.velocity().z, expected, 1e-10 * expected);
}

/// Requirement: a falling larger sphere reaches the velocity at which Schiller and Naumann's drag carries its weight, in all ranges of Re.
TEST(PrescribedSphere, TerminalVelocityOfSchillerNaumann) {
  for (const double d : {20e-6, 200e-6, 2e-3, 20e-3}) {
    const double density = 1500;
    const double weight = (density - rho) * g * std::numbers::pi / 6 * d * d * d;
    const auto drag = [&](double v) {
      const double Re = rho * v * d / mu;
      const double C_d = Re < 1000 ? 24 / Re * (1 + 0.15 * std::pow(Re, 0.687)) : 0.44;
      return 0.5 * rho * C_d * std::numbers::pi / 4 * d * d * v * v;
    };
    double low = 1e-9, high = 10;
    for (int i = 0; i < 200; ++i) (drag(0.5 * (low + high)) < weight ? low : high) = 0.5 * (low + high);
    SphereRun run(sphere(d, density), with_gravity("schiller_naumann"), still_water());
    const double rate = weight / (density * std::numbers::pi / 6 * d * d * d) / low;  // K/m at the end
    run.advance(40 / rate, 2000);
    EXPECT_NEAR(-run.velocity().z, low, 1e-8 * low) << "d = " << d;
  }
}

/// Requirement: two spheres a thousandfold apart in density sink and rise by the sign of m - rho V; a neutrally buoyant one stays.
TEST(PrescribedSphere, BuoyancyDecidesTheWay) {
  for (const double density : {900.0, 1000.0, 1100.0}) {
    SphereRun run(sphere(1e-3, density), with_gravity("schiller_naumann"), still_water());
    run.advance(0.1, 50);
    const double v = run.velocity().z;
    if (density == rho)
      EXPECT_NEAR(v, 0, 1e-15);
    else
      EXPECT_LT(v * (density - rho), 0);
  }
}

/// Requirement: relaxation under Stokes drag is exp(-t/tau) with an error of third order in the sub-step.
TEST(PrescribedSphere, RelaxationOrder) {
  const double d = 50e-6, density = 2500, tau = 1 / stokes_rate(d, density), v = 1e-3;
  std::vector<double> errors;
  for (const int steps : {4, 8, 16}) {
    SphereRun run(sphere(d, density, {v, 0, 0}), "[coupling]\nforces = [\"free_stream_drag\"]\n", still_water());
    run.advance(2 * tau, steps);
    errors.push_back(std::abs(run.velocity().x - v * std::exp(-2.0)) / v);
  }
  const double order = std::log2(errors[0] / errors[2]) / 2;
  std::printf("  errors %.2e %.2e %.2e, order %.2f\n", errors[0], errors[1], errors[2], order);
  EXPECT_GT(order, 2.8);
}

/// Requirement: a sphere in a flow that shears and oscillates follows the exact response; second order in the step.
///   dv/dt = (u - v)/tau with u = a sin(omega t) in x (x is not in u): v = a (sin wt - w tau cos wt + w tau exp(-t/tau))/(1 + (w tau)^2)
TEST(PrescribedSphere, OscillationOrder) {
  const double d = 50e-6, density = 2500, tau = 1 / stokes_rate(d, density), w = 2 / tau, a = 1e-3, end = 3 * tau;
  const double wt = w * end;
  const double expected = a * (std::sin(wt) - w * tau * std::cos(wt) + w * tau * std::exp(-end / tau)) / (1 + w * w * tau * tau);
  std::vector<double> errors;
  for (const int steps : {20, 40, 80}) {
    PrescribedFlow flow = still_water();
    flow.amplitude = {a, 0, 0}, flow.omega = {w, 0, 0};
    flow.gradient[1] = {0, 0, 3};  // u_y = 3 z, and z = 0: felt by nobody
    SphereRun run(sphere(d, density), "[coupling]\nforces = [\"free_stream_drag\"]\n", flow);
    run.advance(end, steps);
    errors.push_back(std::abs(run.velocity().x - expected) / a);
    EXPECT_EQ(run.velocity().y, 0);
  }
  const double order = std::log2(errors[0] / errors[2]) / 2;
  std::printf("  errors %.2e %.2e %.2e, order %.2f\n", errors[0], errors[1], errors[2], order);
  EXPECT_GT(order, 1.8);
}

/// Requirement: in a shear flow u_x = G y the sphere drifts with the velocity at its own place.
TEST(PrescribedSphere, ShearIsTakenAtTheParticle) {
  PrescribedFlow flow = still_water();
  flow.gradient[0] = {0, 10, 0};
  auto piece = sphere(50e-6, 1000);
  piece.centre = {0, 2e-3, 0};
  SphereRun run(piece, "[coupling]\nforces = [\"free_stream_drag\"]\n", flow);
  run.advance(0.05, 100);
  EXPECT_NEAR(run.velocity().x, 0.02, 1e-12);
}

/// Requirement: steps far above the relaxation time are stable, do not ring, and end at the terminal velocity.
TEST(PrescribedSphere, StiffDragIsStable) {
  const double d = 50e-6, density = 2500, tau = 1 / stokes_rate(d, density);
  const double terminal = (density - rho) * g * d * d / (18 * mu);
  SphereRun run(sphere(d, density, {1e-3, 0, 0}), with_gravity("free_stream_drag"), still_water());
  double largest = 0;
  for (int n = 0; n < 60; ++n) {
    run.solver.step(500 * tau);
    largest = std::max(largest, norm(run.velocity()));
  }
  EXPECT_LT(largest, 2 * terminal);
  EXPECT_NEAR(run.velocity().z, -terminal, 1e-3 * terminal);
  EXPECT_LT(std::abs(run.velocity().x), 1e-6);
}

}  // namespace
}  // namespace snag
