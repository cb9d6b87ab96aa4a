// Runs of a case for its observables: the numbers a measurement would have of a sphere, a fibre and a cloth without a mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "casework/case_run.hpp"

namespace snag {
namespace {

constexpr const char* falling_sphere = R"(
[time]
end_s = 0.8
step_s = 5e-5
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = 1000
kinematic_viscosity_m2_s = 1e-3
[[particle]]
diameter_m = 5e-3
density_kg_m3 = 1150
position_m = [1, 0, 0]
[coupling]
forces = ["free_stream_drag"]
)";

std::vector<double> run(const std::string& text, const std::vector<ObservableRequest>& asked) {
  return run_in_memory(CaseFile::parse(text), asked);
}

/// Requirement: place and velocity are those of the exact motion at any time, also between two steps.
TEST(CaseRun, FallingSphereInStokesFlow) {
  const double rate = 18 * 1.0 / (1150 * 25e-6), terminal = -9.81 * (1 - 1000.0 / 1150) / rate;
  for (const double t : {0.0, 1e-3, 0.01242, 0.35017, 0.8}) {
    const auto seen = run(falling_sphere, {{"z", t}, {"vz", t}, {"x", t}});
    const double v = terminal * (1 - std::exp(-rate * t)), z = terminal * (t - (1 - std::exp(-rate * t)) / rate);
    EXPECT_NEAR(seen[0], z, 2e-4 * std::abs(terminal) / rate) << t;
    EXPECT_NEAR(seen[1], v, 1e-2 * std::abs(terminal)) << t;
    EXPECT_NEAR(seen[2], 1.0, 1e-15) << t;
  }
}

/// Requirement: what is asked in any order is answered in that order, and a time after the end of the case has no answer.
TEST(CaseRun, OrderAndEnd) {
  const auto seen = run(falling_sphere, {{"z", 0.5}, {"z", 0.1}, {"z", 1.5}, {"z", 0.5}});
  EXPECT_LT(seen[0], seen[1]);
  EXPECT_TRUE(std::isnan(seen[2]));
  EXPECT_EQ(seen[0], seen[3]);
}

/// Requirement: a run that goes on from another state is the motion from there, also where the time of that state is between two steps;
/// what was before it is as without it.
TEST(CaseRun, GoesOnFromAMeasuredState) {
  const double rate = 18 * 1.0 / (1150 * 25e-6), time = 0.40002;
  const std::vector<ObservableRequest> asked{{"z", 0.3999}, {"z", 0.4001}, {"z", 0.42}, {"x", 0.8}, {"vz", 0.401}};
  const Restart restart{.time = time, .position = {0.01, 0, 0.02}, .velocity = {0, 0, 0.05}};
  const auto before = run(falling_sphere, asked);
  const auto after = run_in_memory(CaseFile::parse(falling_sphere), asked, {}, nullptr, restart);
  EXPECT_EQ(after[0], before[0]);
  for (const auto& [i, t] : {std::pair{1, 0.4001}, {2, 0.42}})
    EXPECT_NEAR(after[i] - before[i], 0.02 + 0.05 * (1 - std::exp(-rate * (t - time))) / rate, 1e-6) << t;
  EXPECT_NEAR(after[3] - before[3], 0.01, 1e-15);
  EXPECT_NEAR(after[4] - before[4], 0.05 * std::exp(-rate * (0.401 - time)), 0.05 * rate * 1e-4);
}

/// Requirement: the picture of a stiff fibre is that of its rectangle: area, elongation, orientation in the picture's plane.
TEST(CaseRun, PictureOfAFibre) {
  const std::string fibre = R"(
[time]
end_s = 0.002
[flow]
kind = "prescribed"
[[fibre]]
length_mm = 20
n_points = 10
density_kg_m3 = 1000
lengthwise = [3, 4, 0]
[coupling]
forces = []
)";
  const auto seen = run(fibre, {{"area", 0.001}, {"elongation_ratio", 0.001}, {"orientation", 0.001}});
  EXPECT_NEAR(seen[0], 0.020 * 0.002, 1e-3 * 4e-5);
  EXPECT_NEAR(seen[1], 10, 1e-3 * 10);
  EXPECT_NEAR(seen[2], std::atan2(4, 3), 1e-9);
  const auto end_on = run(fibre + "[virtual_camera]\nright = [4, -3, 0]\nup = [0, 0, 1]\n", {{"area", 0.001}});
  EXPECT_NEAR(end_on[0], std::numbers::pi / 4 * 4e-6, 1e-3 * 4e-6);
}

/// Requirement: a sphere carried by uniform flow leaves at the plane when it is there; one that never comes has no retention time.
TEST(CaseRun, RetentionTime) {
  const std::string carried = R"(
[time]
end_s = 1
[flow]
kind = "prescribed"
velocity_m_s = [0.5, 0, 0]
[[particle]]
velocity_m_s = [0.5, 0, 0]
[coupling]
forces = ["free_stream_drag"]
[virtual_camera]
exit_normal = [1, 0, 0]
exit_point_m = )";
  const std::vector<ObservableRequest> asked{{"retention_time"}, {"exited"}};
  const auto left = run(carried + "[0.20013, 0, 0]", asked), stays = run(carried + "[0.7, 0, 0]", asked);
  EXPECT_NEAR(left[0], 0.40026, 1e-9);
  EXPECT_EQ(left[1], 1);
  EXPECT_TRUE(std::isnan(stays[0]));
  EXPECT_EQ(stays[1], 0);
}

/// Requirement: what cannot be asked of a run is refused with the names that can.
TEST(CaseRun, RefusesWhatItCannotAnswer) {
  EXPECT_THROW(run(falling_sphere, {{"head", 0.1}}), Error);
  EXPECT_THROW(run(falling_sphere, {{"x"}}), Error);
  EXPECT_THROW(run(falling_sphere, {{"exited", 0.1}}), Error);
  for (const char* of_a_pump : {"stuck", "recirculations", "time_to_enter"}) EXPECT_THROW(run(falling_sphere, {{of_a_pump}}), Error);
}

}  // namespace
}  // namespace snag
