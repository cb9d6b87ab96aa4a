// ranks: 1
// long ranks: 2
#include <gtest/gtest.h>

#include "tests/verification/solver/manufactured.hpp"

using namespace snag;
using namespace snag::test;

namespace {

struct Errors {
  std::vector<double> h, velocity, pressure;
};

/// Errors at t = 0.4 with time steps in proportion to the cells.
Errors errors_on(const std::function<Mesh(int)>& mesh_of, const std::vector<int>& sizes, const FlowSettings& settings) {
  Errors errors;
  const Manufactured exact;
  for (const int n : sizes) {
    const Mesh mesh = mesh_of(n);
    const auto solver = exact.solver(mesh, settings);
    const int steps = 2 * n;
    for (int i = 0; i < steps; ++i) exact.advance(*solver, 0.4 / steps);
    errors.h.push_back(1.0 / n);
    errors.velocity.push_back(velocity_error(solver->flow, exact.velocity_field()));
    errors.pressure.push_back(pressure_error(solver->flow, [&](const Vec3& x, double t) { return exact.pressure(x, t); }));
  }
  return errors;
}

Mesh hexahedra(int n) { return structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {n, n, n}); }
Mesh tetrahedra(int n) { return tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {n, n, n}); }

}  // namespace

// The solver is second order in space and time on hexahedra, pressure included. The force that makes the solution passes through
// Continuity::balance_reaction, as that of rags does, which is second order as well; with 8 cells its error is not yet small.
TEST(ManufacturedOrder, hexahedra) {
  const Errors errors = errors_on(hexahedra, {12, 16, 24}, sharp_settings());
  EXPECT_GT(observed_order("velocity, hexahedra", errors.h, errors.velocity), 1.8);
  EXPECT_GT(observed_order("pressure, hexahedra", errors.h, errors.pressure), 1.6);
}

// Velocity is second order on distorted tetrahedra, pressure at least first.
TEST(ManufacturedOrder, tetrahedra) {
  const Errors errors = errors_on(tetrahedra, {6, 8, 12, 16}, sharp_settings());
  EXPECT_GT(observed_order("velocity, tetrahedra", errors.h, errors.velocity), 1.8);
  EXPECT_GT(observed_order("pressure, tetrahedra", errors.h, errors.pressure), 1.4);
}
