#pragma once
// A channel of 2 m by 1 m by 1 m on distorted tetrahedra, with walls above and below, that several tests send water through.
#include "tests/verification/solver/flow_cases.hpp"

namespace snag::test {

/// Conditions as a case file has them; `inlet`: keys of patch x0, `outlet`: more keys of the pressure outlet x1.
inline std::string channel(const std::string& inlet, const std::string& outlet = "") {
  return R"(
[[boundary]]
patches = ["z0", "z1"]
kind = "wall"
[[boundary]]
patches = ["y0", "y1"]
kind = "symmetry"
[[boundary]]
patch = "x0"
)" + inlet +
         R"(
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)" + outlet;
}

/// `n_y`: cells across.
inline Mesh channel_mesh(int n_y) { return tetrahedral_box(MPI_COMM_WORLD, {.upper = {2, 1, 1}, .distortion = 0.15}, {10, n_y, 6}); }

inline FlowSettings channel_settings(double kinematic_viscosity) {
  FlowSettings settings = sharp_settings();
  settings.kinematic_viscosity = kinematic_viscosity;
  return settings;
}

}  // namespace snag::test
