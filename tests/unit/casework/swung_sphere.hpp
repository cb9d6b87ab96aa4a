#pragma once
// A diagnosis of two points whose runs are those of one small case.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "casework/case_simulator.hpp"
#include "parallel/session.hpp"

namespace snag {

inline constexpr const char* swung_sphere = R"(
[time]
end_s = 0.1
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = 1000
kinematic_viscosity_m2_s = 1e-5
velocity_m_s = [0.1, 0, 0]
amplitude_m_s = [0.2, 0, 0]
angular_frequency_rad_s = [20, 0, 0]
[[particle]]
diameter_m = 5e-3
density_kg_m3 = 1150
position_m = [0.5, 0, 0]
[coupling]
mode = "one_way"
forces = ["schiller_naumann"]
)";

inline RunRequest with(const std::string& effect, double theta) {
  RunRequest request;
  request.effects[effect] = theta;
  return request;
}

inline RunRequest with_input(const std::string& nuisance, double deviation) {
  RunRequest request;
  request.nuisances[nuisance] = deviation;
  return request;
}

/// Two points of one case; x at three times.
class CaseSimulatorTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() / ("snag-" + test + "-" + std::to_string(size_of(MPI_COMM_WORLD)));
    if (rank_of(MPI_COMM_WORLD) == 0) {
      std::filesystem::create_directories(folder_);
      std::ofstream(folder_ / "case.toml") << swung_sphere;
    }
    MPI_Barrier(MPI_COMM_WORLD);
    experiment_.observables = {{.id = "x", .unit = "m", .noise_u = 1e-4, .bias_u = 1e-3, .calibration_group = "camera"}};
    for (const char* id : {"A", "B"})
      experiment_.points.push_back(
          {.id = id,
           .case_file = folder_ / "case.toml",
           .input_u = {{"flow.amplitude", 0.05}, {"particle.density_kg_m3", 0.01}, {"drag_law_uncertainty", 0.05}}});
    for (const int point : {0, 1})
      for (const double t : {0.02, 0.05, 0.1}) experiment_.data.push_back({.point = point, .time = t});
  }
  void TearDown() override {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(folder_);
  }
  std::vector<double> values(CaseSimulator& simulator, const RunRequest& request) {
    const auto results = simulator.run(std::vector<RunRequest>{request});
    EXPECT_EQ(results[0].failure, "");
    return results[0].values;
  }
  std::filesystem::path folder_;
  Experiment experiment_;
};

}  // namespace snag
