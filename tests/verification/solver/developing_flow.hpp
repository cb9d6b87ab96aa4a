#pragma once
// A turbulent flow under a constant force, advanced until nothing changes.
#include <cstdio>
#include <string>

#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/pipe_sector.hpp"

namespace snag::test {

struct Developed {
  double mean_velocity, y_plus;
};

/// Advance under a constant force until nothing changes.
/// Convection by upwind differences: that along a developed flow is zero, and on tetrahedra at Courant numbers above 20 linear_upwind with
/// one corrector is unstable, with or without a turbulence model.
inline Developed develop(const Mesh& mesh, const std::string& boundary, double force, double dt, const std::string& model = "k_epsilon",
                         double speed = 2.2608) {
  FlowSettings settings;
  settings.convection = "upwind", settings.momentum_tolerance = 1e-6;
  settings.body_force = {force, 0, 0}, settings.initial_velocity = {speed, 0, 0};
  FlowSolver solver(mesh, settings, conditions(boundary),
                    read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"" + model +
                                                    "\"\ntolerance = 1e-6\ninitial_k = \"0.02 m2/s2\"\ninitial_epsilon = \"0.02 m2/s3\"\n")
                                        .root()));
  double before = 0, now = 1;
  int steps = 0;
  for (; steps < 3000 && (steps < 40 || std::abs(now - before) > 2e-6 * dt); ++steps) {
    solver.advance(dt);
    before = now, now = mean_velocity(solver.flow);
  }
  double y_plus = 0;
  for (const double value : solver.flow.y_plus) y_plus = std::max(y_plus, value);
  std::printf("%d cells, %d steps, U %.5f, y+ %.0f\n", mesh.n_cells, steps, now, y_plus);
  return {now, y_plus};
}

}  // namespace snag::test
