#pragma once
// The state of the water: cell-centred fields on one mesh, incompressible.
//
//   rho (du/dt + div(u u)) = - grad p + div(mu (grad u + grad u^T)) + f,      div u = 0
//
// f (`reaction`, N/m3) is what the rags give, set by the coupling before each step and zero without rags. The step shares it among cells
// side by side, so that pressure can hold it (solver/continuity.hpp).
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

class RotatingZone;

/// A cell field that one turbulence model has and others lack.
struct ModelField {
  std::string name, unit;      // in field files
  int velocity_power = 0;      // it grows with this power of the velocity, where only convection counts
  std::vector<double> values;  // [n_all_cells]
};

struct Flow {
  explicit Flow(const Mesh& mesh);

  const Mesh& mesh;
  const RotatingZone* rotating_zone = nullptr;  // the turning part, null without
  double density = 998.2;                       // kg/m3
  double dynamic_viscosity = 1.003e-3;          // Pa s
  double time = 0;                              // s
  double time_step_size = 0;                    // of the last step, s; 0 before the first
  bool frozen = false;                          // steps change nothing but the time
  std::int64_t time_step = 0;                   // steps done

  // [n_all_cells], ghosts up to date after every step
  std::vector<Vec3> velocity, velocity_old, velocity_older;    // u at t, t - dt, t - 2 dt; m/s
  std::vector<double> pressure;                                // p, Pa (relative)
  std::vector<Mat3> velocity_gradient, velocity_gradient_old;  // G_ij = du_i/dx_j at t, t - dt; 1/s. Within a step, until the pressure is
                                                               // corrected: that of the explicit terms, and that at the begin
  std::vector<Vec3> pressure_gradient;                         // Pa/m
  // [n_faces]
  std::vector<double> flux, flux_old;  // volume flux along S, m3/s
  std::vector<double> mesh_flux;       // volume that the face sweeps along S, m3/s: zero where the mesh stands still
  std::vector<double> face_viscosity;  // mu, of turbulence too, Pa s
  bool variable_viscosity = false;     // adds div(mu grad u^T), which is zero for constant mu
  // [n_faces - n_interior], boundary face f at f - n_interior
  std::vector<double> boundary_pressure;  // p at the face, Pa
  std::vector<Vec3> boundary_friction;    // viscous force of the fluid on the face as it stood in the momentum equation, N
  std::vector<Vec3> turning_friction;     // of it on a wall that turns, what the equation leaves out where mu is constant, N
  std::vector<Vec3> boundary_convection;  // momentum carried out through the face, likewise, N

  // of a turbulence model, empty without one
  std::vector<double> turbulent_kinetic_energy, dissipation_rate, eddy_viscosity;  // k, m2/s2; epsilon, m2/s3; nu_t, m2/s; [n_all_cells]
  std::vector<ModelField> model_fields;
  std::vector<double> y_plus;               // [n_faces - n_interior], u y/nu of the cell at a wall face, u the friction velocity of the
                                            // model or C_mu^(1/4) k^(1/2); 0 elsewhere
  std::vector<std::uint8_t> wall_function;  // likewise: 1 where face_viscosity (u_P - u_w)/y is the shear of a wall function

  // from the rags, [n_cells], empty without
  std::vector<Vec3> reaction;          // f
  std::vector<double> solid_fraction;  // 1
  std::vector<double> screen;          // s, of cloth that eddies do not cross, 1/m, [n_all_cells]; empty without
  Vec3 body_force;                     // N/m3, uniform (periodic channels)
};

}  // namespace snag
