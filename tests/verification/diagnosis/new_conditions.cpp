// labels: long
// timeout: 300
// cost: 20
// Requirement: where the data do not decide, a condition is proposed at which one test tells the two likeliest hypotheses apart by at least
// twice the nats of a repeat, in 8 of 10 ties; none is proposed for effects that are one at every condition.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/verification/diagnosis/formula.hpp"

using namespace snag;
using formula::judged;

TEST(NewConditions, TellMoreThanRepeats) {
  int ties = 0, proposed = 0;
  for (int i = 0; ties < 10 && i < 800; ++i) {
    const double coarse = std::array{2e-3, 3e-3, 4e-3}[static_cast<std::size_t>(i % 3)];  // m
    const std::pair<const std::string, double> weak[] = {
        {"added_mass", 0.3}, {"pressure_gradient", 0.4}, {"lift", 0.5}, {"operating_point", 0.1}};
    const Verdict verdict = judged(formula::experiment({.effects = {weak[i / 3 % 4]}}, 2, 0, 1, coarse, 8700 + i));
    if (verdict.verdict != VerdictKind::tie) {
      EXPECT_TRUE(verdict.identifiability.new_conditions.empty());
      continue;
    }
    ++ties;
    const auto& conditions = verdict.identifiability.new_conditions;
    proposed += !conditions.empty();
    double before = infinity;
    for (const NewCondition& c : conditions) {
      EXPECT_GE(c.nats, 2 * c.nats_of_repeat);
      EXPECT_LE(c.nats, before);
      before = c.nats;
    }
    std::printf("%s or %s: ", verdict.tie.front().c_str(), verdict.tie.size() > 1 ? verdict.tie[1].c_str() : "");
    if (!conditions.empty())
      std::printf("%s of %s times %g, %.2g nats, of a repeat %.2g", conditions[0].input.c_str(), conditions[0].point.c_str(),
                  conditions[0].factor, conditions[0].nats, conditions[0].nats_of_repeat);
    std::printf("\n");
  }
  std::printf("%d of %d ties with a condition that tells more\n", proposed, ties);
  EXPECT_EQ(ties, 10);
  EXPECT_GE(proposed, 8);
}

/// Requirement: conditions are ranked by nats over cost; one that costs more than half of what its nats are worth in repeats is not
/// proposed.
TEST(NewConditions, AreRankedByNatsOverCost) {
  Experiment experiment;
  const auto proposed = [&] { return judged(experiment).identifiability.new_conditions; };
  std::vector<NewCondition> cheap;
  for (int i = 0; cheap.empty() && i < 20; ++i) {
    experiment = formula::experiment({.effects = {{"added_mass", 0.3}}}, 2, 0, 1, 3e-3, 8900 + i);
    cheap = proposed();
  }
  ASSERT_FALSE(cheap.empty());
  const NewCondition& best = cheap[0];
  const double worth = best.nats / (2 * best.nats_of_repeat);  // repeats at which it is just proposed
  experiment.costs = {{best.input, 0.99 * worth}};
  const auto dear = proposed();
  double before = infinity;
  bool is_there = dear.size() == 3;  // so many are named, and it may be the fourth
  for (const NewCondition& c : dear) {
    EXPECT_LE(c.nats / c.cost, before);
    before = c.nats / c.cost;
    if (c.point != best.point || c.input != best.input || c.factor != best.factor) continue;
    is_there = true;
    EXPECT_DOUBLE_EQ(c.nats, best.nats);
    EXPECT_DOUBLE_EQ(c.cost, 0.99 * worth);
  }
  EXPECT_TRUE(is_there);
  experiment.costs[0].second = 1.01 * worth;
  for (const NewCondition& c : proposed()) EXPECT_NE(c.input, best.input);
  experiment.costs = {{"no.such_input", 2}};
  EXPECT_THROW(judged(experiment), Error);
}

/// A sphere whose runs were all made before.
class Resumed final : public Simulator {
 public:
  explicit Resumed(const Experiment& experiment) : sphere_(experiment) {}
  const std::vector<Effect>& effects() const override { return sphere_.effects(); }
  const std::vector<Nuisance>& nuisances() const override { return sphere_.nuisances(); }
  const std::vector<Slot>& slots(int point) const override { return sphere_.slots(point); }
  bool restarts(int point) const override { return sphere_.restarts(point); }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override { return sphere_.run(requests); }
  int n_runs() const override { return 0; }
  int n_used() const override { return sphere_.n_runs(); }

 private:
  formula::Sphere sphere_;
};

/// Requirement: a diagnosis that is repeated from its kept runs proposes the same conditions.
TEST(NewConditions, AreThoseOfTheFirstTimeWhenResumed) {
  std::size_t n = 0;
  for (int i = 0; n == 0 && i < 20; ++i) {
    const Experiment experiment = formula::experiment({.effects = {{"added_mass", 0.3}}}, 2, 0, 1, 3e-3, 8900 + i);
    n = judged(experiment).identifiability.new_conditions.size();
    Resumed resumed(experiment);
    EXPECT_EQ(diagnose(experiment, resumed).identifiability.new_conditions.size(), n);
  }
  EXPECT_GT(n, 0u);
}

TEST(NewConditions, NoneForTwins) {
  const Experiment experiment = formula::experiment({.effects = {{"added_mass", 0.5}}}, 6, 0, 3, 5e-4, 8800);
  formula::Sphere sphere(experiment, false, true);
  const Verdict verdict = diagnose(experiment, sphere);
  EXPECT_FALSE(verdict.same_as.empty());
  EXPECT_TRUE(verdict.identifiability.new_conditions.empty());
}
