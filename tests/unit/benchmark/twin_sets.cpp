// Sets of the blind benchmark: what they hold is what diagnosis.md asks for, and can be measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "benchmark/blind/twin.hpp"
#include "benchmark/blind/twin_set.hpp"

namespace snag {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Requirement: truths outside the library are periodic force, stratification, gust, curved profile and skew camera; pieces with a shape
/// may be curved, too.
TEST(TwinSets, OutsideTruths) {
  const auto of_sphere = unmodelled_truths("sphere"), of_rag = unmodelled_truths("rag");
  for (const char* name : {"periodic", "stratified", "profile", "camera"})
    EXPECT_EQ(std::count(of_sphere.begin(), of_sphere.end(), name), 1) << name;
  EXPECT_EQ(std::count(of_sphere.begin(), of_sphere.end(), "curved"), 0);
  EXPECT_EQ(std::count(of_rag.begin(), of_rag.end(), "curved"), 1);
  TwinExperiment experiment;
  experiment.times = {1}, experiment.tip_acceleration = 10;
  NormalNumbers random(3);
  for (const std::string& name : of_rag) EXPECT_TRUE(unmodelled_truth(name, 1, experiment, random).acts()) << name;
  EXPECT_FALSE(unmodelled_truth("", 1, experiment, random).acts());
}

/// Requirement: what curves a piece neither pushes nor turns it.
TEST(TwinSets, CurvatureHasNoNetForce) {
  TwinExperiment experiment;
  experiment.times = {1}, experiment.tip_acceleration = 10;
  NormalNumbers random(3);
  const UnmodelledTruth curved = unmodelled_truth("curved", 1, experiment, random);
  Vec3 force, torque;
  double most = 0;
  constexpr int n = 12;
  for (int i = 0; i < n; ++i) {
    const double along = (2.0 * i - (n - 1)) / (n - 1);
    const Vec3 x{along, 0, 0}, f = curved.force(0, {.x = x, .along = along, .mean_abs_along = 0.5 * n / (n - 1), .normal = {0, 0, 1}});
    force += f, torque += cross(x, f), most = std::max(most, norm(f));
  }
  EXPECT_GT(most, 1);
  EXPECT_LT(norm(force), 1e-12);
  EXPECT_LT(norm(torque), 1e-12);
}

/// Requirement: a set is the same each time it is made, and what its base case passes is passed within the time that is looked at.
TEST(TwinSets, FibreSetsAreReproducibleAndPassTheirExit) {
  const auto folder = std::filesystem::temp_directory_path() / "snag-twin-sets";
  const TwinPlan plan{.twin = "fibre", .level = "L2", .seed = 5};
  constexpr int null_set = 12;
  EXPECT_EQ(make_twin(plan, null_set, folder / "a").kind, "null");
  make_twin(plan, null_set, folder / "b");
  for (const char* file : {"data.csv", "DIAGNOSIS.toml", "point_A.toml"})
    EXPECT_EQ(text_of(folder / "a" / file), text_of(folder / "b" / file));
  EXPECT_NE(text_of(folder / "a" / "data.csv").find("retention_time"), std::string::npos);
  EXPECT_EQ(text_of(folder / "a" / "data.csv").find(",1\n"), std::string::npos) << "pieces that do not reach the exit";
  std::filesystem::remove_all(folder);
}

/// Requirement: an axis that turned past the edge of its range has turned a little, not by half a circle.
TEST(TwinSets, AxesDifferTheShortWay) {
  NormalNumbers random(7);
  const TwinSet set{.twin = "fibre", .experiment = twin_experiment("fibre", random), .truth = {}};
  EXPECT_NEAR(set.difference("orientation", 1.56, -1.55), 3.11 - std::numbers::pi, 1e-12);
  EXPECT_NEAR(set.difference("x", 1.56, -1.55), 3.11, 1e-12);
}

/// A sphere set without deviations whose truth is this; noise of many replicates.
TwinSet sphere_set(const std::map<std::string, double>& theta) {
  NormalNumbers random(7);
  TwinSet set{.twin = "sphere", .experiment = twin_experiment("sphere", random), .truth = {}};
  const auto folder = std::filesystem::temp_directory_path() / "snag-twin-strength";
  std::filesystem::create_directories(folder);
  for (const std::string& text : set.experiment.cases) {
    std::ofstream(folder / "point.toml") << text;
    set.cases.emplace_back(folder / "point.toml");
  }
  std::filesystem::remove_all(folder);
  set.deviations.resize(set.cases.size());
  set.truth.theta = theta, set.truth.kind = "single", set.truth.subset = "all", set.truth.replicates = 50;
  return set;
}

/// Requirement: what changes no sample is no truth: a sphere that touches nothing has no friction.
TEST(TwinSets, TruthsCanShow) {
  const std::vector<Effect> effects = showable(sphere_set({}));
  const auto holds = [&](const char* name) {
    return std::any_of(effects.begin(), effects.end(), [&](const Effect& effect) { return effect.name == name; });
  };
  EXPECT_TRUE(holds("wall") && holds("added_mass") && holds("measurement"));
  EXPECT_FALSE(holds("friction"));
}

/// Requirement: an effect that is nothing but an uncertain input m standard uncertainties off can be told by m at most, however far off
/// the model is from linear: the drag law by its factor, and by its slope over Re, both of which a diagnosis keeps free.
TEST(TwinSets, DragIsToldByNoMoreThanItsLawIsOff) {
  constexpr double u = 0.05;  // of the drag law
  for (const double m : {3.0, 6.0}) {
    TwinSet level = sphere_set({{"drag_magnitude", m * u}}), slope = sphere_set({{"drag_exponent", m * u / std::log(10.0)}});
    for (TwinSet* set : {&level, &slope}) {
      measure_gap(*set);
      EXPECT_LT(set->truth.detectability, 1.02 * m) << set->truth.name();
      EXPECT_GT(set->truth.detectability, 0.8 * m) << set->truth.name();
    }
  }
}

/// Requirement: what no input can do is told as clearly as the noise allows.
TEST(TwinSets, LiftIsToldByMuch) {
  TwinSet set = sphere_set({{"lift", 1}});
  measure_gap(set);
  EXPECT_GT(set.truth.detectability, 20);
}

}  // namespace
}  // namespace snag
