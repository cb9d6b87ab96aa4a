#include "diagnosis/attribution/attribution.hpp"

#include <algorithm>
#include <cmath>

#include "base/words.hpp"
#include "diagnosis/attribution/emulated_fit.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

/// Shares of the prior: how many effects of the library a model lacks is a Poisson number of mean one, each effect as likely as the others;
/// a tenth is for what nobody listed, another for the mistakes that inputs and data may hold. To be named, an effect beyond the first has
/// to bring 6 nats (a surplus effect takes up what the others leave): a rule of the verdict, of which the probabilities know nothing.
constexpr double prior_none = 0.36, prior_effects = 0.36, prior_mistakes = 0.1;
/// Hypotheses within this many nats of the best in the screening are re-simulated, and at least so many.
/// A linear model of a gap of hundreds of nats is off by a share of them.
constexpr double screening_width = 10, share_not_linear = 0.05, weak_form_threshold = 3;
constexpr int min_candidates = 3, max_candidates = 8, max_mistakes = 3, most_pairs = 5, most_pairs_around_base = 2, n_screened_again = 3,
              most_effects = 5, most_a_round = 2;
constexpr double blind_detectability = 3;
/// Nats that an effect beyond the first has to promise in a screening to be fitted: the linear model may be off by some. And standard
/// uncertainties that it is expected to show beside the others.
constexpr double gain_wanted = nats_of_rule - 3, least_of_further = 1;

class Attributor {
 public:
  Attributor(Responses& model, Fitter& fitter, const std::function<void(const std::string&, double)>& progress)
      : model_(model), fitter_(fitter), progress_(progress) {}

  Attribution attribute() {
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
      if (is_effect_by_another_name(screening, k)) other_names.push_back(k), forget(model_.effects()[k].name);
    const auto is_other_name = [&](int k) { return std::count(other_names.begin(), other_names.end(), k) > 0; };
    std::erase_if(live, is_other_name), std::erase_if(candidates_, is_other_name);
    // What changes no run is the base model under another name: friction of what touches nothing is no hypothesis.
    const auto changes_none = [&](int k) { return !model_.effects()[k].random && !screening.changes_runs(k); };
    std::erase_if(live, changes_none), std::erase_if(candidates_, changes_none);
    result_.placebo_rate = screening.placebo_rate(model_.experiment().seed);
    const std::vector<Screened> singles = screened_singles(screening);
    report("fits", 0.15);
    add(fitter_.fit({}, Eigen::VectorXd()));
    fit_singles(singles);
    credit_other_singles(live);
    fit_random_effects();
    if (model_.experiment().pairs) fit_pairs(screening);
    fit_rivals_of_leader();
    if (model_.experiment().pairs) fit_in_rounds();
    refine_random_leader();
    if (model_.experiment().pairs) credit_other_pairs(live);
    result_.discrepancy = fit_discrepancy(model_, fitter_, result_.fits.front());
    result_.discrepancy_weight = result_.discrepancy.log_evidence + std::log(prior_outside);
    for (const Fit& fit : result_.fits) result_.leave_one_out.push_back(leave_one_out(fit));
    set_probabilities(result_);
    return std::move(result_);
  }

 private:
  void report(const std::string& stage, double done) const {
    if (progress_) progress_(stage, done);
  }

  // Whether this many runs a training point are still in the budget.
  bool affordable(int runs_per_point) {
    if (fitter_.runs_left() >= runs_per_point * static_cast<int>(model_.training().size())) return true;
    const std::string note = "The budget of " + std::to_string(model_.experiment().max_runs) +
                             " runs ended before every hypothesis was fitted; raise [budget] max_runs.";
    if (result_.notes.empty() || result_.notes.back() != note) result_.notes.push_back(note);
    return false;
  }
  int runs_of_emulator(int effect) const {
    return static_cast<int>(emulated_strengths(model_.effects()[effect]).size()) *
           model_.n_seeds({{{effect, 1}}, fitter_.base().state.nuisances});
  }

  // Differences of runs that chance has a part in are no derivatives.
  bool by_emulator(const Hypothesis& hypothesis) const {
    return model_.base_is_random() && hypothesis.effects.size() == 1 && !model_.effects()[hypothesis.effects[0]].fixed;
  }
  int runs_of(const Screened& screened) const {
    const auto& effects = screened.hypothesis.effects;
    return by_emulator(screened.hypothesis) ? runs_of_emulator(effects[0]) : fitter_.runs_of_fit(static_cast<int>(effects.size()));
  }
  Fit fit_of(const Screened& screened) {
    return by_emulator(screened.hypothesis) ? emulated(screened.hypothesis.effects[0])
                                            : fitter_.fit(screened.hypothesis, start(screened), screened.forms);
  }
  Fit emulated(int effect, const Refinement& refinement = {}) {
    return fit_by_emulator(model_, fitter_, effect, emulated_strengths(model_.effects()[effect]), refinement);
  }

  // Few strengths first: what is far behind there need not be known better.
  void fit_random_effects() {
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

  double prior_of(int k) const { return model_.effects()[k].is_mistake ? prior_mistakes / n_mistakes_ : prior_effects / n_singles_; }

  // Each effect is there or not whatever the others are.
  double log_prior(const Hypothesis& hypothesis) const {
    double sum = std::log(prior_none);
    for (const int k : hypothesis.effects) sum += std::log(prior_of(k) / prior_none);
    return sum;
  }

  // Effects beyond the first, and mistakes, have to bring the nats of the rule.
  double log_prior_of_verdict(const Hypothesis& hypothesis) const {
    if (hypothesis.effects.empty()) return std::log(prior_none);
    double best = 0;
    int n_priced = static_cast<int>(hypothesis.effects.size()) - 1;
    for (const int k : hypothesis.effects) best = std::max(best, prior_of(k)), n_priced += model_.effects()[k].is_mistake;
    return std::log(best) - n_priced * nats_of_rule;
  }

  void add(Fit fit) {
    result_.names.push_back(name_of(fit.hypothesis, model_.effects()));
    result_.not_fitted.erase(result_.names.back());
    result_.log_prior.push_back(log_prior(fit.hypothesis)), result_.evidence_penalty.push_back(0);
    result_.remainder.push_back(fit_remainder(model_, result_.fits.empty() ? fit : result_.fits.front(), fit));
    result_.weight.push_back(fit.log_evidence + result_.remainder.back().gain + log_prior_of_verdict(fit.hypothesis));
    result_.fits.push_back(std::move(fit));
  }

  // An input that does the same as an effect (the flow of all points as operating_point, the drag law as drag_magnitude) is that effect.
  bool is_effect_by_another_name(const Screening& screening, int k) const {
    constexpr double same = 0.999;
    return model_.effects()[k].is_mistake && !model_.effects()[k].fixed &&
           std::any_of(candidates_.begin(), candidates_.end(),
                       [&](int other) { return !model_.effects()[other].is_mistake && std::abs(screening.cosine(k, other)) > same; });
  }
  void forget(const std::string& name) {
    Identifiability& i = result_.identifiability;
    i.detectability.erase(name), i.blind.erase(name), i.cosines.erase(name);
    for (auto& [other, row] : i.cosines) row.erase(name);
    for (auto& group : i.ties) std::erase(group, name);
    std::erase_if(i.ties, [](const auto& group) { return group.size() < 2; });
  }

  void identify(const Screening& screening) {
    Identifiability& i = result_.identifiability;
    for (const int a : candidates_) {
      const std::string& name = model_.effects()[a].name;
      i.detectability[name] = screening.detectability(a);
      if (i.detectability[name] < blind_detectability)
        i.blind[name] = "its expected signature is " + words(i.detectability[name]) + " standard uncertainties, below 3";
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

  std::vector<Screened> screened_singles(const Screening& screening) {
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

  // What the paths keep, and what their accelerations speak for most: an offset or a drift may hide it from the paths.
  std::vector<Screened> kept(const std::vector<Screened>& singles) const {
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

  void fit_singles(const std::vector<Screened>& screened) {
    const std::vector<Screened> singles = kept(screened);
    for (std::size_t i = 0; i < singles.size(); ++i) {
      if (!affordable(runs_of(singles[i]))) break;
      report("fit of " + name_of(singles[i].hypothesis, model_.effects()),
             0.15 + 0.4 * static_cast<double>(i) / static_cast<double>(singles.size()));
      add(fit_of(singles[i]));
    }
  }

  // A strength at the edge of its range says little of where to begin: a tenth of the probe strength inside.
  Eigen::VectorXd start(const Screened& screened) const {
    Eigen::VectorXd theta = screened.theta;
    for (Eigen::Index e = 0; e < theta.size(); ++e) {
      const Effect& effect = model_.effects()[screened.hypothesis.effects[e]];
      const double inside = 0.1 * std::abs(probe_strength(effect));
      theta[e] = std::clamp(theta[e], std::min(effect.minimum + inside, effect.maximum), effect.maximum);
    }
    return theta;
  }

  // The hypothesis that holds effect k too.
  Hypothesis with(Hypothesis hypothesis, int k) const {
    const auto before = [&](int a, int b) { return model_.effects()[a].name < model_.effects()[b].name; };
    hypothesis.effects.insert(std::upper_bound(hypothesis.effects.begin(), hypothesis.effects.end(), k, before), k);
    return hypothesis;
  }
  Hypothesis pair_of(int a, int b) const { return with({{a}}, b); }

  // The fits of single effects that are not random, the best first.
  std::vector<int> best_singles() const {
    std::vector<int> order;
    for (int i = 1; i < static_cast<int>(result_.fits.size()); ++i)
      if (!model_.effects()[result_.fits[i].hypothesis.effects[0]].random) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return result_.weight[a] > result_.weight[b]; });
    return order;
  }

  // Pairs: the best single effects with every other one, screened again around their fits. Where two effects act, the first screening is
  // far from linear, and either of them, or a third that stands for both, may lead among the single ones.
  void fit_pairs(const Screening& first_screening) {
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
        Screened screened = second.screen(pair_of(own, k));
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
      return std::any_of(order.begin(), order.end(),
                         [&](const Screened& other) { return other.hypothesis.effects == s.hypothesis.effects; });
    });
    order.resize(std::min<std::size_t>(order.size(), most_pairs));
    order.insert(order.end(), of_base.begin(), of_base.begin() + std::min<std::ptrdiff_t>(std::ssize(of_base), most_pairs_around_base));
    for (std::size_t i = 0; i < order.size() && affordable(fitter_.runs_of_fit(2)); ++i) {
      // This set is far behind the fitted ones. The margin grows with the gap, because the error of a linear model does.
      const double best = result_.fits[static_cast<std::size_t>(result_.first())].log_evidence, none = result_.fits.front().log_evidence;
      if (order[i].log_evidence < best - std::max(screening_width, share_not_linear * (best - none))) continue;
      report("fit of " + name_of(order[i].hypothesis, model_.effects()), 0.65 + 0.2 * static_cast<double>(i) / most_pairs);
      add(fit_of(order[i]));
    }
  }

  // Further effects, one a round: around the leading fit, which holds what was found, the others are screened again, and what promises most
  // is fitted with all that was found; then each effect that was there before is left out in its turn: it may have stood for what was
  // missing. The rounds end where none brings a better hypothesis.
  void fit_in_rounds() {
    for (int leader = -1; leader != result_.first();) {
      leader = result_.first();
      const Hypothesis found = result_.fits[static_cast<std::size_t>(leader)].hypothesis;
      const auto n = static_cast<int>(found.effects.size());
      if (n < 2 || n >= most_effects || !affordable(static_cast<int>(candidates_.size()) + fitter_.runs_of_fit(n + 1))) return;
      report("a further effect beside " + result_.names[static_cast<std::size_t>(leader)], 0.86);
      const Fit around = result_.fits[static_cast<std::size_t>(leader)];
      const Screening further(model_, fitter_, candidates_, around.at);
      std::map<std::string, Screened> larger;
      for (const int k : candidates_) {
        if (std::count(found.effects.begin(), found.effects.end(), k) > 0 || further.detectability(k) < least_of_further) continue;
        Screened screened = further.screen(with(found, k));
        if (screened.log_evidence + price_of_inputs(around) > around.log_evidence + gain_wanted)
          larger.emplace(name_of(screened.hypothesis, model_.effects()), std::move(screened));
      }
      const std::vector<Screened> order = best_first(std::move(larger));
      for (std::size_t i = 0; i < order.size() && i < most_a_round && affordable(fitter_.runs_of_fit(n + 1)); ++i) add(fit_of(order[i]));
      if (result_.first() != leader) fit_without_each(result_.first(), found);
    }
  }

  // A fit without each of the effects that were there before, where there is none yet.
  void fit_without_each(int larger, const Hypothesis& before) {
    const Fit all = result_.fits[static_cast<std::size_t>(larger)];
    for (const int k : before.effects) {
      Screened rest{.hypothesis = {}, .theta = Eigen::VectorXd(all.theta.size() - 1)};
      for (std::size_t e = 0; e < all.hypothesis.effects.size(); ++e) {
        if (all.hypothesis.effects[e] == k) continue;
        rest.theta[static_cast<Eigen::Index>(rest.hypothesis.effects.size())] = all.theta[static_cast<Eigen::Index>(e)];
        rest.hypothesis.effects.push_back(all.hypothesis.effects[e]), rest.forms.push_back(all.at.state.form(e));
      }
      const std::string name = name_of(rest.hypothesis, model_.effects());
      if (std::count(result_.names.begin(), result_.names.end(), name) > 0) continue;
      if (!affordable(runs_of(rest))) return;
      add(fit_of(rest));
    }
  }

  // An effect that was screened only is behind the best fit by what it was behind in the screening; a random one, until it is fitted,
  // brings nothing.
  void credit_other_singles(const std::vector<int>& live) {
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

  // Pairs that nobody looked at bring what the better of their effects brings, less what the other costs alone.
  void credit_other_pairs(const std::vector<int>& live) {
    const double none = result_.fits.front().log_evidence;
    std::map<int, double> alone;
    for (const int k : live) {
      const auto other = result_.not_fitted.find(model_.effects()[k].name);
      if (other != result_.not_fitted.end()) alone[k] = other->second.log_evidence;
    }
    for (const Fit& fit : result_.fits)
      if (fit.hypothesis.effects.size() == 1) alone[fit.hypothesis.effects[0]] = fit.log_evidence;
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

  // What looks like an effect of the leading hypothesis in this experiment may stand in its place: it is fitted, too, or the leader would
  // seem surer than it can be.
  void fit_rivals_of_leader() {
    const Fit& first = result_.fits[static_cast<std::size_t>(result_.first())];
    const Hypothesis leader = first.hypothesis;
    const Eigen::VectorXd theta = first.theta;
    for (std::size_t e = 0; e < leader.effects.size(); ++e) {
      for (const int k : candidates_) {
        if (!look_alike(leader.effects[e], k) || std::count(leader.effects.begin(), leader.effects.end(), k) > 0) continue;
        const Screened rival = with_instead(leader, theta, e, k);
        const std::string name = name_of(rival.hypothesis, model_.effects());
        if (std::count(result_.names.begin(), result_.names.end(), name) > 0) continue;
        if (!affordable(runs_of(rival))) return;
        report("fit of " + name, 0.85);
        add(fit_of(rival));
      }
    }
  }

  // The runs of an emulator do not fill in a distribution; the likeliest hypothesis must not be refused for what they lack.
  void refine_random_leader() {
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

  bool look_alike(int a, int b) const {
    const auto& ties = result_.identifiability.ties;
    return std::any_of(ties.begin(), ties.end(), [&](const std::vector<std::string>& group) {
      return std::count(group.begin(), group.end(), model_.effects()[a].name) > 0 &&
             std::count(group.begin(), group.end(), model_.effects()[b].name) > 0;
    });
  }

  // A hypothesis with effect k at place e, as strong by its own measure as what was there.
  Screened with_instead(const Hypothesis& hypothesis, const Eigen::VectorXd& theta, std::size_t e, int k) const {
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

  // What the furthest input costs beyond chance, nats. A second effect that saves it lies further from the fit than a linear model reaches:
  // its screened evidence is too low.
  double price_of_inputs(const Fit& fit) const {
    const auto m = static_cast<Eigen::Index>(model_.nuisances().size());
    constexpr double by_chance = 2;  // standard uncertainties
    double furthest = 0;
    for (const double deviation : (fit.solution.d - fit.linear.prior).segment(fit.linear.lower.size(), m).eval())
      furthest = std::max(furthest, std::abs(deviation));
    return 0.5 * std::max(0.0, furthest * furthest - by_chance * by_chance);
  }

  static std::vector<Screened> best_first(std::map<std::string, Screened>&& by_name) {
    std::vector<Screened> order;
    for (auto& [name, screened] : by_name) order.push_back(std::move(screened));
    std::stable_sort(order.begin(), order.end(), [](const Screened& a, const Screened& b) { return a.log_evidence > b.log_evidence; });
    return order;
  }

  // Pairs that look better than every single effect from the base model already.
  std::vector<Screened> pairs_around_base(const Screening& screening) const {
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

  Responses& model_;
  Fitter& fitter_;
  const std::function<void(const std::string&, double)>& progress_;
  Attribution result_;
  std::vector<int> candidates_, random_;
  int n_singles_ = 1, n_mistakes_ = 0;  // live effects, mistakes
  double none_screened_ = 0;            // log evidence of the base model in the screening
};

}  // namespace

Attribution attribute(Responses& model, Fitter& fitter, const std::function<void(const std::string&, double)>& progress) {
  return Attributor(model, fitter, progress).attribute();
}

}  // namespace snag
