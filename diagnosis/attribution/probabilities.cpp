// Which hypothesis leads, and the probabilities of all from evidence and prior:
//
//   P(h) = Z_h prior_h / sum over all hypotheses, those that were not fitted and outside among them
//
// Z: evidence with the choice of a remainder, less what a guard takes away. Evidence counts in full (Bayes), with no exponent that is
// fitted to sets whose truth is known: what the models leave is in the hypotheses themselves (errors of form, remainder, outside).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/words.hpp"
#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

int Attribution::first() const { return static_cast<int>(std::max_element(weight.begin(), weight.end()) - weight.begin()); }

int Attribution::first_by_effects(int without) const {
  int best = 0;
  const auto by_effects = [&](int i) { return weight[static_cast<std::size_t>(i)] - remainder[static_cast<std::size_t>(i)].gain; };
  for (int i = 1; i < static_cast<int>(weight.size()); ++i) {
    const auto& effects = fits[static_cast<std::size_t>(i)].hypothesis.effects;
    if (std::count(effects.begin(), effects.end(), without) == 0 && by_effects(i) > by_effects(best)) best = i;
  }
  return best;
}

int Attribution::best_with_effect() const {
  int best = 0;
  for (int i = 1; i < static_cast<int>(weight.size()); ++i)
    if (best == 0 || weight[i] > weight[best]) best = i;
  return best;
}

int Attribution::best_part_of(int fit, int without) const {
  const auto& all = fits[static_cast<std::size_t>(fit)].hypothesis.effects;
  int best = -1;
  for (int j = 0; j < static_cast<int>(fits.size()); ++j) {
    const auto& part = fits[static_cast<std::size_t>(j)].hypothesis.effects;
    const auto is_there = [&](int k) { return k != without && std::count(all.begin(), all.end(), k) > 0; };
    if (part.size() + 1 != all.size() || !std::all_of(part.begin(), part.end(), is_there)) continue;
    if (best < 0 || weight[static_cast<std::size_t>(j)] > weight[static_cast<std::size_t>(best)]) best = j;
  }
  return best;
}

std::vector<int> Attribution::causes_of(int fit) const {
  std::vector<int> causes;
  for (const int k : fits[static_cast<std::size_t>(fit)].hypothesis.effects) {
    const auto other = other_name_of.find(k);
    causes.push_back(other == other_name_of.end() ? k : other->second);
  }
  std::sort(causes.begin(), causes.end());
  causes.erase(std::unique(causes.begin(), causes.end()), causes.end());
  return causes;
}

std::vector<int> Attribution::alternatives_to(int fit) const {
  const auto holds = [](const std::vector<int>& all, const std::vector<int>& part) {
    return std::includes(all.begin(), all.end(), part.begin(), part.end());
  };
  const std::vector<int> own = causes_of(fit);
  std::vector<int> alternatives;
  for (int j = 0; j < static_cast<int>(fits.size()); ++j) {
    const std::vector<int> other = causes_of(j);
    const double behind = weight[static_cast<std::size_t>(fit)] - weight[static_cast<std::size_t>(j)];
    if (behind < nats_of_rule && !holds(other, own) && !holds(own, other)) alternatives.push_back(j);
  }
  return alternatives;
}

double Attribution::outside_leads_by() const {
  double likeliest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fits.size(); ++i) likeliest = std::max(likeliest, log_prior[i] + log_evidence(static_cast<int>(i)));
  return std::log(prior_outside) + discrepancy.log_evidence - likeliest;
}

double Attribution::log_evidence(int fit) const {
  const auto i = static_cast<std::size_t>(fit);
  return fits[i].log_evidence + remainder[i].gain - evidence_penalty[i];
}

namespace {

/// Those that were screened only, each beside the fitted set that speaks most for it.
std::map<std::string, NotFitted> larger_sets(const Attribution& attribution) {
  std::map<std::string, NotFitted> larger;
  for (const OneMore& one : attribution.one_more) {
    const auto& names = attribution.names;
    if (std::count(names.begin(), names.end(), one.name) > 0 || attribution.not_fitted.contains(one.name)) continue;
    const NotFitted beside{attribution.log_evidence(one.fit) + one.gain, one.log_prior};
    NotFitted& kept = larger.emplace(one.name, beside).first->second;
    kept.log_evidence = std::max(kept.log_evidence, beside.log_evidence);
  }
  return larger;
}

}  // namespace

void set_probabilities(Attribution& attribution) {
  std::vector<std::pair<std::string, double>> weights;
  const auto add = [&](const std::string& name, double log_evidence, double log_prior) {
    weights.emplace_back(name, log_evidence - attribution.fits.front().log_evidence + log_prior);
  };
  for (std::size_t i = 0; i < attribution.names.size(); ++i)
    add(attribution.names[i], attribution.log_evidence(static_cast<int>(i)), attribution.log_prior[i]);
  for (const auto& [name, other] : attribution.not_fitted) add(name, other.log_evidence, other.log_prior);
  for (const auto& [name, other] : larger_sets(attribution)) add(name, other.log_evidence, other.log_prior);
  add("outside", attribution.discrepancy.log_evidence, std::log(prior_outside));
  std::vector<double> logarithms;
  for (const auto& [name, weight] : weights) logarithms.push_back(weight);
  const double total = log_sum_exp(logarithms);
  attribution.probability.clear();
  for (const auto& [name, weight] : weights) attribution.probability[name] = std::exp(weight - total);
}

double probability_of(const Attribution& attribution, const std::vector<std::string>& effects,
                      const std::map<std::string, std::vector<std::string>>& same_as, bool alone) {
  double sum = 0;
  for (const auto& [name, p] : attribution.probability) {
    const std::vector<std::string> acting = split(name, '+');
    if (alone && acting.size() != effects.size()) continue;
    const auto is_there = [&](const std::string& effect) { return std::count(acting.begin(), acting.end(), effect) > 0; };
    const auto acts = [&](const std::string& effect) {
      const auto others = same_as.find(effect);
      return is_there(effect) || (others != same_as.end() && std::any_of(others->second.begin(), others->second.end(), is_there));
    };
    if (std::all_of(effects.begin(), effects.end(), acts)) sum += p;
  }
  return sum;
}

}  // namespace snag
