// Requirement: the guards of a verdict do what docs/theory.md says of them, each on a verdict or a fit that is made for it.
#include "diagnosis/judgement/decision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/verification/diagnosis/formula.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

/// Names lift, with what the withheld points say of it.
Verdict named_lift(double shrunk) {
  Verdict verdict;
  verdict.verdict = VerdictKind::effects, verdict.wording = Wording::attributed;
  verdict.effects = {"lift"}, verdict.causes = {{.effect = "lift", .share = 0.9}}, verdict.unexplained = 0.1;
  verdict.shrinkage["lift"] = {shrunk, shrunk - 0.1, shrunk + 0.1};
  return verdict;
}

TEST(Decision, WhatShrinksNothingIsWithdrawn) {
  for (const double shrunk : {0.0, -0.3}) {
    Verdict verdict = named_lift(shrunk);
    withdraw_what_shrinks_nothing(verdict);
    EXPECT_EQ(verdict.verdict, VerdictKind::tie);
    EXPECT_EQ(verdict.wording, Wording::undecided);
    EXPECT_EQ(verdict.tie, (std::vector<std::string>{"lift", "outside"}));
    EXPECT_TRUE(verdict.causes.empty());
    EXPECT_TRUE(std::isnan(verdict.unexplained));
    ASSERT_EQ(verdict.notes.size(), 1);
    EXPECT_EQ(verdict.notes[0], "The evidence is for lift, but the gap at the withheld points does not shrink by it: it is not named.");
  }
}

TEST(Decision, WhatShrinksOrCannotBeMeasuredStays) {
  Verdict without = named_lift(1);
  without.shrinkage.clear();
  Verdict outside = named_lift(-1);
  outside.verdict = VerdictKind::outside;
  for (Verdict verdict : {named_lift(0.01), named_lift(0.9), named_lift(std::numeric_limits<double>::quiet_NaN()), without, outside}) {
    const VerdictKind before = verdict.verdict;
    withdraw_what_shrinks_nothing(verdict);
    EXPECT_EQ(verdict.verdict, before);
    EXPECT_TRUE(verdict.notes.empty());
    EXPECT_EQ(verdict.causes.size(), 1);
  }
}

/// Times of the measurement are written down `late` s too early.
Experiment experiment_of(const formula::Theta& effects, double late = 0) {
  Experiment experiment = formula::experiment({.effects = effects}, 4, 0, 3, 5e-4, 71);
  std::erase_if(experiment.data, [&](const Datum& d) { return d.time < late; });
  for (Datum& d : experiment.data) d.time -= late;
  return experiment;
}

/// The attribution, changed before it is judged.
template <class Change>
Verdict judged_after(const Change& change, const Experiment& experiment, Simulator& simulator) {
  Responses model(experiment, simulator);
  Fitter fitter(model);
  Attribution attribution = attribute(model, fitter, {});
  change(attribution);
  Verdict verdict;
  judge(model, attribution, verdict);
  return verdict;
}

/// Of data of spheres, by default those of lift alone.
template <class Change>
Verdict judged_after(const Change& change, const Experiment& experiment = experiment_of({{"lift", 1}})) {
  formula::Sphere sphere(experiment);
  return judged_after(change, experiment, sphere);
}

bool has_note(const Verdict& verdict, const std::string& begin, const std::string& end = "") {
  return std::any_of(verdict.notes.begin(), verdict.notes.end(),
                     [&](const std::string& note) { return note.starts_with(begin) && note.ends_with(end); });
}

TEST(Decision, EffectLessThanTwoDeviationsClearIsRefused) {
  for (const double clear : {1.9, 2.1}) {
    // A strength alone that is hardly known, whatever the evidence: forms and random runs can make that.
    const Verdict verdict = judged_after([&](Attribution& a) {
      for (std::size_t i = 0; i < a.fits.size(); ++i) {
        Fit& fit = a.fits[i];
        if (fit.hypothesis.effects.size() > 1) a.weight[i] -= 1e3, a.evidence_penalty[i] = 1e3;
        for (Eigen::Index e = 0; e < fit.theta.size(); ++e) fit.theta_sd[e] = std::abs(fit.theta[e]) / clear;
      }
    });
    EXPECT_EQ(verdict.verdict == VerdictKind::effects, clear > 2) << clear;
    EXPECT_EQ(has_note(verdict, "A strength of lift is less than 2 standard deviations clear of nothing"), clear < 2) << clear;
  }
}

TEST(Decision, StrengthAtTheEndOfItsRangeIsNoted) {
  constexpr double most = 4;  // of lift in formula.hpp
  for (const double away : {0.3, 0.7}) {
    const Verdict verdict = judged_after([&](Attribution& a) {
      for (Fit& fit : a.fits)
        if (fit.theta.size() == 1) fit.theta[0] = most - away * fit.theta_sd[0];
    });
    ASSERT_EQ(verdict.effects, std::vector<std::string>{"lift"}) << away;
    EXPECT_EQ(has_note(verdict, "The strength of lift", ", is at the end of its range, 4: what lies beyond was not tried."), away < 0.5)
        << away;
  }
}

/// A law in the place of another, of which the data have the whole.
class InPlaceOfAnother final : public TestSimulator {
 public:
  explicit InPlaceOfAnother(bool is_share) {
    effects_ = {{.name = "sheet", .mean = 0.8, .sd = 0.4, .maximum = 1, .is_share = is_share}};
    for (int i = 1; i <= 20; ++i) slots_.push_back({0, 0.05 * i});
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    std::vector<double> path;
    for (const Slot& slot : slots_) path.push_back(number_of(request.effects, "sheet") * slot.time);
    return path;
  }
};

TEST(Decision, TheWholeOfALawIsNoEndOfItsRange) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = 0.01, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  NormalNumbers random(7);
  for (int i = 1; i <= 20; ++i) experiment.data.push_back({.time = 0.05 * i, .value = 0.05 * i + 0.01 * random()});
  for (const bool is_share : {false, true}) {
    InPlaceOfAnother simulator(is_share);
    const Verdict verdict = judged_after([](Attribution&) {}, experiment, simulator);
    ASSERT_EQ(verdict.effects, std::vector<std::string>{"sheet"}) << is_share;
    EXPECT_EQ(has_note(verdict, "The strength of sheet", "is at the end of its range, 1: what lies beyond was not tried."), !is_share);
  }
}

TEST(Decision, TieWithOutsideSaysThatAPairIsLikelier) {
  for (const double of_pair : {-9.0, 9.0}) {
    const Verdict verdict = judged_after([&](Attribution& a) {
      const double own = a.log_evidence(a.first());
      a.discrepancy.log_evidence = own + 3;  // less than the rule
      a.not_fitted["lift+unheard"] = {own + of_pair, 0};
    });
    EXPECT_EQ(verdict.verdict, VerdictKind::tie);
    EXPECT_EQ(verdict.tie, (std::vector<std::string>{"lift", "outside"}));
    EXPECT_EQ(has_note(verdict, "Likelier than lift alone"), of_pair > 0) << of_pair;
  }
}

/// A fit that is not the leading one.
std::size_t place_of(const Attribution& a, const std::string& name) {
  const auto found = std::find(a.names.begin(), a.names.end(), name);
  if (found == a.names.end()) throw std::runtime_error(name + " was not fitted");
  return static_cast<std::size_t>(found - a.names.begin());
}

/// One effect that does not live on its nuisances, and is clear of nothing.
void make_clear(Fit& fit) {
  fit.solution.d = fit.linear.prior;
  fit.theta[0] = 0.3, fit.theta_sd[0] = 0.01;
}

// The rule puts one cause first, and nearly all of the probability is another's.
TEST(Decision, TieNamesTheLeadingCauseToo) {
  const Verdict verdict = judged_after([&](Attribution& a) {
    const auto first = static_cast<std::size_t>(a.first()), rival = place_of(a, "drag_magnitude");
    std::fill(a.weight.begin(), a.weight.end(), -20.0);
    a.weight[first] = 0, a.weight[rival] = -8;
    make_clear(a.fits[rival]);
    a.fits[rival].log_evidence += a.log_evidence(static_cast<int>(first)) + 30 - a.log_evidence(static_cast<int>(rival));
  });
  EXPECT_GT(verdict.probability.at("drag_magnitude"), 0.9);
  EXPECT_EQ(verdict.verdict, VerdictKind::tie);
  EXPECT_EQ(verdict.tie, (std::vector<std::string>{"drag_magnitude", "lift"}));
}

TEST(Decision, BetterPredictorMakesATieOrADoubt) {
  for (const double ahead : {1.0, 3.0})       // among left-out points
    for (const double behind : {5.0, 7.0}) {  // by evidence
      const Verdict verdict = judged_after([&](Attribution& a) {
        const auto first = static_cast<std::size_t>(a.first()), rival = place_of(a, "drag_magnitude");
        for (std::size_t i = 0; i < a.fits.size(); ++i)
          if (i != first) a.weight[i] = a.weight[first] - 20, a.leave_one_out[i] = a.leave_one_out[first] - 20;
        a.weight[rival] = a.weight[first] - behind, a.leave_one_out[rival] = a.leave_one_out[first] + ahead;
        make_clear(a.fits[rival]);
      });
      const bool predicts_better = ahead > 2, is_close = behind < 6;
      const Wording wording = predicts_better || is_close ? Wording::suspected : Wording::attributed;
      const bool is_tie = predicts_better && is_close;
      EXPECT_EQ(verdict.verdict, is_tie ? VerdictKind::tie : VerdictKind::effects) << ahead << " " << behind;
      EXPECT_EQ(verdict.wording, is_tie ? Wording::undecided : wording) << ahead << " " << behind;
      EXPECT_EQ(has_note(verdict, "The evidence is for lift, but drag_magnitude predicts"), predicts_better) << ahead << " " << behind;
    }
}

// Two effects with a probability above 0.75, the second of which brings less than the 6 nats of the rule.
TEST(Decision, LikelyEffectIsSuspectedBesideAnEffectAndNotBesideAMistake) {
  const auto leads_and_pair_is_likely = [](const std::string& leader, const std::string& pair) {
    return [leader, pair](Attribution& a) {
      const std::size_t first = place_of(a, leader), both = place_of(a, pair);
      std::fill(a.weight.begin(), a.weight.end(), -20.0);
      a.weight[first] = 0, a.weight[both] = -1;
      const double of_first = a.log_evidence(static_cast<int>(first)), of_both = a.log_evidence(static_cast<int>(both));
      a.fits[both].log_evidence += of_first + 8 - of_both;
    };
  };
  const Verdict effects =
      judged_after(leads_and_pair_is_likely("added_mass", "added_mass+lift"), experiment_of({{"lift", 1}, {"added_mass", 0.5}}));
  EXPECT_GT(effects.probability.at("added_mass+lift"), 0.75);
  EXPECT_EQ(formula::said(effects), "added_mass+lift");
  EXPECT_EQ(effects.wording, Wording::suspected);
  const Verdict mistake = judged_after(leads_and_pair_is_likely("clock", "clock+lift"), experiment_of({{"lift", 1}}, 0.04));
  EXPECT_GT(mistake.probability.at("clock+lift"), 0.75);
  EXPECT_EQ(formula::said(mistake), "clock");
}

TEST(Decision, CheckThatFailsIsNotedAndDecidesNothing) {
  const Verdict sound = judged_after([](Attribution&) {});
  const Verdict failing = judged_after([](Attribution& a) { a.fits[static_cast<std::size_t>(a.first())].residual[3] += 9; });
  EXPECT_EQ(sound.verdict, VerdictKind::effects);
  EXPECT_EQ(failing.verdict, VerdictKind::effects);
  EXPECT_EQ(failing.effects, sound.effects);
  EXPECT_EQ(failing.wording, sound.wording);
  EXPECT_EQ(failing.probability, sound.probability);
  EXPECT_FALSE(has_note(sound, "Data like these are not expected under lift"));
  EXPECT_TRUE(has_note(failing, "Data like these are not expected under lift"));
}

}  // namespace
}  // namespace snag
