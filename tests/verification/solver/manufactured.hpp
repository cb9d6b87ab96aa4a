#pragma once
// An exact solution of the unsteady equations in the unit box, made by the force that it needs (method of manufactured solutions):
//
//   u = T(t) (sin x' cos y' cos z', cos x' sin y' cos z', -2 cos x' cos y' sin z'),   x' = pi x, ...,   T = 1 + sin(2 t)/2       div u = 0,
//   u.n = 0 p = sin(x + 2 y - z + t) f = rho (du/dt + u.grad u) + grad p - mu lap u,   lap u = - 3 pi^2 u
#include "tests/verification/solver/flow_cases.hpp"

namespace snag::test {

struct Manufactured {
  double rho = 1.2, mu = 0.05;
  bool from_rest = false;

  double amplitude(double t) const { return from_rest ? 10 * t * t : 1 + 0.5 * std::sin(2 * t); }
  double amplitude_rate(double t) const { return from_rest ? 20 * t : std::cos(2 * t); }
  double pressure_amplitude(double t) const { return from_rest ? 10 * t * t : 1; }
  static Vec3 shape(const Vec3& x) {
    const double sx = std::sin(pi * x.x), sy = std::sin(pi * x.y), sz = std::sin(pi * x.z);
    const double cx = std::cos(pi * x.x), cy = std::cos(pi * x.y), cz = std::cos(pi * x.z);
    return {sx * cy * cz, cx * sy * cz, -2 * cx * cy * sz};
  }
  static Mat3 shape_gradient(const Vec3& x) {
    const double sx = std::sin(pi * x.x), sy = std::sin(pi * x.y), sz = std::sin(pi * x.z);
    const double cx = std::cos(pi * x.x), cy = std::cos(pi * x.y), cz = std::cos(pi * x.z);
    return {pi * Vec3{cx * cy * cz, -sx * sy * cz, -sx * cy * sz}, pi * Vec3{-sx * sy * cz, cx * cy * cz, -cx * sy * sz},
            -2 * pi * Vec3{-sx * cy * sz, -cx * sy * sz, cx * cy * cz}};
  }
  Vec3 velocity(const Vec3& x, double t) const { return amplitude(t) * shape(x); }
  VectorField velocity_field() const {
    return [exact = *this](const Vec3& x, double t) { return exact.velocity(x, t); };
  }
  double pressure(const Vec3& x, double t) const { return pressure_amplitude(t) * std::sin(x.x + 2 * x.y - x.z + t); }
  Vec3 force(const Vec3& x, double t) const {
    const double T = amplitude(t);
    const Vec3 u = T * shape(x);
    const double slope = pressure_amplitude(t) * std::cos(x.x + 2 * x.y - x.z + t);
    return rho * (amplitude_rate(t) * shape(x) + T * (shape_gradient(x) * u)) + slope * Vec3{1, 2, -1} + 3 * pi * pi * mu * u;
  }

  /// Solver in the exact state at t = 0.
  std::unique_ptr<FlowSolver> solver(const Mesh& mesh, FlowSettings settings) const {
    settings.density = rho, settings.dynamic_viscosity = mu;
    std::vector<PatchBoundary> exact;
    for (const Patch& patch : mesh.patches) add_exact(exact, patch.name, velocity_field(), false);
    auto made = std::make_unique<FlowSolver>(mesh, settings, std::move(exact));
    for (int c = 0; c < mesh.n_cells; ++c) {
      made->flow.velocity[c] = velocity(mesh.cell_centre[c], 0);
      made->flow.pressure[c] = pressure(mesh.cell_centre[c], 0);
    }
    return made;
  }
  StepReport advance(FlowSolver& solver, double dt) const {
    Flow& flow = solver.flow;
    flow.reaction.resize(static_cast<std::size_t>(flow.mesh.n_cells));
    for (int c = 0; c < flow.mesh.n_cells; ++c) flow.reaction[c] = force(flow.mesh.cell_centre[c], flow.time + dt);
    return solver.advance(dt);
  }
};

}  // namespace snag::test
