// Requirement: a frozen flow at another rate has each field times the power of the velocity that is its own, with the field that only one
// turbulence model has.
#include <gtest/gtest.h>

#include "simulation/setup/start_flow.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

TEST(ScaleFlow, PowersOfTheVelocity) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 2});
  Flow flow(mesh);
  const auto n = static_cast<std::size_t>(mesh.n_all_cells());
  flow.velocity.assign(n, {1, 2, 3}), flow.pressure.assign(n, 5);
  flow.turbulent_kinetic_energy.assign(n, 7), flow.dissipation_rate.assign(n, 11), flow.eddy_viscosity.assign(n, 13);
  flow.model_fields = {{"specific_dissipation_rate", "1/s", 1, std::vector<double>(n, 17)},
                       {"other", "m2/s2", 2, std::vector<double>(n, 19)}};
  const Flow as_started = flow;
  scale_flow(flow, as_started, 3);
  EXPECT_EQ(flow.velocity[0], (Vec3{3, 6, 9}));
  EXPECT_EQ(flow.pressure[0], 9 * 5);
  EXPECT_EQ(flow.turbulent_kinetic_energy[0], 9 * 7);
  EXPECT_EQ(flow.dissipation_rate[0], 27 * 11);
  EXPECT_EQ(flow.eddy_viscosity[0], 3 * 13);
  EXPECT_EQ(flow.model_fields[0].values.back(), 3 * 17);
  EXPECT_EQ(flow.model_fields[1].values.back(), 9 * 19);
}

}  // namespace
}  // namespace snag
