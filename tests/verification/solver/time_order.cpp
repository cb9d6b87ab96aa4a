// ranks: 1
#include <gtest/gtest.h>

#include "tests/verification/solver/manufactured.hpp"

using namespace snag;
using namespace snag::test;

namespace {

/// Velocity and pressure at t = 0.4 after `steps` steps whose sizes alternate between (1 - unevenness) and (1 + unevenness) of the mean.
std::pair<std::vector<Vec3>, std::vector<double>> fields_after(const Mesh& mesh, const FlowSettings& settings, int steps,
                                                               double unevenness) {
  const Manufactured exact{.from_rest = true};
  const auto solver = exact.solver(mesh, settings);
  for (int i = 0; i < steps; ++i) exact.advance(*solver, 0.4 / steps * (1 + (i % 2 ? unevenness : -unevenness)));
  return {solver->flow.velocity, solver->flow.pressure};
}

struct Orders {
  double velocity, pressure;
};

/// Orders from the differences of solutions on the same mesh with the step halved again and again: errors in space drop out.
Orders time_orders(const char* name, const FlowSettings& settings, double unevenness) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {5, 5, 5});
  std::vector<double> h, velocity, pressure;
  auto coarse = fields_after(mesh, settings, 40, unevenness);
  for (int steps = 80; steps <= 320; steps *= 2) {
    auto fine = fields_after(mesh, settings, steps, unevenness);
    h.push_back(0.4 / steps);
    velocity.push_back(distance(mesh, [&](int c) { return norm_squared(fine.first[c] - coarse.first[c]); }));
    pressure.push_back(distance(mesh, [&](int c) { return std::pow(fine.second[c] - coarse.second[c], 2); }));
    coarse = std::move(fine);
  }
  return {observed_order((std::string("velocity in time, ") + name).c_str(), h, velocity),
          observed_order((std::string("pressure in time, ") + name).c_str(), h, pressure)};
}

}  // namespace

// Velocity is second order in time with a single corrector, on tetrahedra with non-orthogonal and limited explicit terms.
TEST(TimeOrder, one_corrector) {
  const Orders order = time_orders("one corrector", sharp_settings(), 0);
  EXPECT_GT(order.velocity, 1.8);
  EXPECT_GT(order.pressure, 1.0);
}

// The same with two correctors.
TEST(TimeOrder, two_correctors) {
  FlowSettings settings = sharp_settings();
  settings.n_outer_correctors = 2;
  const Orders order = time_orders("two correctors", settings, 0);
  EXPECT_GT(order.velocity, 1.8);
  EXPECT_GT(order.pressure, 1.0);
}

// A step that changes size every time does not cost the order.
TEST(TimeOrder, uneven_steps) {
  const Orders order = time_orders("uneven steps", sharp_settings(), 0.3);
  EXPECT_GT(order.velocity, 1.8);
}
