// ranks: 1
// long ranks: 2 3
#include <gtest/gtest.h>

#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double viscosity = 0.01, k = pi, end_time = 0.5, speed = 4;  // m2/s, 1/m, s, rad/s: two radians, 2.4 m/s at the interface
const Vec3 stream{0.6, 0.35, 0};                                       // m/s

// Decaying vortices carried by a stream, a solution of the full equations:   u = U + rot(psi e_z),  psi = cos(kx')cos(ky')/k e^(-2 nu k^2
// t)
double stream_function(const Vec3& x, double t) {
  const Vec3 y = x - t * stream;
  return std::exp(-2 * viscosity * k * k * t) * std::cos(k * y.x) * std::cos(k * y.y) / k;
}
Vec3 exact_velocity(const Vec3& x, double t) {
  const Vec3 y = x - t * stream;
  const double decay = std::exp(-2 * viscosity * k * k * t);
  return stream + decay * Vec3{-std::cos(k * y.x) * std::sin(k * y.y), std::sin(k * y.x) * std::cos(k * y.y), 0};
}
double exact_pressure(const Vec3& x, double t) {
  const Vec3 y = x - t * stream;
  return -0.25 * 1.2 * std::exp(-4 * viscosity * k * k * t) * (std::cos(2 * k * y.x) + std::cos(2 * k * y.y));
}

/// The exact velocity at the face and the exact flux through it, so that fluxes sum to zero:   int u.dS = U.S + closed integral psi dz
struct ExactVortex final : Boundary {
  Section section() override { return {}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    const Mesh& mesh = flow.mesh;
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - mesh.n_interior, begin = mesh.face_node_start[f], n = mesh.face_node_start[f + 1] - begin;
      values.velocity[b] = exact_velocity(mesh.face_centre[f], time);
      values.flux[b] = dot(stream, mesh.face_vector[f]);
      for (int i = 0; i < n; ++i) {  // psi dz: only upright edges count, along which psi is constant
        const Vec3 &x = mesh.node[mesh.face_node[begin + i]], &y = mesh.node[mesh.face_node[begin + (i + 1) % n]];
        values.flux[b] += stream_function(x, time) * (y.z - x.z);
      }
    }
  }
};

struct Errors {
  double velocity, pressure;
};

Errors errors_with(int around, double zone_speed) {
  const Shells shells = plane_rings(0.3, 0.6, 1, around);
  Mesh mesh = ring_mesh(shells);
  auto zone = turning_rotor(mesh, shells, zone_speed);
  std::vector<PatchBoundary> boundary;
  for (const Patch& patch : mesh.patches) boundary.push_back({patch.name, "test", std::make_unique<ExactVortex>()});
  FlowSettings settings = sharp_settings();
  settings.kinematic_viscosity = viscosity;
  FlowSolver solver(mesh, settings, std::move(boundary), nullptr, std::move(zone));
  for (int c = 0; c < mesh.n_cells; ++c) {
    solver.flow.velocity[c] = exact_velocity(mesh.cell_centre[c], 0);
    solver.flow.pressure[c] = exact_pressure(mesh.cell_centre[c], 0);
  }
  for (int i = 0; i < around; ++i) solver.advance(end_time / around);
  return {velocity_error(solver.flow, exact_velocity), pressure_error(solver.flow, exact_pressure)};
}

}  // namespace

// Vortices that a stream carries through a turning zone: as exact as with the zone at rest, and of the same order.
TEST(SlidingVortex, is_as_exact_as_at_rest) {
  std::vector<double> h, velocity, pressure, velocity_at_rest, pressure_at_rest;
  for (const int around : {36, 48, 72}) {
    const Errors turning = errors_with(around, speed), at_rest = errors_with(around, 0);
    h.push_back(1.0 / around), velocity.push_back(turning.velocity), pressure.push_back(turning.pressure);
    velocity_at_rest.push_back(at_rest.velocity), pressure_at_rest.push_back(at_rest.pressure);
    EXPECT_LT(turning.velocity, 1.5 * at_rest.velocity);
    EXPECT_LT(turning.pressure, 1.5 * at_rest.pressure);
  }
  observed_order("velocity, zone at rest", h, velocity_at_rest);
  observed_order("pressure, zone at rest", h, pressure_at_rest);
  EXPECT_GT(observed_order("velocity, zone turning", h, velocity), 1.8);
  EXPECT_GT(observed_order("pressure, zone turning", h, pressure), 1.1);
}
