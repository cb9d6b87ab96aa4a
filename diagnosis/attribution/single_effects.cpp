// Attribution: priors, what the data could show, and the fits of single effects.
#include <algorithm>
#include <cmath>

#include "base/words.hpp"
#include "diagnosis/attribution/attributor.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

void Attributor::report(const std::string& stage, double done) const {
  if (progress_) progress_(stage, done);
}

bool Attributor::affordable(int runs_per_point) {
  if (fitter_.runs_left() >= runs_per_point * static_cast<int>(model_.training().size())) return true;
  const std::string note = "The budget of " + std::to_string(model_.experiment().max_runs) +
                           " runs ended before every hypothesis was fitted; raise [budget] max_runs.";
  if (result_.notes.empty() || result_.notes.back() != note) result_.notes.push_back(note);
  return false;
}

int Attributor::runs_of_emulator(int effect) const {
  return static_cast<int>(emulated_strengths(model_.effects()[effect]).size()) *
         model_.n_seeds({{{effect, 1}}, fitter_.base().state.nuisances});
}

bool Attributor::by_emulator(const Hypothesis& hypothesis) const {
  return model_.base_is_random() && hypothesis.effects.size() == 1 && !model_.effects()[hypothesis.effects[0]].fixed &&
         model_.changes_runs(hypothesis.effects[0]);
}

int Attributor::runs_of(const Screened& screened) const {
  const auto& effects = screened.hypothesis.effects;
  return by_emulator(screened.hypothesis) ? runs_of_emulator(effects[0]) : fitter_.runs_of_fit(static_cast<int>(effects.size()));
}

Fit Attributor::fit_of(const Screened& screened) {
  return by_emulator(screened.hypothesis) ? emulated(screened.hypothesis.effects[0])
                                          : fitter_.fit(screened.hypothesis, start(screened), screened.forms);
}

Fit Attributor::emulated(int effect, const Refinement& refinement) {
  return fit_by_emulator(model_, fitter_, effect, emulated_strengths(model_.effects()[effect]), refinement);
}

void Attributor::fit_random_effects() {
  constexpr double far_behind = 20;  // nats
  double best = -std::numeric_limits<double>::infinity();
  for (const Fit& fit : result_.fits) best = std::max(best, fit.log_evidence);
  for (const int k : random_) {
    if (!affordable(runs_of_emulator(k))) break;
    report("fit of " + model_.effects()[k].name, 0.55);
    Fit look = fit_by_emulator(model_, fitter_, k, first_strengths(model_.effects()[k]));
    add(look.log_evidence < best - far_behind ? std::move(look) : emulated(k));
  }
}

double Attributor::prior_of(int k) const {
  if (model_.effects()[k].is_local) return share_local * prior_effects / n_singles_;
  return model_.effects()[k].is_mistake ? prior_mistakes / n_mistakes_ : prior_effects / n_singles_;
}

double Attributor::log_prior(const Hypothesis& hypothesis) const {
  double sum = std::log(prior_none);
  for (const int k : hypothesis.effects) sum += std::log(prior_of(k) / prior_none);
  return sum;
}

double Attributor::log_prior_of_verdict(const Hypothesis& hypothesis) const {
  if (hypothesis.effects.empty()) return std::log(prior_none);
  double best = 0;
  int n_priced = static_cast<int>(hypothesis.effects.size()) - 1;
  for (const int k : hypothesis.effects)
    best = std::max(best, prior_of(k)), n_priced += model_.effects()[k].is_mistake || model_.effects()[k].is_local;
  return std::log(best) - n_priced * nats_of_rule;
}

double Attributor::screened_share_of_places(const Hypothesis& hypothesis) const {
  if (hypothesis.effects.size() < 2) return 0;
  double sum = 0;
  for (const int k : hypothesis.effects)
    if (const auto found = places_.find(k); found != places_.end()) sum += found->second.log_share;
  return sum;
}

double Attributor::fitted_share_of_places(const Fit& fit) {
  const std::vector<int>& effects = fit.hypothesis.effects;
  const auto local = std::find_if(effects.begin(), effects.end(), [&](int k) { return places_.contains(k); });
  if (effects.size() < 2 || local == effects.end()) return 0;
  if (!affordable(runs_of_places())) return screened_share_of_places(fit.hypothesis);
  return log_share_beside_others(model_, fitter_, fit, *local, places_.at(*local));
}

void Attributor::add(Fit fit) {
  fit.log_evidence += fitted_share_of_places(fit);
  result_.names.push_back(name_of(fit.hypothesis, model_.effects()));
  result_.not_fitted.erase(result_.names.back());
  result_.log_prior.push_back(log_prior(fit.hypothesis)), result_.evidence_penalty.push_back(0);
  result_.remainder.push_back(fit_remainder(model_, result_.fits.empty() ? fit : result_.fits.front(), fit));
  result_.weight.push_back(fit.log_evidence + result_.remainder.back().gain + log_prior_of_verdict(fit.hypothesis));
  result_.fits.push_back(std::move(fit));
}

namespace {

constexpr double same_signature = 0.999;  // cosine
constexpr const char* operating_point = "operating_point";

}  // namespace

bool Attributor::is_effect_by_another_name(const Screening& screening, int k) const {
  if (!model_.effects()[k].is_mistake || model_.effects()[k].fixed) return false;
  const Mistake* mistake = model_.mistake(k);
  const bool is_whole_flow = mistake != nullptr && mistake->input == flow_field;
  return std::any_of(candidates_.begin(), candidates_.end(), [&](int other) {
    const Effect& effect = model_.effects()[other];
    if (effect.is_mistake) return false;
    // Both scale the whole flow. Their signatures may differ, because they are of different strengths. An alternative (fixed) may have this
    // name and be something else.
    if (is_whole_flow && effect.name == operating_point && !effect.fixed) return true;
    return std::abs(screening.cosine(k, other)) > same_signature;
  });
}

void Attributor::find_same_inputs(const Screening& screening, const std::vector<int>& other_names) {
  for (const int input : other_names) {
    const Mistake* mistake = model_.mistake(input);
    if (mistake == nullptr || mistake->kind != Mistake::Kind::input) continue;
    for (const int k : candidates_) {
      const Effect& effect = model_.effects()[k];
      // These two effects mean that inputs of the flow are wrong.
      if (effect.is_mistake || effect.name == operating_point || effect.name == "flow_error") continue;
      const double cosine = screening.cosine(input, k), least = std::min(screening.detectability(input), screening.detectability(k));
      if (std::abs(cosine) > same_signature && least * std::sqrt(std::max(0.0, 1 - cosine * cosine)) < blind_detectability)
        result_.same_inputs[k].push_back({input, screening.change_of_one_sd(k) / screening.change_of_one_sd(input)});
    }
  }
}

void Attributor::forget(const std::string& name) {
  Identifiability& i = result_.identifiability;
  i.detectability.erase(name), i.blind.erase(name), i.cosines.erase(name);
  for (auto& [other, row] : i.cosines) row.erase(name);
  for (auto& group : i.ties) std::erase(group, name);
  std::erase_if(i.ties, [](const auto& group) { return group.size() < 2; });
}

void Attributor::identify(const Screening& screening) {
  Identifiability& i = result_.identifiability;
  for (const int a : candidates_) {
    const std::string& name = model_.effects()[a].name;
    i.detectability[name] = screening.detectability(a);
    if (i.detectability[name] < blind_detectability)
      i.blind[name] = "its expected signature is " + number_text(i.detectability[name]) + " standard uncertainties, below 3";
    for (const int b : candidates_)
      if (a != b) i.cosines[name][model_.effects()[b].name] = screening.cosine(a, b);
  }
  // Two effects are tied where their signatures are alike and what one leaves of the other's is not detectable.
  constexpr double collinear = 0.9;
  std::vector<bool> grouped(candidates_.size(), false);
  for (std::size_t a = 0; a < candidates_.size(); ++a) {
    if (grouped[a] || i.blind.contains(model_.effects()[candidates_[a]].name)) continue;
    std::vector<std::string> group{model_.effects()[candidates_[a]].name};
    for (std::size_t b = a + 1; b < candidates_.size(); ++b) {
      const std::string& other = model_.effects()[candidates_[b]].name;
      if (grouped[b] || i.blind.contains(other)) continue;
      const double cosine = i.cosines[group.front()][other];
      const double least = std::min(i.detectability[group.front()], i.detectability[other]);
      if (std::abs(cosine) > collinear && least * std::sqrt(std::max(0.0, 1 - cosine * cosine)) < blind_detectability)
        group.push_back(other), grouped[b] = true;
    }
    if (group.size() > 1) i.ties.push_back(group);
  }
}

std::vector<Screened> Attributor::screened_singles(const Screening& screening) {
  std::vector<Screened> singles;
  const double none = none_screened_ = screening.screen({}).log_evidence;
  result_.screening["none"] = 0;
  for (const int k : candidates_) {
    singles.push_back(screening.screen({{k}}));
    result_.screening[model_.effects()[k].name] = singles.back().log_evidence - none;
    result_.weak_form[model_.effects()[k].name] = screening.weak_gain(k);
  }
  const auto better = [](const Screened& a, const Screened& b) { return a.log_evidence > b.log_evidence; };
  std::stable_sort(singles.begin(), singles.end(), better);
  return singles;
}

std::vector<Screened> Attributor::kept(const std::vector<Screened>& singles) const {
  if (singles.empty()) return {};
  const double width = std::max(screening_width, share_not_linear * (singles.front().log_evidence - none_screened_));
  std::vector<Screened> kept;
  int n_effects = 0, n_mistakes = 0;
  const auto weak_gain = [&](const Screened& s) { return result_.weak_form.at(model_.effects()[s.hypothesis.effects[0]].name); };
  const auto first =
      std::max_element(singles.begin(), singles.end(), [&](const Screened& a, const Screened& b) { return weak_gain(a) < weak_gain(b); });
  for (auto s = singles.begin(); s != singles.end(); ++s) {
    const bool is_mistake = model_.effects()[s->hypothesis.effects[0]].is_mistake;
    const bool near = s->log_evidence >= singles.front().log_evidence - width;
    const bool by_paths =
        is_mistake ? near && n_mistakes < max_mistakes : n_effects < max_candidates && (n_effects < min_candidates || near);
    if (by_paths) ++(is_mistake ? n_mistakes : n_effects);
    if (by_paths || (s == first && weak_gain(*s) > weak_form_threshold)) kept.push_back(*s);
  }
  return kept;
}

void Attributor::fit_singles(const std::vector<Screened>& screened) {
  const std::vector<Screened> singles = kept(screened);
  for (std::size_t i = 0; i < singles.size(); ++i) {
    if (!affordable(runs_of(singles[i]))) return;
    report("fit of " + name_of(singles[i].hypothesis, model_.effects()),
           0.15 + 0.4 * static_cast<double>(i) / static_cast<double>(singles.size()));
    add(fit_of(singles[i]));
  }
  // What a screening left out because of others that then did not reach what it had promised.
  for (const Screened& one : screened) {
    const double best = result_.fits[static_cast<std::size_t>(result_.first_by_effects())].log_evidence;
    if (is_fitted(one.hypothesis) || one.log_evidence < best + gain_wanted) continue;
    if (!affordable(runs_of(one))) return;
    report("fit of " + name_of(one.hypothesis, model_.effects()), 0.55);
    add(fit_of(one));
  }
  note_screening(screened);
}

// The linear model of a screening reaches as far as the runs it was made of.
void Attributor::note_screening(const std::vector<Screened>& screened) {
  const double none = result_.fits.front().log_evidence;
  for (const Screened& one : screened) {
    const std::string name = name_of(one.hypothesis, model_.effects());
    const auto fitted = std::find(result_.names.begin(), result_.names.end(), name);
    if (fitted == result_.names.end() || !by_emulator(one.hypothesis)) continue;
    const Fit& fit = result_.fits[static_cast<std::size_t>(fitted - result_.names.begin())];
    const double promised = one.log_evidence - none_screened_, found = fit.log_evidence - none;
    if (promised - found < nats_of_rule || found > 0.5 * promised) continue;
    result_.notes.push_back("The screening promised " + rounded(promised) + " nats of " + name + " at " + rounded(one.theta[0]) +
                            ", the fit brings " + rounded(found) + " at " + rounded(fit.theta[0]) +
                            ": the two disagree. Give more runs a state ([budget] max_runs), and look at which rows differ.");
  }
}

void Attributor::fit_local_causes() {
  if (model_.base_is_random()) return;
  const std::vector<GateFamily> families = gate_families(model_, fitter_.base().responses);
  std::vector<int> seen;  // what cannot be seen where it acts everywhere cannot be seen in a part
  for (const int k : candidates_)
    if (!result_.identifiability.blind.contains(model_.effects()[k].name)) seen.push_back(k);
  const int scan_runs = runs_of_scan(model_, seen, families);
  if (scan_runs == 0 || !affordable(scan_runs + fitter_.runs_of_fit(1))) return;
  report("effects that act in a part only", 0.84);
  const LocalScan scan = scan_local_causes(model_, fitter_, seen, families);
  const double best = scan.found.front().log_evidence, width = std::max(screening_width, share_not_linear * (best - none_screened_));
  for (int i = 0; i < std::min(most_local, static_cast<int>(scan.found.size())); ++i) {
    const ScannedLocal& one = scan.found[static_cast<std::size_t>(i)];
    // At the best of its places it has to promise what it would have to bring over all of them.
    if (one.log_evidence < scan.best_everywhere + nats_of_rule || one.log_evidence < best - width) return;
    if (!affordable(2 * fitter_.runs_of_fit(1))) return;
    const int local = model_.add_local(one.effect, one.family.at(one.place));
    report("fit of " + model_.effects()[local].name, 0.84);
    LocalFit found = fit_local_cause(model_, fitter_, local, one, [&](int runs) { return affordable(runs); });
    result_.local[model_.effects()[local].name] = found.cause;
    result_.other_name_of[local] = one.effect, places_[local] = found.place;
    add(std::move(found.fit));
  }
}

Eigen::VectorXd Attributor::start(const Screened& screened) const {
  Eigen::VectorXd theta = screened.theta;
  for (Eigen::Index e = 0; e < theta.size(); ++e) {
    const Effect& effect = model_.effects()[screened.hypothesis.effects[e]];
    const double inside = 0.1 * std::abs(probe_strength(effect));
    theta[e] = std::clamp(theta[e], std::min(effect.minimum + inside, effect.maximum), effect.maximum);
  }
  return theta;
}

}  // namespace snag
