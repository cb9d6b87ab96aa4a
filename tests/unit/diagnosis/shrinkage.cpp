// How far the gap shrinks at withheld points where the runs with the effect lack numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr int n_times = 10, n_training = 3, n_points = 6;
constexpr double noise = 1e-3;

enum class Withheld { answer, leave_early, fail };

/// A path t + theta t^2. At withheld points the runs with much of the effect leave half-way, or fail at one point.
class Pushed final : public TestSimulator {
 public:
  explicit Pushed(Withheld withheld) : withheld_(withheld) {
    effects_ = {{.name = "push", .mean = 1, .sd = 0.5, .maximum = 4}};
    for (int k = 1; k <= n_times; ++k) slots_.push_back({.observable = 0, .time = 0.1 * k});
  }

 private:
  static bool is_changed(const RunRequest& request) { return request.point >= n_training && number_of(request.effects, "push") > 0.5; }
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    std::vector<double> path;
    for (const Slot& slot : slots_)
      path.push_back(withheld_ == Withheld::leave_early && is_changed(request) && slot.time > 0.55
                         ? std::numeric_limits<double>::quiet_NaN()
                         : slot.time + number_of(request.effects, "push") * slot.time * slot.time);
    return path;
  }
  std::string failure(const RunRequest& request) const override {
    return withheld_ == Withheld::fail && is_changed(request) && request.point == n_points - 1 ? "no room" : "";
  }
  Withheld withheld_;
};

Verdict verdict_of(Withheld withheld) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = "", .numerics_u = 0}};
  NormalNumbers random(4);
  for (int p = 0; p < n_points; ++p) {
    experiment.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}, .withheld = p >= n_training});
    for (int k = 1; k <= n_times; ++k)
      experiment.data.push_back({.point = p, .time = 0.1 * k, .value = 0.1 * k + 0.01 * k * k + noise * random()});
  }
  Pushed simulator(withheld);
  return diagnose(experiment, simulator);
}

bool has_note(const Verdict& verdict, const std::string& part) {
  return std::any_of(verdict.notes.begin(), verdict.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

/// Requirement: only rows that both runs answer are compared, and their number is said; where a run fails, no shrinkage is.
TEST(Shrinkage, OfRowsThatBothRunsAnswer) {
  const Verdict all = verdict_of(Withheld::answer), some = verdict_of(Withheld::leave_early), failed = verdict_of(Withheld::fail);
  for (const Verdict* verdict : {&all, &some, &failed}) EXPECT_EQ(verdict->effects, std::vector<std::string>{"push"});
  ASSERT_TRUE(all.shrinkage.contains("push"));
  EXPECT_FALSE(has_note(all, "The shrinkage at the withheld points"));
  ASSERT_TRUE(some.shrinkage.contains("push"));
  EXPECT_TRUE(has_note(some, "is that of 15 of 30 rows: the runs with push have no number for the others"));
  EXPECT_LT(some.gap.before, all.gap.before);
  EXPECT_FALSE(failed.shrinkage.contains("push"));
  EXPECT_FALSE(failed.gap.computable);
  EXPECT_TRUE(has_note(failed, "is not known: with push the run fails at point F: no room"));
}

}  // namespace
}  // namespace snag
