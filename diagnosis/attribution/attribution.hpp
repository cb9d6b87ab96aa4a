#pragma once
// Which effects: screening, re-simulation of what is left, further effects in rounds, remainders, evidence, probabilities, and the
// cross-check by points left out.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/attribution/discrepancy.hpp"
#include "diagnosis/attribution/remainder.hpp"
#include "diagnosis/attribution/screening.hpp"
#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// A hypothesis without a fit of its own: what promised too little in a screening, and pairs of it.
struct NotFitted {
  double log_evidence = 0, log_prior = 0;
};

/// A fitted set with one more effect. The screening estimated the gain of this effect, and it was too small for a fit. The larger set
/// keeps its share of the prior, as single effects and pairs do: data that cannot show an effect do not say whether it acts.
struct OneMore {
  int fit = 0;  // of the set
  std::string name;
  double gain = 0;  // log evidence of the screening over that of the set
  double log_prior = 0;
};

/// A wrong input that has the signature of an effect and so is no hypothesis of its own.
struct SameInput {
  int input = -1;
  double sds = 0;  // of its prior, that do what one of the effect's prior does
};

struct Attribution {
  std::vector<Fit> fits;                 // none first
  std::vector<std::string> names;        // of the fits
  std::vector<double> weight;            // of each fit for the verdict: log evidence + log prior, second effects at the price of the rule
  std::vector<double> log_prior;         // of each fit
  std::vector<double> evidence_penalty;  // nats of each fit's evidence that a guard takes away
  std::map<std::string, NotFitted> not_fitted{};
  std::vector<OneMore> one_more{};    // of sets of two and more
  std::vector<Remainder> remainder;   // beside each fit; its gain is in the weight
  std::vector<double> leave_one_out;  // log predictive density of each fit
  Discrepancy discrepancy;
  std::map<std::string, double> screening{}, weak_form{};  // gains over none
  std::map<std::string, double> probability{};
  Identifiability identifiability;
  double placebo_rate = 0;
  std::vector<std::string> notes{};
  std::map<std::string, LocalCause> local{};            // by name of the effect
  std::map<int, int> other_name_of{};                   // effect -> the one of the verdict that is the same cause (same_cause.hpp)
  std::map<int, std::vector<SameInput>> same_inputs{};  // by effect

  /// The effects of a fit, each by its name in the verdict, in order, once.
  std::vector<int> causes_of(int fit) const;

  int first() const;  // the likeliest fit
  /// The likeliest fit by what its effects explain, its remainder aside; of those that do not hold effect `without`.
  int first_by_effects(int without = -1) const;
  int best_with_effect() const;  // the likeliest fit that names an effect; 0 if there is none
  /// The likeliest fit of all effects of this one but one, or but effect `without` (an index of Simulator::effects); -1 if there is none.
  int best_part_of(int fit, int without = -1) const;
  /// Fits of causes that could stand in the place of this one's: less than `nats_of_rule` behind it by weight, and neither part of it nor
  /// larger sets with all of it, which say nothing else of its effects.
  std::vector<int> alternatives_to(int fit) const;
  /// Nats by which outside is likelier than the likeliest fit, by evidence and prior. What a further effect is priced at is a rule among
  /// sets of effects: a process has shapes of its own, which its evidence pays for.
  double outside_leads_by() const;
  /// Evidence of a fit with the choice of a remainder, without what a guard takes away.
  double log_evidence(int fit) const;
};

/// Nats that outside, a mistake, or an effect beyond the first has to bring more than the simpler account of the data, to be said. They can
/// take up what the form of a law leaves, so that chance alone makes some nats.
inline constexpr double nats_of_rule = 6;
/// Share of the prior for a cause that nobody listed.
inline constexpr double prior_outside = 0.1;

/// Candidates of the experiment that this base case can show, by index; why the others cannot goes to `blind`.
std::vector<int> live_candidates(const Responses& model, std::map<std::string, std::string>& blind);

Attribution attribute(Responses& model, Fitter& fitter, const std::function<void(const std::string&, double)>& progress);

/// Probabilities of all hypotheses from evidence and prior.
void set_probabilities(Attribution& attribution);

/// Probability that all of these effects act, each under its own name or one of these that mean the same; `alone`: and no other.
double probability_of(const Attribution& attribution, const std::vector<std::string>& effects,
                      const std::map<std::string, std::vector<std::string>>& same_as = {}, bool alone = false);

/// Log predictive density of each training point given the others, summed.
double leave_one_out(const Fit& fit);

}  // namespace snag
