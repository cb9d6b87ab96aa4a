// Attribution: pairs, further effects in rounds, and rivals of the leader.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/words.hpp"
#include "diagnosis/attribution/attributor.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

Hypothesis Attributor::with(Hypothesis hypothesis, int k) const {
  const auto before = [&](int a, int b) { return model_.effects()[a].name < model_.effects()[b].name; };
  hypothesis.effects.insert(std::upper_bound(hypothesis.effects.begin(), hypothesis.effects.end(), k, before), k);
  return hypothesis;
}

Hypothesis Attributor::pair_of(int a, int b) const { return with({{a}}, b); }

std::vector<int> Attributor::best_singles() const {
  std::vector<int> order;
  for (int i = 1; i < static_cast<int>(result_.fits.size()); ++i)
    if (!model_.effects()[result_.fits[i].hypothesis.effects[0]].random) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return result_.fits[a].log_evidence > result_.fits[b].log_evidence; });
  return order;
}

void Attributor::fit_pairs(const Screening& first_screening) {
  if (candidates_.size() < 2) return;
  std::map<std::string, Screened> pairs;  // by name, each where it looks best
  const std::vector<int> singles = best_singles();
  for (std::size_t i = 0; i < singles.size() && i < n_screened_again; ++i) {
    const Fit& single = result_.fits[singles[i]];
    const int own = single.hypothesis.effects[0];
    // What brings less than half of what the best one does is half of a pair whose other half is better.
    const double none = result_.fits.front().log_evidence, best = result_.fits[singles.front()].log_evidence;
    if (i > 0 && single.log_evidence - none < 0.5 * (best - none)) continue;
    if (!affordable(static_cast<int>(candidates_.size()) + fitter_.runs_of_fit(2))) break;
    report("second effects beside " + result_.names[singles[i]], 0.6);
    const Screening second(model_, fitter_, candidates_, single.at);
    for (const int k : candidates_) {
      if (k == own || second.detectability(k) < least_of_further) continue;
      Screened screened = screened_beside(second, single, k);
      const std::string name = name_of(screened.hypothesis, model_.effects());
      if (screened.log_evidence + price_of_inputs(single) < result_.fits[singles.front()].log_evidence + gain_wanted) {
        const NotFitted as_screened{screened.log_evidence, log_prior(screened.hypothesis)};
        NotFitted& kept = result_.not_fitted.emplace(name, as_screened).first->second;
        kept.log_evidence = std::max(kept.log_evidence, screened.log_evidence);
        continue;
      }
      const auto found = pairs.find(name);
      if (found == pairs.end() || found->second.log_evidence < screened.log_evidence) pairs.insert_or_assign(name, std::move(screened));
    }
  }
  std::vector<Screened> order = best_first(std::move(pairs)), of_base = pairs_around_base(first_screening);
  std::erase_if(of_base, [&](const Screened& s) {
    return std::any_of(order.begin(), order.end(), [&](const Screened& other) { return other.hypothesis.effects == s.hypothesis.effects; });
  });
  order.resize(std::min<std::size_t>(order.size(), most_pairs));
  const auto n_around_singles = order.size();
  order.insert(order.end(), of_base.begin(), of_base.begin() + std::min<std::ptrdiff_t>(std::ssize(of_base), most_pairs_around_base));
  const double none = result_.fits.front().log_evidence,
               single = singles.empty() ? none : result_.fits[static_cast<std::size_t>(singles.front())].log_evidence;
  for (std::size_t i = 0; i < order.size() && affordable(fitter_.runs_of_fit(2)); ++i) {
    // This set is far behind the fitted ones. The margin grows with what the linear model was asked to reach over: from a single effect to
    // the best pair, or from the base model.
    const double best = result_.fits[static_cast<std::size_t>(result_.first_by_effects())].log_evidence;
    const double of_gap = share_not_linear * (best - none);
    const double reach = i < n_around_singles ? std::min(of_gap, share_of_second * (best - single)) : of_gap;
    if (order[i].log_evidence < best - std::max(screening_width, reach)) continue;
    report("fit of " + name_of(order[i].hypothesis, model_.effects()), 0.65 + 0.2 * static_cast<double>(i) / most_pairs);
    add(fit_of(order[i]));
  }
}

void Attributor::fit_in_rounds() {
  fit_in_rounds(-1);
  const Hypothesis found = result_.fits[static_cast<std::size_t>(result_.first_by_effects())].hypothesis;
  if (found.effects.size() < 2) return;
  for (const int k : found.effects)
    if (model_.effects()[k].is_mistake) fit_in_rounds(k);
}

void Attributor::fit_in_rounds(int without) {
  std::set<int> done;
  for (;;) {
    const int leader = result_.first_by_effects(without), around = without < 0 && done.contains(leader) ? result_.first() : leader;
    if (!done.insert(around).second) return;
    fit_round(around, without);
    if (without >= 0 || around != leader || result_.first_by_effects() != leader) continue;
    if (const int other = fit_exchange(leader); other >= 0) fit_round(other, without);
  }
}

void Attributor::fit_round(int found_so_far, int without) {
  const Fit around = result_.fits[static_cast<std::size_t>(found_so_far)];
  const Hypothesis& found = around.hypothesis;
  const auto n = static_cast<int>(found.effects.size());
  const bool is_local = n == 1 && model_.effects()[found.effects.front()].is_local;
  if ((n < 2 && !is_local) || n >= most_effects || !affordable(static_cast<int>(candidates_.size()) + fitter_.runs_of_fit(n + 1))) return;
  report("a further effect beside " + result_.names[static_cast<std::size_t>(found_so_far)], 0.86);
  const int leader = result_.first_by_effects(without);
  const Screening further(model_, fitter_, candidates_, around.at);
  const double screened_alone = further.screen(found).log_evidence;
  std::map<std::string, Screened> larger;
  for (const int k : candidates_) {
    if (k == without || std::count(found.effects.begin(), found.effects.end(), k) > 0 || is_in_part(found, k)) continue;
    if (further.detectability(k) < least_of_further) {
      result_.one_more.push_back({found_so_far, name_of(with(found, k), model_.effects()), 0, log_prior(with(found, k))});
      continue;
    }
    Screened screened = screened_beside(further, around, k);
    const double reached = screened.log_evidence + price_of_inputs(around) + screened_share_of_places(screened.hypothesis);
    const bool promises = reached > around.log_evidence + gain_wanted;
    // Of what promises and is not fitted, the budget or the rounds have nothing more to say: as if it brought nothing.
    result_.one_more.push_back({found_so_far, name_of(screened.hypothesis, model_.effects()),
                                promises ? 0 : screened.log_evidence - screened_alone, log_prior(screened.hypothesis)});
    if (promises && !is_fitted(screened.hypothesis)) larger.emplace(name_of(screened.hypothesis, model_.effects()), std::move(screened));
  }
  const std::vector<Screened> order = best_first(std::move(larger));
  for (std::size_t i = 0; i < order.size() && i < most_a_round && affordable(fitter_.runs_of_fit(n + 1)); ++i) add(fit_of(order[i]));
  if (const int next = result_.first_by_effects(without); next != leader) fit_without_each(next, found);
}

int Attributor::fit_exchange(int leader) {
  const Fit all = result_.fits[static_cast<std::size_t>(leader)];
  if (all.hypothesis.effects.size() < 2) return -1;
  const auto by_rule = [&](const Hypothesis& hypothesis, double log_evidence) { return log_evidence + log_prior_of_verdict(hypothesis); };
  double best = by_rule(all.hypothesis, all.log_evidence) - nats_of_rule;
  std::optional<Screened> exchanged;
  for (const int e : all.hypothesis.effects) {
    const auto rest = std::find_if(result_.fits.begin(), result_.fits.end(), [&](const Fit& fit) {
      Hypothesis one_more = fit.hypothesis;
      if (one_more.effects.size() + 1 != all.hypothesis.effects.size()) return false;
      return with(std::move(one_more), e).effects == all.hypothesis.effects;
    });
    if (rest == result_.fits.end() || !affordable(static_cast<int>(candidates_.size()))) continue;
    const Screening others(model_, fitter_, candidates_, rest->at);
    const double price = price_of_inputs(*rest);
    for (const int k : candidates_) {
      if (std::count(all.hypothesis.effects.begin(), all.hypothesis.effects.end(), k) > 0 || is_in_part(all.hypothesis, k) ||
          others.detectability(k) < least_of_further)
        continue;
      Screened screened = screened_beside(others, *rest, k);
      if (const double reached = by_rule(screened.hypothesis, screened.log_evidence + price);
          reached > best && !is_fitted(screened.hypothesis))
        best = reached, exchanged = std::move(screened);
    }
  }
  if (!exchanged || !affordable(runs_of(*exchanged))) return -1;
  report("another effect in the place of one of " + result_.names[static_cast<std::size_t>(leader)], 0.86);
  add(fit_of(*exchanged));
  return static_cast<int>(result_.fits.size()) - 1;
}

bool Attributor::is_in_part(const Hypothesis& hypothesis, int k) const {
  return std::any_of(hypothesis.effects.begin(), hypothesis.effects.end(), [&](int e) {
    const Gate* gate = model_.gate_of(e);
    return gate != nullptr && gate->effect == model_.effects()[k].name;
  });
}

bool Attributor::is_fitted(const Hypothesis& hypothesis) const {
  return std::count(result_.names.begin(), result_.names.end(), name_of(hypothesis, model_.effects())) > 0;
}

bool Attributor::fit_without(const Fit& all, std::size_t e) {
  Screened rest{.hypothesis = {}, .theta = Eigen::VectorXd(all.theta.size() - 1)};
  for (std::size_t other = 0; other < all.hypothesis.effects.size(); ++other) {
    if (other == e) continue;
    rest.theta[static_cast<Eigen::Index>(rest.hypothesis.effects.size())] = all.theta[static_cast<Eigen::Index>(other)];
    rest.hypothesis.effects.push_back(all.hypothesis.effects[other]), rest.forms.push_back(all.at.state.form(other));
  }
  if (is_fitted(rest.hypothesis)) return true;
  if (!affordable(runs_of(rest))) return false;
  report("fit of " + name_of(rest.hypothesis, model_.effects()), 0.86);
  add(fit_of(rest));
  return true;
}

void Attributor::fit_without_each(int larger, const Hypothesis& before) {
  const Fit all = result_.fits[static_cast<std::size_t>(larger)];
  for (std::size_t e = 0; e < all.hypothesis.effects.size(); ++e)
    if (std::count(before.effects.begin(), before.effects.end(), all.hypothesis.effects[e]) > 0 && !fit_without(all, e)) return;
}

void Attributor::fit_without_weak_members() {
  std::set<std::size_t> tested;
  for (;;) {
    const double best = result_.weight[static_cast<std::size_t>(result_.first())];
    std::size_t next = 0;  // the likeliest that was not tested; none is never
    for (std::size_t i = 1; i < result_.fits.size(); ++i)
      if (result_.weight[i] > best - nats_of_rule && !tested.contains(i) && (next == 0 || result_.weight[i] > result_.weight[next]))
        next = i;
    if (next == 0) return;
    tested.insert(next);
    const Fit all = result_.fits[next];
    if (all.hypothesis.effects.size() < 2) continue;
    for (std::size_t e = 0; e < all.hypothesis.effects.size(); ++e)
      if (!model_.effects()[all.hypothesis.effects[e]].fixed && clear_of_nothing(all, e, model_.effects()) < weak && !fit_without(all, e))
        return;
  }
}

void Attributor::credit_other_singles(const std::vector<int>& live) {
  const double none = result_.fits.front().log_evidence;
  double best_fit = none, best_screened = 0;
  for (std::size_t i = 0; i < result_.fits.size(); ++i) best_fit = std::max(best_fit, result_.fits[i].log_evidence);
  for (const auto& [name, gain] : result_.screening) best_screened = std::max(best_screened, gain);
  for (const int k : live) {
    const std::string& name = model_.effects()[k].name;
    if (std::count(result_.names.begin(), result_.names.end(), name) > 0) continue;
    const auto screened = result_.screening.find(name);
    const double gain = screened == result_.screening.end() ? 0 : screened->second;
    result_.not_fitted[name] = {std::min(none + gain, best_fit - (best_screened - gain)), log_prior({{k}})};
  }
}

void Attributor::credit_other_pairs(const std::vector<int>& live) {
  const double none = result_.fits.front().log_evidence;
  std::map<int, double> alone;
  for (const int k : live) {
    const auto other = result_.not_fitted.find(model_.effects()[k].name);
    if (other != result_.not_fitted.end()) alone[k] = other->second.log_evidence;
  }
  for (const Fit& fit : result_.fits)
    if (fit.hypothesis.effects.size() == 1 && !model_.effects()[fit.hypothesis.effects[0]].is_local)
      alone[fit.hypothesis.effects[0]] = fit.log_evidence;
  for (auto a = alone.begin(); a != alone.end(); ++a) {
    for (auto b = std::next(a); b != alone.end(); ++b) {
      const Hypothesis pair = pair_of(a->first, b->first);
      const std::string name = name_of(pair, model_.effects());
      const auto [other, better] = std::minmax(a->second, b->second);
      if (std::count(result_.names.begin(), result_.names.end(), name) == 0)
        result_.not_fitted.emplace(name, NotFitted{better + std::min(0.0, other - none), log_prior(pair)});
    }
  }
}

void Attributor::fit_rivals_of_leader() {
  const Fit& first = result_.fits[static_cast<std::size_t>(result_.first())];
  const Hypothesis leader = first.hypothesis;
  const Eigen::VectorXd theta = first.theta;
  for (std::size_t e = 0; e < leader.effects.size(); ++e) {
    for (const int k : candidates_) {
      if (!look_alike(leader.effects[e], k) || std::count(leader.effects.begin(), leader.effects.end(), k) > 0) continue;
      const Screened rival = with_instead(leader, theta, e, k);
      if (is_fitted(rival.hypothesis)) continue;
      if (!affordable(runs_of(rival))) return;
      report("fit of " + name_of(rival.hypothesis, model_.effects()), 0.85);
      add(fit_of(rival));
    }
  }
}

void Attributor::refine_random_leader() {
  const auto i = static_cast<std::size_t>(result_.first());
  Fit& leader = result_.fits[i];
  if (leader.hypothesis.effects.size() != 1 || !model_.effects()[leader.hypothesis.effects[0]].random) return;
  const Refinement refinement{leader.theta[0], model_.n_seeds_of_distribution(leader.at.state)};
  if (model_.base_is_random() || !affordable(refinement.n_seeds)) return;
  report("more runs of " + result_.names[i], 0.87);
  result_.weight[i] -= leader.log_evidence + result_.remainder[i].gain;
  leader = emulated(leader.hypothesis.effects[0], refinement);
  result_.remainder[i] = fit_remainder(model_, result_.fits.front(), leader);
  result_.weight[i] += leader.log_evidence + result_.remainder[i].gain;
}

bool Attributor::look_alike(int a, int b) const {
  const auto& ties = result_.identifiability.ties;
  return std::any_of(ties.begin(), ties.end(), [&](const std::vector<std::string>& group) {
    return std::count(group.begin(), group.end(), model_.effects()[a].name) > 0 &&
           std::count(group.begin(), group.end(), model_.effects()[b].name) > 0;
  });
}

Screened Attributor::with_instead(const Hypothesis& hypothesis, const Eigen::VectorXd& theta, std::size_t e, int k) const {
  std::vector<std::pair<int, double>> effects;
  for (std::size_t i = 0; i < hypothesis.effects.size(); ++i)
    effects.emplace_back(hypothesis.effects[i], theta[static_cast<Eigen::Index>(i)]);
  const Effect &own = model_.effects()[effects[e].first], &other = model_.effects()[k];
  effects[e] = {k, effects[e].second / probe_strength(own) * probe_strength(other)};
  std::sort(effects.begin(), effects.end(),
            [&](const auto& a, const auto& b) { return model_.effects()[a.first].name < model_.effects()[b.first].name; });
  Screened swapped{.hypothesis = {}, .theta = Eigen::VectorXd(static_cast<Eigen::Index>(effects.size()))};
  for (const auto& [index, strength] : effects) {
    swapped.theta[static_cast<Eigen::Index>(swapped.hypothesis.effects.size())] = strength;
    swapped.hypothesis.effects.push_back(index);
  }
  return swapped;
}

std::pair<std::string, double> Attributor::furthest_input(const Fit& fit) const {
  std::pair<std::string, double> furthest;
  for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
    const auto i = fit.linear.lower.size() + static_cast<Eigen::Index>(j);
    if (const double deviation = std::abs(fit.solution.d[i] - fit.linear.prior[i]); deviation > furthest.second)
      furthest = {model_.nuisances()[j].name, deviation};
  }
  return furthest;
}

double Attributor::price_of_inputs(const Fit& fit) const {
  constexpr double by_chance = 2;  // standard uncertainties
  const double furthest = furthest_input(fit).second;
  return 0.5 * std::max(0.0, furthest * furthest - by_chance * by_chance);
}

Screened Attributor::screened_beside(const Screening& screening, const Fit& found, int k) const {
  const Hypothesis hypothesis = with(found.hypothesis, k);
  Screened screened = screening.screen(hypothesis);
  constexpr double far = 3;  // standard uncertainties, from which an input is named
  const auto [input, deviation] = furthest_input(found);
  if (deviation < far || model_.effects()[k].is_mistake || model_.base_is_random()) return screened;
  Screened in_its_place = screening.screen_in_place_of(input, k, hypothesis);
  return in_its_place.log_evidence > screened.log_evidence ? in_its_place : screened;
}

std::vector<Screened> Attributor::best_first(std::map<std::string, Screened>&& by_name) {
  std::vector<Screened> order;
  for (auto& [name, screened] : by_name) order.push_back(std::move(screened));
  std::stable_sort(order.begin(), order.end(), [](const Screened& a, const Screened& b) { return a.log_evidence > b.log_evidence; });
  return order;
}

std::vector<Screened> Attributor::pairs_around_base(const Screening& screening) const {
  double best_single = -std::numeric_limits<double>::infinity();
  for (const int k : candidates_) best_single = std::max(best_single, screening.screen({{k}}).log_evidence);
  std::map<std::string, Screened> pairs;
  for (std::size_t a = 0; a < candidates_.size(); ++a) {
    for (std::size_t b = a + 1; b < candidates_.size(); ++b) {
      Screened screened = screening.screen(pair_of(candidates_[a], candidates_[b]));
      if (screened.log_evidence > best_single + nats_of_rule)
        pairs.emplace(name_of(screened.hypothesis, model_.effects()), std::move(screened));
    }
  }
  return best_first(std::move(pairs));
}

}  // namespace snag
