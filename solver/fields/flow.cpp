#include "solver/fields/flow.hpp"

namespace snag {

Flow::Flow(const Mesh& m)
    : mesh(m),
      velocity(m.n_all_cells()),
      velocity_old(m.n_all_cells()),
      velocity_older(m.n_all_cells()),
      pressure(m.n_all_cells()),
      velocity_gradient(m.n_all_cells()),
      velocity_gradient_old(m.n_all_cells()),
      pressure_gradient(m.n_all_cells()),
      flux(m.n_faces),
      flux_old(m.n_faces),
      mesh_flux(m.n_faces),
      face_viscosity(m.n_faces),
      boundary_pressure(m.n_faces - m.n_interior),
      boundary_friction(m.n_faces - m.n_interior),
      turning_friction(m.n_faces - m.n_interior),
      boundary_convection(m.n_faces - m.n_interior) {}

}  // namespace snag
