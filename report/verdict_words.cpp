#include "report/verdict_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/words.hpp"

namespace snag {

namespace {

std::string strength_in_words(const Verdict& v, const std::string& name) {
  const auto found = v.parameters.find(name);
  if (found == v.parameters.end() || found->second.sd == 0) return "";
  const EffectEstimate& e = found->second;
  return " = " + rounded(e.mean) + " ± " + rounded(e.sd) + (e.unit == "1" ? "" : " " + e.unit);
}

/// The strength of an effect in the improved case, and the estimate in brackets if the two differ.
std::string strength_in_case(const Verdict& v, const std::string& name) {
  constexpr double negligible = 0.1;  // standard deviations
  const auto found = v.parameters.find(name);
  if (found == v.parameters.end() || found->second.sd == 0 || v.improved.runs.empty()) return strength_in_words(v, name);
  const auto& effects = v.improved.runs.front().effects;
  const auto there = effects.find(name);
  const EffectEstimate& e = found->second;
  if (there == effects.end() || std::abs(there->second - e.mean) <= negligible * e.sd) return strength_in_words(v, name);
  return " = " + rounded(there->second) + (e.unit == "1" ? "" : " " + e.unit) + " (estimate" + strength_in_words(v, name).substr(2) + ")";
}

/// Of causes whose strength says more than their name: before and after it.
struct Words {
  const char *before, *after;
};
const std::map<std::string, Words> words_of_cause{
    {"swirl", {"swirl: the water swirls by ", " of its mean speed at the wall of the pipe"}},
    {"flow_profile", {"flow_profile: the speed on the axis of the pipe is larger by ", " of the mean speed at the same flow rate"}},
    {"bend_vortices", {"bend_vortices: the bend makes the water on the axis flow outwards by ", " of its mean speed"}},
    {"start_offset", {"start_offset: the pieces start nearer the inside of the bend by ", ""}}};

/// "lift", or "lift from 0.21 ± 0.01 s on".
std::string cause_in_words(const Verdict& v, const std::string& name) {
  const auto found = v.local.find(name);
  if (found == v.local.end()) {
    const auto words = words_of_cause.find(name);
    const std::string strength = words == words_of_cause.end() ? "" : strength_in_words(v, name);
    return strength.empty() ? name : words->second.before + strength.substr(std::string(" = ").size()) + words->second.after;
  }
  const LocalCause& local = found->second;
  const std::string place = rounded(local.mean) + " ± " + rounded(local.sd) + " " + local.unit;
  if (local.coordinate == "t") return local.effect + " from " + place + " on";
  return local.effect + " where " + local.coordinate + " is " + (local.is_upwards ? "above " : "below ") + place;
}

/// What to correct of data or inputs where the named cause is a mistake of theirs; empty: it is an effect of the model.
std::string correction(const Verdict& v, const std::string& name) {
  const std::string kind = name.substr(0, name.find(':')), of = name.find(':') == std::string::npos ? "" : name.substr(kind.size() + 1);
  const std::string strength = strength_in_words(v, name);
  if (kind == "unit") return "Correct the unit of the data that are stated in " + of + ".";
  if (kind == "sign") return "Turn round the sign of the axis " + of + " of the data.";
  if (kind == "clock") return "Correct the clock of the data: theta" + strength + ".";
  if (kind == "frame_rate") return "Correct the frame rate of the data: relative error" + strength + ".";
  if (kind == "scale") return "Calibrate the points " + of + " again: relative error" + strength + ".";
  if (kind == "offset") return "Calibrate " + of + " again: offset" + strength + ".";
  if (kind == "input") {
    const std::size_t at = of.find('@');
    const std::string where = at == std::string::npos ? "" : " at " + of.substr(at + 1);
    return "Look up or measure " + of.substr(0, at) + where + " again: relative error of the case's value" + strength + ".";
  }
  if (kind == "measurement") return "Calibrate the camera again: relative error of its scale" + strength + ".";
  return "";
}

/// Where to look for a cause outside the library: the training cell whose mean differs most over its uncertainty; where no mean differs,
/// the cell with the largest score. (With the inputs fitted, a point that is wrong by itself moves the others, and their scores.)
const GapCell* largest_gap(const Verdict& v) {
  constexpr double differs = 3;
  const GapCell *by_mean = nullptr, *by_score = nullptr;
  for (const GapCell& cell : v.where) {
    if (cell.withheld || cell.point == all_points) continue;
    if (std::abs(cell.z) > (by_mean ? std::abs(by_mean->z) : differs)) by_mean = &cell;
    if (!by_score || std::abs(cell.score) > std::abs(by_score->score)) by_score = &cell;
  }
  return by_mean ? by_mean : by_score;
}

}  // namespace

std::string share_in_words(double share) {
  if (std::isnan(share)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 && share > 0 ? "%.1f %%" : "%.0f %%", 100 * share);
  return text;
}

std::string probability_in_words(double p) {
  constexpr double nearly_one = 0.99;
  return p > nearly_one ? "over 99 %" : p < 1 - nearly_one ? "below 1 %" : share_in_words(p);
}

std::string window_in_words(const GapCell& cell) {
  return std::isnan(cell.window[0]) ? "whole run" : number_text(cell.window[0]) + " to " + number_text(cell.window[1]) + " s";
}

std::string condition_in_words(const NewCondition& condition) {
  return "point " + condition.point + " with " + condition.input + (condition.factor < 1 ? " halved" : " doubled");
}

std::string verdict_sentence(const Verdict& v) {
  if (v.verdict == VerdictKind::none) return "No gap beyond the uncertainty: no effect is missing that these data could show.";
  if (v.verdict == VerdictKind::outside)
    return "There is a gap, and no effect of the library explains it." +
           (v.effects.empty() ? "" : " In part, " + joined(v.effects) + " would.");
  if (v.verdict == VerdictKind::blind) return "These data are blind: no effect of the library would show in them.";
  if (v.verdict == VerdictKind::tie) return "A tie: the data do not decide between " + joined(v.tie) + ".";
  // The page states shares only where there are at least two: of several effects, or of one effect and the unexplained rest.
  std::string causes;
  const bool has_shares = v.causes.size() > 1 || v.unexplained > 0;
  for (std::size_t i = 0; i < v.effects.size(); ++i) {
    causes += (i > 0 ? ", " : "") + cause_in_words(v, v.effects[i]);
    if (const auto other = v.same_as.find(v.effects[i]); other != v.same_as.end())
      causes += " (or " + joined(other->second) + ", which does the same here)";
    constexpr double least_share = 0.005;
    if (has_shares && i < v.causes.size() && v.causes[i].share >= least_share)
      causes += " (" + share_in_words(v.causes[i].share) + " of it)";
  }
  const std::string rest = v.unexplained > 0 ? "; " + share_in_words(v.unexplained) + " of it stays unexplained" : "";
  const bool doubted = v.wording == Wording::suspected && v.p_effects >= 0.9;
  return "The gap comes from " + causes + rest + ": " + word(v.wording) +
         (!v.alternatives.empty() ? ", for " + joined(v.alternatives) + " would explain it nearly as well."
          : doubted               ? ", for a check of the verdict failed (see The evidence)."
                                  : ", probability " + probability_in_words(v.p_effects) + ".");
}

std::string verdict_advice(const Verdict& v) {
  if (v.verdict == VerdictKind::none) return "Leave the case as it is.";
  if (v.verdict == VerdictKind::blind) return "Change nothing by these data: measure where the effects show (What to measure next).";
  if (v.verdict == VerdictKind::tie) {
    const auto& conditions = v.identifiability.new_conditions;
    if (conditions.empty()) return "Change nothing yet. " + v.identifiability.next_experiment;
    return "Change nothing yet. Measure " + conditions.front().observable + " at " + condition_in_words(conditions.front()) +
           ": one test there is expected to distinguish the two most probable causes by " + rounded(conditions.front().nats) +
           " nats; 6 are wanted.";
  }
  const GapCell* largest = largest_gap(v);
  if (v.verdict == VerdictKind::outside)
    return std::string("Do not tune the case to these data: no strength of an effect is right.") +
           (largest == nullptr ? ""
                               : " Look for the cause where the gap is largest: " + largest->observable + " at " + largest->point + ", " +
                                     window_in_words(*largest) + ".");
  std::string text;
  std::vector<std::string> held;
  for (const std::string& name : v.effects) {
    const std::string one = correction(v, name);
    if (one.empty())
      held.push_back(name + strength_in_case(v, name));
    else
      text += (text.empty() ? "" : " ") + one;
  }
  if (v.improved.files.empty()) return text;
  constexpr double negligible = 1;  // standard uncertainties
  const bool is_fit = v.improved.off_by_forms <= negligible;
  const std::string go_on = v.wording != Wording::attributed ? "Check the cause first; then go on with "
                            : is_fit                         ? "Go on with "
                                                             : "Begin with ";
  text += (text.empty() ? "" : " ") + go_on + v.improved.files.front() +
          (v.improved.files.size() > 1 ? " (and the files of the other points)" : "") +
          (held.empty() ? ", where it is as fitted." : "; it contains " + joined(held) + ".");
  if (!is_fit)
    text += " The fit combines several forms of a law, and a case can use one only: its run differs from the fit by up to " +
            rounded(v.improved.off_by_forms) + " standard uncertainties, so adjust the strength there.";
  return text;
}

std::string effects_in_words(const Verdict& v) {
  std::string effects;
  for (const std::string& effect : v.effects) effects += (effects.empty() ? "" : " and ") + effect;
  return effects;
}

std::vector<std::string> names_of(const Verdict& v) {
  switch (v.verdict) {
    case VerdictKind::effects:
      return v.effects;
    case VerdictKind::outside:
      return {"outside"};
    case VerdictKind::tie: {
      std::vector<std::string> all;
      for (const std::string& hypothesis : v.tie)
        for (const std::string& name : split(hypothesis, '+')) all.push_back(name);
      return all;
    }
    case VerdictKind::none:
    case VerdictKind::blind:
      break;
  }
  return {"none"};
}

}  // namespace snag
