#include "diagnosis/attribution/attribution.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/attribution/attributor.hpp"

namespace snag {

Attribution Attributor::attribute() {
  std::vector<int> live = live_candidates(model_, result_.identifiability.blind);
  n_mistakes_ = static_cast<int>(std::count_if(live.begin(), live.end(), [&](int k) { return model_.effects()[k].is_mistake; }));
  n_singles_ = std::max<int>(1, static_cast<int>(live.size()) - n_mistakes_);
  for (const int k : live) (model_.effects()[k].random ? random_ : candidates_).push_back(k);
  report("signatures", 0.05);
  const Screening screening(model_, fitter_, candidates_, fitter_.base());
  // What does not run cannot be judged.
  const auto fails = [&](int k) {
    const std::string failure = model_.effects()[k].random ? "" : screening.failure(k);
    if (!failure.empty()) result_.identifiability.blind[model_.effects()[k].name] = "its runs fail: " + failure;
    return !failure.empty();
  };
  std::erase_if(live, fails), std::erase_if(candidates_, fails);
  identify(screening);
  std::vector<int> other_names;
  for (const int k : candidates_)
    if (is_effect_by_another_name(screening, k)) other_names.push_back(k);
  find_same_inputs(screening, other_names);
  for (const int k : other_names) forget(model_.effects()[k].name);
  const auto is_other_name = [&](int k) { return std::count(other_names.begin(), other_names.end(), k) > 0; };
  std::erase_if(live, is_other_name), std::erase_if(candidates_, is_other_name);
  // What the data do not show is the base model under another name: friction of what touches nothing is no hypothesis.
  const auto is_not_shown = [&](int k) {
    return !model_.effects()[k].random && (!screening.changes_runs(k) || screening.detectability(k) < least_shown);
  };
  std::erase_if(live, is_not_shown), std::erase_if(candidates_, is_not_shown);
  result_.placebo_rate = screening.placebo_rate(model_.experiment().seed);
  const std::vector<Screened> singles = screened_singles(screening);
  report("fits", 0.15);
  add(fitter_.fit({}, Eigen::VectorXd()));
  fit_singles(singles);
  credit_other_singles(live);
  fit_random_effects();
  if (model_.experiment().pairs) fit_pairs(screening);
  fit_rivals_of_leader();
  fit_local_causes();
  if (model_.experiment().pairs) fit_in_rounds(), fit_without_weak_members();
  refine_random_leader();
  if (model_.experiment().pairs) credit_other_pairs(live);
  result_.discrepancy = fit_discrepancy(model_, fitter_, result_.fits.front());
  for (const Fit& fit : result_.fits) result_.leave_one_out.push_back(leave_one_out(fit));
  set_probabilities(result_);
  return std::move(result_);
}

Attribution attribute(Responses& model, Fitter& fitter, const std::function<void(const std::string&, double)>& progress) {
  return Attributor(model, fitter, progress).attribute();
}

}  // namespace snag
