// From evidence and prior to the probabilities that are printed.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/attribution/attribution.hpp"

namespace snag {
namespace {

constexpr double prior_none = 0.6, prior_effect = 0.15, prior_discrepancy = 0.1;

/// None, two effects and their pair, each with this evidence.
Attribution with_evidence(double none, double a, double b, double both, double discrepancy) {
  Attribution attribution;
  const auto add = [&](const char* name, double log_evidence, double prior) {
    Fit fit;
    fit.log_evidence = log_evidence;
    attribution.fits.push_back(fit), attribution.names.emplace_back(name);
    attribution.log_prior.push_back(std::log(prior)), attribution.evidence_penalty.push_back(0);
    attribution.remainder.emplace_back();
  };
  add("none", none, prior_none), add("a", a, prior_effect), add("b", b, prior_effect);
  add("a+b", both, prior_effect * prior_effect / prior_none);
  attribution.discrepancy.log_evidence = discrepancy;
  return attribution;
}

/// Requirement: data that say nothing leave the prior as it is; so do those that cannot show an effect.
TEST(Probabilities, ArePriorsWhereDataSayNothing) {
  Attribution attribution = with_evidence(-7, -7, -7, -7, -7);
  attribution.not_fitted["unseen"] = {-7, std::log(prior_effect)};
  set_probabilities(attribution);
  const double total = prior_none + 3 * prior_effect + prior_effect * prior_effect / prior_none + prior_discrepancy;
  EXPECT_NEAR(attribution.probability.at("none"), prior_none / total, 1e-12);
  EXPECT_NEAR(attribution.probability.at("unseen"), prior_effect / total, 1e-12);
  EXPECT_NEAR(attribution.probability.at("a+b"), prior_effect * prior_effect / prior_none / total, 1e-12);
  EXPECT_NEAR(attribution.probability.at("outside"), prior_discrepancy / total, 1e-12);
}

/// Requirement: evidence counts in full, and what a guard takes from a fit does not count.
TEST(Probabilities, WeighEvidence) {
  Attribution attribution = with_evidence(0, 10, 2, 14, -50);
  set_probabilities(attribution);
  const auto ratio = [&](const char* x, const char* y) { return attribution.probability.at(x) / attribution.probability.at(y); };
  EXPECT_NEAR(std::log(ratio("a", "b")), 8.0, 1e-9);
  EXPECT_NEAR(std::log(ratio("a+b", "a")), 4.0 + std::log(prior_effect / prior_none), 1e-9);
  attribution.evidence_penalty.back() = 4;
  set_probabilities(attribution);
  EXPECT_NEAR(std::log(ratio("a+b", "a")), std::log(prior_effect / prior_none), 1e-9);
}

/// Requirement: a set of effects is no surer than the data make it that nothing else acts: an effect more that they cannot show keeps its
/// share of the prior, as it does beside one effect.
TEST(Probabilities, OneMoreKeepsItsPrior) {
  Attribution attribution = with_evidence(0, 50, 40, 100, -50);
  const double set = prior_effect * prior_effect / prior_none, more = set * prior_effect / prior_none;
  attribution.one_more = {{3, "a+b+c", 0, std::log(more)}, {3, "a+b+d", -4, std::log(more)}, {2, "a+b+c", 0, std::log(more)}};
  set_probabilities(attribution);
  const auto over_set = [&](const char* name) { return attribution.probability.at(name) / attribution.probability.at("a+b"); };
  EXPECT_NEAR(over_set("a+b+c"), more / set, 1e-12);
  EXPECT_NEAR(std::log(over_set("a+b+d")), std::log(more / set) - 4, 1e-9);
  EXPECT_NEAR(probability_of(attribution, {"a", "b"}), 1, 1e-9);
  // What a guard takes from the set it takes from the larger ones, too.
  attribution.evidence_penalty[3] = 20;
  set_probabilities(attribution);
  EXPECT_NEAR(over_set("a+b+c"), more / set, 1e-12);
}

/// Requirement: further effects are looked for beside what explains most by itself, not beside a wrong effect with a large remainder.
TEST(Probabilities, RemainderDoesNotLeadTheSearch) {
  Attribution attribution = with_evidence(0, 10, 90, 100, 0);
  for (const Fit& fit : attribution.fits) attribution.weight.push_back(fit.log_evidence);
  attribution.remainder[1].gain = 200, attribution.weight[1] += 200;
  EXPECT_EQ(attribution.first(), 1);
  EXPECT_EQ(attribution.first_by_effects(), 3);
  attribution.fits[1].hypothesis.effects = {0}, attribution.fits[2].hypothesis.effects = {1},
  attribution.fits[3].hypothesis.effects = {0, 1};
  EXPECT_EQ(attribution.first_by_effects(0), 2);
  EXPECT_EQ(attribution.first_by_effects(1), 1);
}

/// Requirement: a cause less than 6 nats behind stands beside the named one; what holds the named one, or is part of it, says nothing else.
TEST(Probabilities, AlternativesAreLessThanSixNatsBehind) {
  Attribution attribution = with_evidence(0, 10, 4.1, 9, -50);
  for (const Fit& fit : attribution.fits) attribution.weight.push_back(fit.log_evidence);
  attribution.fits[1].hypothesis.effects = {0}, attribution.fits[2].hypothesis.effects = {1},
  attribution.fits[3].hypothesis.effects = {0, 1};
  EXPECT_EQ(attribution.alternatives_to(1), std::vector<int>{2});
  EXPECT_EQ(attribution.alternatives_to(3), std::vector<int>{});
  attribution.weight[2] = 3.9;
  EXPECT_EQ(attribution.alternatives_to(1), std::vector<int>{});
}

/// Requirement: outside is weighed against the likeliest set of effects, by evidence and prior; the price of a further effect is a matter
/// among sets of effects.
TEST(Probabilities, OutsideLeadsOverTheLikeliestSet) {
  Attribution attribution = with_evidence(0, 80, 2, 100, 104);
  attribution.weight = {0, 80, 2, 94};  // a further effect costs 6
  const double prior_pair = prior_effect * prior_effect / prior_none;
  EXPECT_NEAR(attribution.outside_leads_by(), 4 + std::log(prior_discrepancy / prior_pair), 1e-12);
  attribution.remainder[3].gain = 3, attribution.weight[3] += 3;
  EXPECT_NEAR(attribution.outside_leads_by(), 1 + std::log(prior_discrepancy / prior_pair), 1e-12);
  attribution.fits[2].log_evidence = 102;  // one effect is likelier than two of a little more evidence
  EXPECT_NEAR(attribution.outside_leads_by(), 2 + std::log(prior_discrepancy / prior_effect), 1e-12);
  set_probabilities(attribution);
  EXPECT_NEAR(std::log(attribution.probability.at("outside") / attribution.probability.at("b")), attribution.outside_leads_by(), 1e-9);
}

/// Requirement: an effect acts in every hypothesis that holds it; one whose name is part of another's does not.
TEST(Probabilities, ThatAnEffectActs) {
  Attribution attribution;
  attribution.probability = {{"none", 0.1}, {"a", 0.4}, {"a+b", 0.2}, {"ab", 0.25}, {"outside", 0.05}};
  EXPECT_NEAR(probability_of(attribution, {"a"}), 0.6, 1e-12);
  EXPECT_NEAR(probability_of(attribution, {"b"}), 0.2, 1e-12);
  EXPECT_NEAR(probability_of(attribution, {"a", "b"}), 0.2, 1e-12);
  EXPECT_NEAR(probability_of(attribution, {"a"}, {}, true), 0.4, 1e-12);
  EXPECT_NEAR(probability_of(attribution, {"a"}, {{"a", {"ab"}}}, true), 0.65, 1e-12);
}

}  // namespace
}  // namespace snag
