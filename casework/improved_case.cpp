#include "casework/improved_case.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "base/atomic_file.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

const std::string stem = "case_with_effects";

/// Of each point: letters, digits and - of its name stay; two points never share a file.
std::vector<std::string> files_of(const Experiment& experiment) {
  if (experiment.points.size() == 1) return {stem + ".toml"};
  std::set<std::string> taken;
  std::vector<std::string> files;
  for (const OperatingPoint& point : experiment.points) {
    std::string name = stem + "_";
    for (const char c : point.id) name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
    while (!taken.insert(name).second) name += "_";
    files.push_back(name + ".toml");
  }
  return files;
}

std::string why_none(const Verdict& verdict) {
  if (verdict.verdict == VerdictKind::none || verdict.verdict == VerdictKind::blind)
    return "The verdict names no cause, so the case stays as it is.";
  if (verdict.verdict == VerdictKind::tie) return "The data do not decide between the causes, so no case with one of them is written.";
  return "No effect of the library explains the gap, so there is no improved case.";
}

/// The named effects that change the case of this run; the others are of the measurement.
std::vector<std::string> effects_of_case(const CaseSimulator& simulator, const RunRequest& run) {
  std::vector<std::string> names;
  RunRequest one = run;
  one.effects.clear();
  const std::vector<std::string> without = simulator.change_of(one).overrides;
  for (const auto& [name, strength] : run.effects) {
    one.effects = {{name, strength}};
    if (simulator.change_of(one).overrides != without) names.push_back(name);
  }
  return names;
}

std::string with_sign(double value) { return (value > 0 ? "+" : "") + number_text(value); }

std::string heading(const CaseSimulator& simulator, const OperatingPoint& point, const Verdict& verdict, const RunRequest& run,
                    const std::vector<std::string>& of_case) {
  std::string text = "# Point " + point.id + " of the diagnosis \"" + verdict.name + "\" (" + word(verdict.wording) +
                     "): " + point.case_file.filename().string() + " with what the verdict adds.\n";
  for (const std::string& name : of_case) {
    const auto fitted = verdict.parameters.find(name);
    text += "#   " + name + ": strength " + number_text(run.effects.at(name));
    if (fitted != verdict.parameters.end() && fitted->second.sd > 0) text += ", standard deviation " + number_text(fitted->second.sd);
    text += "\n";
  }
  for (const auto& [name, deviation] : run.nuisances)
    if (simulator.is_of_case(name))
      text += "#   input " + name + " as fitted: " + with_sign(100 * deviation) + " % from the stated value\n";
  text += "# Keys that differ from the base case:\n";
  for (const std::string& key : simulator.change_of(run).overrides) text += "#   " + key + "\n";
  if (verdict.improved.off_by_forms > 0)
    text += "# The verdict mixes forms of a law. This case has one form, the nearest. Its run differs from the mixture by at most " +
            rounded(verdict.improved.off_by_forms) + " standard uncertainties of the data.\n";
  return text;
}

}  // namespace

std::vector<ImprovedCase> improved_cases(CaseSimulator& simulator, const Experiment& experiment, Verdict& verdict) {
  ImprovedModel& improved = verdict.improved;
  if (improved.runs.empty()) {
    improved.why_none = why_none(verdict);
    return {};
  }
  if (std::any_of(improved.runs.begin(), improved.runs.end(), [](const RunRequest& run) { return run.gate.has_value(); })) {
    improved.why_none = "The cause acts in a part only, which a case cannot say.";
    return {};
  }
  const bool names_input =
      std::any_of(verdict.effects.begin(), verdict.effects.end(), [](const std::string& name) { return name.starts_with("input:"); });
  std::vector<ImprovedCase> cases;
  const std::vector<std::string> files = files_of(experiment);
  for (const RunRequest& run : improved.runs) {
    const OperatingPoint& point = experiment.points[static_cast<std::size_t>(run.point)];
    const std::vector<std::string> of_case = effects_of_case(simulator, run);
    if (of_case.empty() && !names_input) continue;
    const std::string& file = files[static_cast<std::size_t>(run.point)];
    cases.push_back({file, heading(simulator, point, verdict, run, of_case) + simulator.resolved_case(run)});
    improved.files.push_back(file);
  }
  if (cases.empty())
    improved.why_none = "What the verdict names is a mistake of the measurement: correct the data; the case stays as it is.";
  return cases;
}

void write_improved_cases(const std::filesystem::path& folder, const Experiment& experiment, const std::vector<ImprovedCase>& cases) {
  for (const std::string& file : files_of(experiment)) std::filesystem::remove(folder / file);
  for (const ImprovedCase& one : cases) write_atomically(folder / one.file, one.text);
}

}  // namespace snag
