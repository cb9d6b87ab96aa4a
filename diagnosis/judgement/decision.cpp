#include "diagnosis/judgement/decision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "base/words.hpp"
#include "diagnosis/attribution/same_cause.hpp"
#include "diagnosis/judgement/checks.hpp"

namespace snag {

namespace {

constexpr double attributed = 0.9, suspected = 0.5;
/// A set of effects is named without the 6 nats of the rule where its probability is this, three times that of all other hypotheses
/// together.
constexpr double likely_alone = 0.75;
constexpr double check_limit = 1e-3, constancy_limit = 1e-3;
/// Rankings by evidence and by points left out differ where the other leader is ahead by more than this; less is chance.
constexpr double rankings_differ = 2;

std::vector<std::string> effect_names(const Responses& model, const Fit& fit) {
  std::vector<std::string> names;
  for (const int k : fit.hypothesis.effects) names.push_back(model.effects()[k].name);
  return names;
}

// What is less than two standard deviations clear of nothing is no effect, and an input within three of its uncertainties is as it is
// known.
bool has_weak_effect(const Responses& model, const Fit& fit) {
  constexpr double seen = 2;
  for (std::size_t e = 0; e < fit.hypothesis.effects.size(); ++e) {
    const auto i = static_cast<Eigen::Index>(e);
    const Effect& effect = model.effects()[fit.hypothesis.effects[e]];
    if (!effect.fixed && (std::abs(fit.theta[i]) < effect.least || clear_of_nothing(fit, e, model.effects()) < seen)) return true;
  }
  return false;
}

bool has_absorbing_effect(const Responses& model, const Fit& fit) {
  const auto all = estimates(model, fit);
  return std::any_of(all.begin(), all.end(), [](const EffectEstimate& e) { return e.absorbing; });
}

// An effect whose strength may be zero is not believed, nor a third or later one with which a strength is absorbing: the weight of its
// hypothesis falls below that of the others of it, the smaller hypotheses first.
void drop_surplus_effects(const Responses& model, Attribution& a) {
  std::vector<int> order;
  for (int i = 1; i < static_cast<int>(a.fits.size()); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    return a.fits[static_cast<std::size_t>(i)].hypothesis.effects.size() < a.fits[static_cast<std::size_t>(j)].hypothesis.effects.size();
  });
  for (const int fit : order) {
    const auto i = static_cast<std::size_t>(fit);
    const int part = a.best_part_of(fit);
    if (part < 0) continue;
    const bool weak = has_weak_effect(model, a.fits[i]);
    const bool absorbing = a.fits[i].hypothesis.effects.size() > 2 && has_absorbing_effect(model, a.fits[i]);
    if (!weak && !absorbing) continue;
    constexpr double behind = 1;
    if (a.weight[i] <= a.weight[static_cast<std::size_t>(part)] - behind) continue;
    if (a.first() == fit)
      a.notes.push_back(weak ? "A strength of " + a.names[i] +
                                   " is less than 2 standard deviations clear of nothing, or an input less than 3 u off: it is not named."
                             : "A strength of " + a.names[i] +
                                   " is more than 3 standard deviations from its expected value: its last effect is not named.");
    a.weight[i] = a.weight[static_cast<std::size_t>(part)] - behind;
    // What it is credited with beside the others is what chance gives: nothing.
    a.evidence_penalty[i] = std::max(0.0, a.log_evidence(fit) - a.log_evidence(part));
  }
}

// Hypotheses that hold nine tenths of the probability together, the likeliest first, and the one that leads by the rule. What was not
// fitted has its share, but no verdict rests on it.
std::vector<std::string> shared_verdict(const Attribution& a, int leading) {
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [name, p] : a.probability) order.emplace_back(-p, name);
  std::sort(order.begin(), order.end());
  std::vector<std::string> shared;
  double sum = 0;
  for (const auto& [minus_p, name] : order) {
    if (name == "outside" || std::count(a.names.begin(), a.names.end(), name) > 0) shared.push_back(name);
    sum -= minus_p;
    if (sum >= attributed) break;
  }
  const std::string& name = a.names[static_cast<std::size_t>(leading)];
  if (std::count(shared.begin(), shared.end(), name) == 0) shared.push_back(name);
  return shared;
}

bool all_blind(const Responses& model, const Attribution& a) {
  std::map<std::string, std::string> unused;
  auto live = live_candidates(model, unused);
  // A random effect has no signature to be too small.
  std::erase_if(live, [&](int k) { return model.effects()[k].random || model.effects()[k].is_mistake; });
  return std::all_of(live.begin(), live.end(), [&](int k) { return a.identifiability.blind.contains(model.effects()[k].name); });
}

class Judge {
 public:
  Judge(const Responses& model, Attribution& attribution, Verdict& verdict) : model_(model), a_(attribution), v_(verdict) {}

  int judge() {
    drop_surplus_effects(model_, a_);
    set_probabilities(a_);
    v_.local = a_.local, v_.probability = a_.probability, v_.notes = a_.notes, v_.screening = a_.screening, v_.weak_form = a_.weak_form,
    v_.placebo_rate = a_.placebo_rate;
    for (std::size_t i = 0; i < a_.fits.size(); ++i) {
      v_.log_evidence[a_.names[i]] = a_.fits[i].log_evidence + a_.remainder[i].gain - a_.fits[0].log_evidence;
      if (!a_.fits[i].hypothesis.effects.empty()) v_.remainder[a_.names[i]] = a_.remainder[i].log_evidence;
      v_.leave_one_out[a_.names[i]] = a_.leave_one_out[i] - a_.leave_one_out[0];
    }
    v_.log_evidence["outside"] = a_.discrepancy.log_evidence - a_.fits[0].log_evidence;
    const int first = likely_larger_set(a_.first());
    discrepancy_leads_by_ = a_.outside_leads_by();
    v_.checks = predictive_checks(model_, a_.fits[first], model_.experiment().seed);
    if (discrepancy_leads_by_ > nats_of_rule)
      discrepancy();
    else if (a_.fits[first].hypothesis.effects.empty())
      none();
    else
      effects(first);
    for (const auto& [name, p] : v_.probability)
      for (const std::string& effect : split(name, '+'))
        if (effect != "none" && effect != "outside") v_.acts[effect] += p;
    const int reported = v_.verdict == VerdictKind::none || v_.verdict == VerdictKind::blind ? 0
                         : v_.verdict == VerdictKind::effects                                ? first
                                                                                             : a_.best_with_effect();
    for (const int i : std::set<int>{reported, a_.best_with_effect()}) note_parameters(i);
    note_inputs(a_.fits[first]);
    if (v_.verdict == VerdictKind::effects) note_ranges(a_.fits[first]);
    note_checks(first);
    return reported;
  }

 private:
  // The probabilities know nothing of the price that the rule puts on a further effect. The likeliest set that holds the leading effects
  // and further ones that act everywhere, if it is likely enough to be named as suspected; else the leading one. A mistake and a local
  // effect have to bring the 6 nats, and so has an effect beside mistakes alone: these are to be mended first, and the data diagnosed
  // again.
  int likely_larger_set(int first) {
    const std::vector<int>& leading = a_.fits[static_cast<std::size_t>(first)].hypothesis.effects;
    if (std::all_of(leading.begin(), leading.end(), [&](int k) { return model_.effects()[k].is_mistake; })) return first;
    int best = first;
    for (int i = 1; i < static_cast<int>(a_.fits.size()); ++i) {
      const std::vector<int>& all = a_.fits[static_cast<std::size_t>(i)].hypothesis.effects;
      const auto is_there = [&](int k) { return std::count(all.begin(), all.end(), k) > 0; };
      const auto is_priced = [&](int k) {
        return std::count(leading.begin(), leading.end(), k) == 0 && (model_.effects()[k].is_mistake || model_.effects()[k].is_local);
      };
      if (all.size() <= leading.size() || !std::all_of(leading.begin(), leading.end(), is_there) ||
          std::any_of(all.begin(), all.end(), is_priced))
        continue;
      if (best == first || a_.log_prior[i] + a_.log_evidence(i) > a_.log_prior[best] + a_.log_evidence(best)) best = i;
    }
    if (best == first) return first;
    const std::vector<std::string> effects = effect_names(model_, a_.fits[static_cast<std::size_t>(best)]);
    std::map<std::string, std::vector<std::string>> same_as;
    for (const int k : a_.fits[static_cast<std::size_t>(best)].hypothesis.effects)
      for (const int other : same_causes(model_, a_, best, k)) same_as[model_.effects()[k].name].push_back(model_.effects()[other].name);
    const double p = probability_of(a_, effects, same_as, true);
    if (p < likely_alone) return first;
    v_.notes.push_back(a_.names[best] + " brings " + rounded(a_.log_evidence(best) - a_.log_evidence(first)) + " nats more than " +
                       a_.names[first] + ". To be attributed, each further effect has to bring 6 nats. The set has a probability of " +
                       number_text(p) + ", so it is named as suspected.");
    is_below_rule_ = true;
    return best;
  }

  // A check shows that the hypothesis does not expect such data. It does not show which hypothesis is right: it adds a note and decides
  // nothing.
  void note_checks(int first) {
    for (const PredictiveCheck& check : v_.checks) {
      if (check.p >= check_limit) continue;
      v_.notes.push_back("Data like these are not expected under " + a_.names[static_cast<std::size_t>(first)] + ": " + check.name +
                         " is " + number_text(check.value) + ", p = " + number_text(check.p) + ".");
      return;
    }
  }

  void discrepancy() {
    v_.verdict = VerdictKind::outside, v_.wording = Wording::outside;
    const int best = a_.best_with_effect();
    if (best == 0) return;
    v_.effects = effect_names(model_, a_.fits[best]);
    v_.notes.push_back(a_.names[best] + " describes the gap best among the effects of the library, but only in part; it is not the cause.");
  }

  // What each named effect has of the gap, and what stays.
  void note_causes(int fit) {
    const Remainder& remainder = a_.remainder[static_cast<std::size_t>(fit)];
    const auto& effects = a_.fits[static_cast<std::size_t>(fit)].hypothesis.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      Cause cause{.effect = v_.effects[e]};
      if (e < remainder.share_of_effect.size()) cause.share = remainder.share_of_effect[e];
      if (const int rest = a_.best_part_of(fit, effects[e]); rest >= 0) cause.nats = a_.log_evidence(fit) - a_.log_evidence(rest);
      v_.causes.push_back(cause);
    }
    if (!remainder.share_of_effect.empty()) v_.unexplained = remainder.share;
  }

  // Effects that cannot be seen are as likely as ever, but they are no gap. A tie is where data that speak against none weigh as much.
  void none() {
    constexpr double speaks = 1;  // nats
    const double none = a_.fits.front().log_evidence;
    double against = a_.discrepancy.log_evidence > none + speaks ? v_.probability.at("outside") : 0;
    for (int i = 1; i < static_cast<int>(a_.fits.size()); ++i)
      if (a_.log_evidence(i) > none + speaks) against += v_.probability.at(a_.names[static_cast<std::size_t>(i)]);
    if (against > v_.probability.at("none")) {
      tie(shared_verdict(a_, 0));
      return;
    }
    v_.verdict = all_blind(model_, a_) ? VerdictKind::blind : VerdictKind::none;
    v_.wording = v_.verdict == VerdictKind::blind ? Wording::blind : Wording::no_gap;
  }

  void tie(const std::vector<std::string>& shared) {
    v_.verdict = VerdictKind::tie, v_.wording = Wording::undecided, v_.tie = shared;
    const int best = a_.best_with_effect();
    if (best > 0) v_.effects = effect_names(model_, a_.fits[best]);
  }

  void find_other_names(int first) {
    for (const int k : a_.fits[static_cast<std::size_t>(first)].hypothesis.effects) {
      for (const int other : same_causes(model_, a_, first, k)) {
        const auto of_all = a_.other_name_of.find(k);
        a_.other_name_of[other] = of_all == a_.other_name_of.end() ? k : of_all->second;
        v_.same_as[model_.effects()[k].name].push_back(model_.effects()[other].name);
      }
      find_other_places(k);
    }
  }

  // The data may show that an effect acts in a part only, and not whether from a time on or beyond a plane: one cause at any rate.
  void find_other_places(int k) {
    const Gate* own = model_.gate_of(k);
    if (own == nullptr) return;
    std::vector<std::string>& same = v_.same_as[model_.effects()[k].name];
    for (const auto& [name, local] : a_.local)
      if (local.effect == own->effect && name != model_.effects()[k].name && std::count(same.begin(), same.end(), name) == 0)
        same.push_back(name);
    if (same.empty()) v_.same_as.erase(model_.effects()[k].name);
  }

  void effects(int first) {
    find_other_names(first);
    const int rival = best_predictor(first);
    v_.effects = effect_names(model_, a_.fits[first]);
    // Whether a further effect acts that is too weak to be named does not make the named ones less certain.
    const double p = v_.p_effects = probability_of(a_, v_.effects, v_.same_as);
    if (discrepancy_leads_by_ > 0) {
      tie({a_.names[first], "outside"});
      note_weak_second(first);
    } else if (p < suspected) {
      tie(shared_verdict(a_, first));
    } else if (const int twin = equal_rival(first); twin >= 0) {
      tie({a_.names[first], a_.names[twin]});
    } else if (predicts_better(rival, first) && a_.weight[rival] > a_.weight[first] - nats_of_rule) {
      tie({a_.names[first], a_.names[rival]});
      note_better_predictor(rival, first);
    } else {
      v_.verdict = VerdictKind::effects;
      const bool hold = guards_hold(first) && !(predicts_better(rival, first));
      if (predicts_better(rival, first)) note_better_predictor(rival, first);
      note_alternatives(first);
      v_.wording = p >= attributed && hold && !is_below_rule_ && v_.alternatives.empty() ? Wording::attributed : Wording::suspected;
      note_causes(first);
      note_weak_second(first);
    }
  }

  // Predictions of the few points that are left out scatter more than the evidence does: another leader among them makes a tie where the
  // evidence does not distinguish the two by the nats of the rule, and a doubt where it does.
  bool predicts_better(int rival, int first) const {
    return model_.training().size() > 1 && a_.leave_one_out[rival] > a_.leave_one_out[first] + rankings_differ;
  }

  void note_better_predictor(int rival, int first) {
    v_.notes.push_back("The evidence is for " + a_.names[first] + ", but " + a_.names[rival] +
                       " predicts operating points that were left out better.");
  }

  // To say one cause and not the other takes as many nats as to say a further one.
  void note_alternatives(int first) {
    for (const int other : a_.alternatives_to(first)) {
      v_.alternatives.push_back(a_.names[other]);
      v_.notes.push_back(a_.names[other] + " explains the data nearly as well as " + a_.names[first] + " does: " +
                         rounded(a_.weight[first] - a_.weight[other]) + " nats less, and 6 are wanted to distinguish two causes.");
    }
    note_same_inputs(first);
  }

  // An input that would have to be wrong by more than three standard deviations of its prior is no rival of the effect.
  void note_same_inputs(int first) {
    constexpr double likely = 3;
    const Fit& fit = a_.fits[static_cast<std::size_t>(first)];
    const std::vector<int>& effects = fit.hypothesis.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      const auto same = a_.same_inputs.find(effects[e]);
      if (same == a_.same_inputs.end()) continue;
      for (const auto& [input, sds] : same->second) {
        if (std::abs(fit.theta[static_cast<Eigen::Index>(e)]) / model_.effects()[effects[e]].sd * sds > likely) continue;
        Hypothesis instead{effects};
        instead.effects[e] = input;
        std::sort(instead.effects.begin(), instead.effects.end(),
                  [&](int a, int b) { return model_.effects()[a].name < model_.effects()[b].name; });
        v_.alternatives.push_back(name_of(instead, model_.effects()));
        v_.notes.push_back(model_.effects()[input].name + " has the same signature as " + model_.effects()[effects[e]].name +
                           ": these data do not distinguish the wrong input from the effect.");
      }
    }
  }

  // The rule of 6 nats is stricter than the probabilities.
  void note_weak_second(int first) {
    const auto likeliest =
        std::max_element(v_.probability.begin(), v_.probability.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    std::vector<std::string> acting = split(likeliest->first, '+');
    for (const auto& same : v_.same_as)
      std::erase_if(acting, [&](const std::string& name) { return std::count(same.second.begin(), same.second.end(), name) > 0; });
    const auto acts = [&](const std::string& effect) { return std::count(acting.begin(), acting.end(), effect) > 0; };
    if (acting.size() <= v_.effects.size() || !std::all_of(v_.effects.begin(), v_.effects.end(), acts)) return;
    v_.notes.push_back("Likelier than " + a_.names[first] + " alone (" + number_text(v_.probability.at(a_.names[first])) + ") is " +
                       likeliest->first + " (" + number_text(likeliest->second) +
                       "), but a further effect is named only where it brings 6 nats, or where the set has a probability of " +
                       number_text(likely_alone) + ".");
  }

  // Another hypothesis with as many effects that the data cannot tell from the first; -1 if there is none.
  int equal_rival(int first) const {
    constexpr double equal = 1;  // nats
    for (int i = 0; i < static_cast<int>(a_.fits.size()); ++i) {
      if (a_.causes_of(i) != a_.causes_of(first) && a_.fits[i].hypothesis.effects.size() == a_.fits[first].hypothesis.effects.size() &&
          a_.weight[i] > a_.weight[first] - equal)
        return i;
    }
    return -1;
  }

  // The hypothesis that predicts left-out points best. One that lives on nuisances far outside their priors is no rival: predictions learn
  // shared nuisances from the other points and do not ask how likely they are. Nor is a second effect that the rule of 6 nats refused.
  int best_predictor(int first) const {
    int best = first;
    for (int i = 0; i < static_cast<int>(a_.fits.size()); ++i) {
      const Fit& fit = a_.fits[i];
      const std::vector<int> own = a_.causes_of(first), other = a_.causes_of(i);
      const bool surplus = i != first && std::includes(other.begin(), other.end(), own.begin(), own.end());
      const Eigen::Index bounded = fit.linear.lower.size(), m = static_cast<Eigen::Index>(model_.nuisances().size());
      const Eigen::VectorXd nuisances = (fit.solution.d - fit.linear.prior).segment(bounded, m);
      constexpr double far = 3;
      const bool in_band = m == 0 || nuisances.cwiseAbs().maxCoeff() < far;
      if (!surplus && in_band && a_.leave_one_out[i] > a_.leave_one_out[best]) best = i;
    }
    return best;
  }

  bool guards_hold(int first) {
    bool hold = true;
    const auto all = estimates(model_, a_.fits[first]);
    for (std::size_t e = 0; e < all.size(); ++e) {
      const std::string& name = v_.effects[e];
      if (all[e].absorbing)
        v_.notes.push_back("The strength of " + name + ", " + number_text(all[e].mean) +
                           ", is more than 3 standard deviations from its expected value: it may be compensating for another error."),
            hold = false;
      if (all[e].cochran_p < constancy_limit)
        v_.notes.push_back("The strength of " + name + " differs between operating points (Cochran p = " + number_text(all[e].cochran_p) +
                           ")."),
            hold = false;
    }
    constexpr double working_false_rate = 0.2;
    if (a_.placebo_rate > working_false_rate)
      v_.notes.push_back("Placebo effects would be chosen in " + number_text(100 * a_.placebo_rate) +
                         " % of the cases: the screening cannot distinguish an effect from chance here."),
          hold = false;
    if (const std::size_t n = numbers_of_training(); n <= v_.effects.size())
      v_.notes.push_back("The points of training give " + counted(static_cast<std::int64_t>(n), "independent number") + " for " +
                         counted(static_cast<std::int64_t>(v_.effects.size()), "strength") +
                         ": nearly any effect can be fitted to so few. Measure at further times or points."),
          hold = false;
    return hold;
  }

  // Numbers that differ in point, observable or time; repeats of one are one.
  std::size_t numbers_of_training() const {
    std::set<std::tuple<int, int, double>> all;
    for (const Datum& datum : model_.experiment().data)
      if (!model_.experiment().points[static_cast<std::size_t>(datum.point)].withheld)
        all.emplace(datum.point, datum.observable, std::isnan(datum.time) ? -infinity : datum.time);
    return all.size();
  }

  // An input that is far off is a finding, too, whether or not it is named for the gap.
  void note_inputs(const Fit& fit) {
    constexpr double far = 3;
    const Eigen::VectorXd fitted = fit.solution.d - fit.linear.prior;
    for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
      const std::string name = model_.name_of_nuisance(static_cast<int>(j));
      const double off = v_.nuisances[name] = fitted[fit.linear.lower.size() + static_cast<Eigen::Index>(j)];
      if (std::abs(off) > far)
        v_.notes.push_back("With " + name_of(fit.hypothesis, model_.effects()) + ", " + name + " is fitted " + rounded(std::abs(off)) +
                           " of its standard uncertainties " + (off > 0 ? "above" : "below") + " what is stated: check it.");
    }
  }

  // Of named effects. No effect at all is no end of a range, nor is the whole of a law that takes the place of another.
  void note_ranges(const Fit& fit) {
    constexpr double near = 0.5;  // standard deviations
    for (std::size_t e = 0; e < fit.hypothesis.effects.size(); ++e) {
      const Effect& effect = model_.effects()[fit.hypothesis.effects[e]];
      const double strength = fit.theta[static_cast<Eigen::Index>(e)], sd = fit.theta_sd[static_cast<Eigen::Index>(e)];
      const std::string unit = effect.unit == "1" ? "" : " " + effect.unit;
      for (const double end : {effect.minimum, effect.maximum})
        if (end != 0 && !(effect.is_share && end == effect.maximum) && std::abs(end - strength) < near * sd)
          v_.notes.push_back("The strength of " + effect.name + ", " + rounded(strength) + unit + ", is at the end of its range, " +
                             rounded(end) + unit + ": what lies beyond was not tried.");
    }
  }

  void note_parameters(int fit) {
    if (fit == 0) return;
    const auto all = estimates(model_, a_.fits[fit]);
    const auto names = effect_names(model_, a_.fits[fit]);
    for (std::size_t e = 0; e < all.size(); ++e) v_.parameters[names[e]] = all[e];
  }

  const Responses& model_;
  Attribution& a_;
  Verdict& v_;
  double discrepancy_leads_by_ = 0;  // nats over the likeliest fit
  bool is_below_rule_ = false;       // named for its probability; a further effect of it brings less than 6 nats
};

}  // namespace

int judge(const Responses& model, Attribution& attribution, Verdict& verdict) { return Judge(model, attribution, verdict).judge(); }

void withdraw_what_shrinks_nothing(Verdict& verdict) {
  if (verdict.verdict != VerdictKind::effects || verdict.shrinkage.empty()) return;
  const auto& [name, shrunk] = *verdict.shrinkage.begin();
  if (!(shrunk.mean <= 0)) return;
  verdict.verdict = VerdictKind::tie, verdict.wording = Wording::undecided, verdict.tie = {name, "outside"};
  verdict.causes.clear(), verdict.unexplained = std::numeric_limits<double>::quiet_NaN();
  verdict.notes.push_back("The evidence is for " + name + ", but the gap at the withheld points does not shrink by it: it is not named.");
}

}  // namespace snag
