// Requirement: an effect that the data do not show is no hypothesis: the probabilities are those of what they can show, and the report says
// that they are blind to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/fitting/fit.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr int n_times = 20;
constexpr double noise = 0.01;

double time_of(int i) { return (i + 1.0) / n_times; }

/// theta_drag t + share theta_damping sin 6t: at the expected strength 1 damping shows by 320 times the share, in standard uncertainties.
class DragAndDamping final : public TestSimulator {
 public:
  explicit DragAndDamping(double share) : share_(share) {
    effects_ = {{.name = "drag", .mean = 1, .sd = 0.5, .maximum = 4}, {.name = "damping", .mean = 1, .sd = 0.5, .maximum = 4}};
    for (int i = 0; i < n_times; ++i) slots_.push_back({0, time_of(i)});
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    std::vector<double> values;
    for (const Slot& slot : slots_)
      values.push_back(number_of(request.effects, "drag") * slot.time +
                       share_ * number_of(request.effects, "damping") * std::sin(6 * slot.time));
    return values;
  }
  double share_;
};

/// Of data that nothing is missing from.
Attribution attributed(double share) {
  Experiment e;
  e.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = "", .numerics_u = 0}};
  e.points = {{.id = "A", .case_file = {}}};
  NormalNumbers random(3);
  for (int i = 0; i < n_times; ++i) e.data.push_back({.time = time_of(i), .value = noise * random()});
  DragAndDamping simulator(share);
  Responses responses(e, simulator);
  Fitter fitter(responses);
  return attribute(responses, fitter, {});
}

bool is_hypothesis(const Attribution& a, const std::string& effect) {
  return std::any_of(a.probability.begin(), a.probability.end(),
                     [&](const auto& one) { return one.first.find(effect) != std::string::npos; });
}

TEST(UnseenEffects, AreNoHypotheses) {
  const Attribution seen = attributed(0.02), unseen = attributed(0.0005);
  EXPECT_TRUE(is_hypothesis(seen, "damping"));
  EXPECT_FALSE(is_hypothesis(unseen, "damping"));
  EXPECT_TRUE(is_hypothesis(unseen, "drag"));
  EXPECT_FALSE(seen.identifiability.blind.contains("damping"));
  EXPECT_TRUE(unseen.identifiability.blind.contains("damping"));
  EXPECT_LT(unseen.identifiability.detectability.at("damping"), 0.3);
}

}  // namespace
}  // namespace snag
