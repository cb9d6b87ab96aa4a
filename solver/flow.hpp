#pragma once
// The state of the water: cell-centred fields on one mesh, incompressible.
//
//   rho (du/dt + div(u u)) = - grad p + div(mu (grad u + grad u^T)) + f - beta u,      div u = 0
//
// f (`reaction`) and beta (`drag`) are what the rags give: N/m3 and kg/(m3 s), set by the coupling before each step and zero without rags.
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct Flow {
  explicit Flow(const Mesh& mesh);

  const Mesh& mesh;
  double density = 998.2;               // kg/m3
  double dynamic_viscosity = 1.003e-3;  // Pa s
  double time = 0;                      // s
  std::int64_t time_step = 0;           // steps done

  // [n_all_cells], ghosts up to date after every step
  std::vector<Vec3> velocity, velocity_old, velocity_older;  // u at t, t - dt, t - 2 dt; m/s
  std::vector<double> pressure;                              // p, Pa (relative)
  std::vector<Mat3> velocity_gradient;                       // G_ij = du_i/dx_j, 1/s
  std::vector<Vec3> pressure_gradient;                       // Pa/m
  // [n_faces]
  std::vector<double> flux, flux_old;  // volume flux along S, m3/s

  // from the rags, [n_cells]
  std::vector<Vec3> reaction;          // f
  std::vector<double> drag;            // beta
  std::vector<double> solid_fraction;  // 1
  Vec3 body_force;                     // N/m3, uniform (periodic channels)
};

}  // namespace snag
