#include "benchmark/blind/twin.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/parameter_text.hpp"
#include "benchmark/blind/twin_set.hpp"
#include "coupling/fluid_force.hpp"

namespace snag {

namespace {

/// The second functional form of each force that has one.
std::map<std::string, std::string> other_forms(const Truth& truth, NormalNumbers& random) {
  std::map<std::string, std::string> forms;
  const auto known = fluid_forces().names();
  for (const auto& [name, theta] : truth.theta) {
    if (std::find(known.begin(), known.end(), name) == known.end()) continue;
    const auto force = fluid_forces().make(name, "twin");
    for (const Parameter& parameter : force->parameters()) {
      if (parameter.key != "form" || parameter.choices.size() < 2) continue;
      std::vector<std::string> others = parameter.choices;
      std::erase(others, std::get<AnyChoice*>(parameter.target)->word());
      forms[name] =
          "coupling." + name + ".form=\"" + others[static_cast<std::size_t>(random.index(static_cast<int>(others.size())))] + "\"";
    }
  }
  return forms;
}

void draw_strengths(Truth& truth, const std::vector<Effect>& effects, NormalNumbers& random) {
  for (auto& [name, theta] : truth.theta) {
    const auto effect = std::find_if(effects.begin(), effects.end(), [&wanted = name](const Effect& e) { return e.name == wanted; });
    const double sign = effect->minimum < 0 && effect->maximum > 0 && random.uniform() < 0.5 ? -1 : 1;
    theta = std::clamp(sign * theta * effect->mean * (0.8 + 0.4 * random.uniform()), effect->minimum, effect->maximum);
  }
}

std::vector<std::map<std::string, double>> draw_deviations(const TwinSet& set, NormalNumbers& random) {
  std::vector<std::map<std::string, double>> all(set.cases.size());
  const std::vector<TwinInput> inputs = set.inputs();
  const int off = set.truth.kind == "null_off" ? random.index(static_cast<int>(inputs.size())) : -1;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const TwinInput& input = inputs[i];
    const auto draw = [&] { return input.u * (static_cast<int>(i) == off ? (random.uniform() < 0.5 ? -2.5 : 2.5) : random()); };
    const double shared = draw();
    for (auto& point : all) point[input.key] = input.of_each_point() ? draw() : shared;
  }
  return all;
}

/// Base cases go to the set, those of the truth, with another drag law, to a place of their own for as long as they are read.
std::vector<PointCase> write_cases(const TwinSet& set, const std::filesystem::path& folder, const std::string& drag) {
  std::vector<PointCase> cases;
  for (std::size_t p = 0; p < set.experiment.cases.size(); ++p) {
    std::string text = set.experiment.cases[p];
    write_atomically(folder / (std::string("point_") + static_cast<char>('A' + p) + ".toml"), text);
    const std::string law = "schiller_naumann";
    text.replace(text.find(law), law.size(), drag);
    const auto own = std::filesystem::temp_directory_path() / (folder.filename().string() + "-" + std::to_string(getpid()) + ".toml");
    write_atomically(own, text);
    cases.emplace_back(own);
    std::filesystem::remove(own);
  }
  return cases;
}

/// Where the texts of the cases leave the place of the exit open, it is put where the base case passes in good time.
void place_exits(TwinExperiment& experiment) {
  constexpr double share = 0.55;  // of the time that is looked at
  for (std::string& text : experiment.cases) {
    const auto open = text.find(open_exit);
    if (open == std::string::npos) continue;
    std::string anywhere = text;
    anywhere.replace(open, std::string(open_exit).size(), "0");
    const double at =
        run_in_memory(CaseFile::parse(anywhere, "twin", {}), {{experiment.exit_axis, share * experiment.times.back()}}).front();
    text.replace(open, std::string(open_exit).size(), toml_text(at));
  }
}

}  // namespace

Truth make_twin(const TwinPlan& plan, int number, const std::filesystem::path& folder) {
  if (plan.level != "L1" && plan.level != "L2")
    throw Error(ExitCode::usage, "--bench " + plan.level + ": there is no such level; there are L1, L2");
  const bool other_physics = plan.level == "L2";
  std::filesystem::create_directories(folder);
  NormalNumbers random(plan.seed * 7919 + static_cast<std::uint64_t>(number) * 104729 + 17);
  TwinSet set{.twin = plan.twin, .run_seed = plan.seed, .experiment = twin_experiment(plan.twin, random), .truth = {}};
  place_exits(set.experiment);
  set.cases = write_cases(set, folder, other_physics && random.uniform() < 0.5 ? "haider_levenspiel" : "schiller_naumann");
  set.deviations.resize(set.cases.size());
  const std::vector<Effect> effects = showable(set);
  std::vector<std::string> names, of_pairs;
  for (const Effect& effect : effects) {
    names.push_back(effect.name);
    if (!effect.random) of_pairs.push_back(effect.name);  // a diagnosis looks for random ones alone
  }
  set.truth = planned_set(number, plan.seed, names, of_pairs, unmodelled_truths(plan.twin), set.experiment.subsets);
  for (const Effect& effect : effects)
    if (effect.random && set.truth.theta.contains(effect.name)) set.random.insert(effect.name);
  draw_strengths(set.truth, effects, random);
  if (other_physics) {
    set.forms = other_forms(set.truth, random);
    set.picture_centre = {0.02 * random(), 0, 0.02 * random()};
  }
  set.unmodelled = unmodelled_truth(set.truth.unmodelled, set.truth.strength, set.experiment, random);
  set.deviations = draw_deviations(set, random);
  if (!set.truth.theta.empty() || set.unmodelled.acts()) measure_gap(set);
  write_atomically(folder / "DIAGNOSIS.toml", twin_diagnosis(set, 1 + random.index(1000000)));
  write_atomically(folder / "data.csv", twin_data(set, random));
  return set.truth;
}

}  // namespace snag
