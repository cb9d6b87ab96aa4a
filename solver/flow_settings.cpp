#include "solver/flow_settings.hpp"

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "solver/convection/convection.hpp"
#include "solver/convection/limiter.hpp"

namespace snag {

namespace {
constexpr double water_viscosity = 1.003e-3;  // Pa s at 20 C (IAPWS)
}

Section FlowSettings::section() {
  Section flow{.name = "flow", .meaning = "Water and numerics of the flow solver.", .parameters = {}};
  flow.parameters = {
      {"density", &density, "kg/m3", 1e-6, 1e6, Basis::literature, "Density of the fluid; water at 20 C."},
      {"dynamic_viscosity", &dynamic_viscosity, "Pa s", 0, infinity, Basis::literature,
       "Viscosity; water at 20 C (1.003e-3) if neither this nor kinematic_viscosity is given."},
      {"kinematic_viscosity", &kinematic_viscosity, "m2/s", 0, infinity, Basis::literature,
       "Viscosity over density, instead of dynamic_viscosity."},
      setting("convection", &convection, convection_meaning(), convection_schemes().names()),
      setting("limiter", &limiter, limiter_meaning(), limiters().names()),
      renamed({"n_outer_correctors", &n_outer_correctors, "1", 1, 50, Basis::assumed,
               "Repetitions of momentum and pressure in a step; 1 extrapolates the convecting flux in time, more make large steps robust."},
              {.key = "outer_correctors"}),
      renamed({"n_non_orthogonal_correctors", &n_non_orthogonal_correctors, "1", 0, 20, Basis::assumed,
               "Repetitions of the pressure equation for non-orthogonal meshes."},
              {.key = "n_non_orthogonal"}),
      {"momentum_tolerance", &momentum_tolerance, "1", 1e-15, 0.1, Basis::assumed,
       "Residual of the momentum equation over its right-hand side."},
      {"pressure_tolerance", &pressure_tolerance, "1", 1e-15, 0.1, Basis::assumed,
       "Residual of the last pressure equation of a step over the mass imbalance before it."},
      {"pressure_tolerance_intermediate", &pressure_tolerance_intermediate, "1", 1e-15, 0.5, Basis::assumed,
       "The same for the pressure equations before the last, and for the guessed fluxes of a step where a mesh slides."},
      setting("multigrid", &multigrid, "Preconditioner of the pressure equation."),
      {"initial_velocity", &initial_velocity, "m/s", -infinity, infinity, Basis::assumed,
       "Uniform velocity at the start, made divergence-free before the first step."},
      {"body_force", &body_force, "N/m3", -infinity, infinity, Basis::assumed, "Uniform force on the fluid, for periodic channels."},
  };
  return flow;
}
const bool flow_table = add_case_table<FlowSettings>(50);

double FlowSettings::viscosity() const {
  if (dynamic_viscosity && kinematic_viscosity)
    throw Error(ExitCode::usage, "[flow]: dynamic_viscosity (" + number_text(*dynamic_viscosity) + " Pa s) and kinematic_viscosity (" +
                                     number_text(*kinematic_viscosity) + " m2/s) are both given; give one of them");
  if (dynamic_viscosity) return *dynamic_viscosity;
  return kinematic_viscosity ? *kinematic_viscosity * density : water_viscosity;
}

}  // namespace snag
