#pragma once
// What a test rig would read off the water: flow rates and pressures at patches, forces and torques on walls. All collective, the same on
// every rank.
#include "solver/fields/flow.hpp"

namespace snag {

/// Volume flow out of the domain through a patch, m3/s.
double flow_rate(const Flow& flow, int patch);
/// Sum of the areas of the faces of a patch, m2.
double patch_area(const Flow& flow, int patch);
/// Mean pressure of a patch over its area, Pa.
double mean_pressure(const Flow& flow, int patch);
/// Mean over the flux: of the static pressure, and of the total pressure p + rho u^2/2 with u at the faces, Pa. Zero where nothing flows.
struct FluxMeans {
  double static_pressure = 0, total_pressure = 0;
};
FluxMeans flux_means(const Flow& flow, int patch);

/// Force of the fluid on a patch and its torque about a point: by pressure and by friction, as they stood in the momentum equation of the
/// last step, with what the equation leaves out on walls that turn (Flow::turning_friction).
struct PatchForce {
  Vec3 pressure, friction;                // N
  Vec3 pressure_torque, friction_torque;  // N m
  Vec3 force() const { return pressure + friction; }
  Vec3 torque() const { return pressure_torque + friction_torque; }
};
PatchForce patch_force(const Flow& flow, int patch, const Vec3& origin);

/// y+ = C_mu^(1/4) k^(1/2) y/nu of the cells at the walls of a patch, the mean weighted with area; zero without a turbulence model.
struct YPlus {
  double lowest = 0, mean = 0, highest = 0;
};
YPlus y_plus_of(const Flow& flow, int patch);

/// Kinetic energy of the whole domain, J.
double kinetic_energy(const Flow& flow);

}  // namespace snag
