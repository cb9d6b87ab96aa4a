#pragma once
// What a user sets of the flow solver: the table [flow].
#include <optional>
#include <string>

#include "base/choice.hpp"
#include "base/parameter.hpp"
#include "solver/operators/poisson.hpp"

namespace snag {

struct FlowSettings {
  double density = 998.2;                     // kg/m3
  std::optional<double> dynamic_viscosity;    // Pa s
  std::optional<double> kinematic_viscosity;  // m2/s
  std::string convection = "linear_upwind";
  std::string limiter = "venkatakrishnan";
  int n_outer_correctors = 1;
  int n_non_orthogonal_correctors = 1;
  double momentum_tolerance = 1e-8;
  double pressure_tolerance = 1e-6;
  double pressure_tolerance_intermediate = 1e-1;
  Choice<Multigrid> multigrid{Multigrid::boomeramg, {"boomeramg", "gamg"}};
  Vec3 initial_velocity;  // m/s
  Vec3 body_force;        // N/m3

  /// The table [flow]; its records point into this object.
  Section section();
  /// Dynamic viscosity in force, Pa s. Throws Error(usage) if both viscosities are given; water at 20 C if none is.
  double viscosity() const;
};

}  // namespace snag
