// Momentum of the whole domain:   d/dt sum rho V u + sum_b (rho F u + p S - viscous stress) = sum V (body force + f - beta u)
// Sums of the very terms of the momentum equation: faces between cells cancel, and what remains is the tolerance of the linear solver.
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

Vec3 FlowSolver::momentum_given() const {
  std::vector<Vec3> given(flow.mesh.n_cells);
  for (int c = 0; c < flow.mesh.n_cells; ++c) given[c] = flow.mesh.cell_volume[c] * flow.reaction[c];
  return sum(flow.mesh.comm, std::span<const Vec3>(given));
}

MomentumBalance FlowSolver::momentum_balance() const {
  const Mesh& mesh = flow.mesh;
  MomentumBalance balance;
  balance.given = momentum_given();
  double volume = 0;
  const double inertia = flow.density / time_.dt;
  for (int c = 0; c < mesh.n_cells; ++c) {
    balance.change += inertia * mesh.cell_volume[c] *
                      (time_.now * flow.velocity[c] + time_.old * flow.velocity_old[c] + time_.older * flow.velocity_older[c]);
    volume += mesh.cell_volume[c];
  }
  balance.body = volume * flow.body_force;
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) {
    const int b = f - mesh.n_interior;
    balance.pressure += flow.boundary_pressure[b] * mesh.face_vector[f];
    balance.friction += flow.boundary_friction[b];
    balance.convection += flow.boundary_convection[b];
  }
  for (Vec3* term : {&balance.change, &balance.body, &balance.pressure, &balance.friction, &balance.convection})
    *term = sum(mesh.comm, std::span<const Vec3>(term, 1));
  return balance;
}

}  // namespace snag
