#pragma once
// Momentum of the whole domain:   d/dt sum rho V u + sum_b (rho F u + p S - viscous stress) = sum V (body force + f - beta u)
// Sums of the very terms of the momentum equation: faces between cells cancel, and what remains is the tolerance of the linear solver.
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

/// Terms in the last step, N; not closed in a turning frame, which adds a force.
struct MomentumBalance {
  Vec3 change;      // d/dt of the fluid's momentum
  Vec3 convection;  // carried out through the boundary
  Vec3 pressure;    // sum p S of the boundary: force of the fluid on it
  Vec3 friction;    // viscous force of the fluid on the boundary
  Vec3 body;        // body force on the fluid
  Vec3 given;       // by the rags: sum V (f - beta u), with the velocity at the end of the step
  Vec3 residual() const { return change + convection + pressure + friction - body - given; }
};

/// Collective.
inline MomentumBalance momentum_balance(const FlowSolver& water) {
  const Flow& flow = water.flow;
  const Mesh& mesh = flow.mesh;
  const TimeScheme& time = water.time_scheme();
  MomentumBalance balance;
  double volume = 0;
  const double inertia = flow.density / time.dt;
  for (int c = 0; c < mesh.n_cells; ++c) {
    balance.change += inertia * mesh.cell_volume[c] *
                      (time.now * flow.velocity[c] + time.old * flow.velocity_old[c] + time.older * flow.velocity_older[c]);
    if (!flow.reaction.empty()) balance.given += mesh.cell_volume[c] * flow.reaction[c];
    volume += mesh.cell_volume[c];
  }
  balance.body = volume * flow.body_force;
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) {
    const int b = f - mesh.n_interior;
    balance.pressure += flow.boundary_pressure[b] * mesh.face_vector[f];
    balance.friction += flow.boundary_friction[b];
    balance.convection += flow.boundary_convection[b];
  }
  for (Vec3* term : {&balance.change, &balance.body, &balance.given, &balance.pressure, &balance.friction, &balance.convection})
    *term = sum(mesh.comm, std::span<const Vec3>(term, 1));
  return balance;
}

}  // namespace snag
