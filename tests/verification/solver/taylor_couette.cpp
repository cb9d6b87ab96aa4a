// ranks: 1
// long ranks: 2 3
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

// Between a turning inner and a standing outer cylinder, with a body force G along the axis:
//   u_theta = A r + B/r,   u_z = G/(4 mu) (R1^2 - r^2 + (R2^2 - R1^2) ln(r/R1)/ln(R2/R1)),   torque of the fluid on a cylinder
//   -+ 4 pi mu B L
constexpr double R1 = 0.5, R2 = 1, Omega = 1, rho = 1.2, mu = 0.012, G = 0.1;  // m, rad/s, kg/m3, Pa s, N/m3
constexpr double A = -Omega * R1 * R1 / (R2 * R2 - R1 * R1), B = Omega * R1 * R1 * R2 * R2 / (R2 * R2 - R1 * R1);

Vec3 exact_velocity(const Vec3& x, double) {
  const double r = std::hypot(x.x, x.y), turning = A + B / (r * r);
  return {-turning * x.y, turning * x.x, G / (4 * mu) * (R1 * R1 - r * r + (R2 * R2 - R1 * R1) * std::log(r / R1) / std::log(R2 / R1))};
}

/// rho u_theta^2 / r, integrated.
double exact_pressure(const Vec3& x, double) {
  const double r = std::hypot(x.x, x.y);
  return rho * (0.5 * A * A * r * r + 2 * A * B * std::log(r) - 0.5 * B * B / (r * r));
}

struct Errors {
  double velocity, pressure, torque, balance;  // torque of the inner cylinder and sum of both, over the exact
};

Errors errors_with(int around, const std::string& motion) {
  Shells shells = plane_rings(R1, 0.75, R2, around);
  shells.rotor = {around, around / 8, 1}, shells.stator = {around + around / 8, around / 8, 1};
  Mesh mesh = ring_mesh(shells);
  auto zone = turning_rotor(mesh, shells, Omega, motion, 0.3);
  FlowSettings settings = sharp_settings();
  settings.density = rho, settings.dynamic_viscosity = mu, settings.body_force = {0, 0, G};
  FlowSolver solver(mesh, settings, conditions("[[boundary]]\npatches = [\"rotor_inner\", \"stator_outer\"]\nkind = \"wall\"\n"), nullptr,
                    std::move(zone));
  Flow& flow = solver.flow;
  for (int c = 0; c < mesh.n_cells; ++c) {
    flow.velocity[c] = exact_velocity(mesh.cell_centre[c], 0);
    flow.pressure[c] = exact_pressure(mesh.cell_centre[c], 0);
  }
  const int steps = 5 * around / 2;  // ten seconds: what the mesh disturbs fades within three
  for (int i = 0; i < steps; ++i) solver.advance(10.0 / steps);
  double torque[2] = {};
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    torque[mesh.patches[p].name == "rotor_inner" ? 0 : 1] += patch_force(flow, static_cast<int>(p), {}).friction_torque.z;
  const double exact = 4 * pi * mu * B * shells.height;
  return {velocity_error(flow, exact_velocity), pressure_error(flow, exact_pressure), std::abs(torque[0] / exact + 1),
          std::abs(torque[0] + torque[1]) / exact};
}

void check(const std::string& motion) {
  std::vector<double> h, velocity, pressure, torque, balance;
  for (const int around : {24, 32, 48}) {
    const Errors errors = errors_with(around, motion);
    h.push_back(1.0 / around), velocity.push_back(errors.velocity), pressure.push_back(errors.pressure);
    torque.push_back(errors.torque), balance.push_back(errors.balance);
  }
  EXPECT_GT(observed_order(("velocity, " + motion).c_str(), h, velocity), 1.8);
  EXPECT_GT(observed_order(("pressure, " + motion).c_str(), h, pressure), 1.6);
  observed_order(("torque, " + motion).c_str(), h, torque);
  observed_order(("sum of torques, " + motion).c_str(), h, balance);
  EXPECT_LT(torque.back(), 0.02);
  EXPECT_LT(balance.back(), 0.01);
}

}  // namespace

// Helical flow between cylinders: exact to second order with the inner part turning past the outer one.
TEST(TaylorCouette, sliding) { check("sliding"); }

// The same with the inner part standing, computed in the turning frame.
TEST(TaylorCouette, frame) { check("frame"); }
