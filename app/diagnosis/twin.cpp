#include "app/diagnosis/twin.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/diagnosis/case_run.hpp"
#include "app/diagnosis/point_case.hpp"
#include "app/diagnosis/twin_points.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/parameter_text.hpp"
#include "base/words.hpp"
#include "coupling/fluid_force.hpp"
#include "diagnosis/bench/detectability.hpp"

namespace snag {

namespace {

constexpr int n_withheld = 3;
const std::vector<std::string> outside_forces{"periodic", "stratified", "gust"};

/// A relative deviation of an input, by point; what is not set-point of the flow is the same at all.
using Deviations = std::vector<std::map<std::string, double>>;

struct Input {
  std::string key;
  double u = 0;
  bool of_each_point() const { return key.starts_with("flow.amplitude"); }
};

Input input_of(const std::string& line) {
  const auto parts = split(line, '=');
  return {parts[0].substr(1, parts[0].rfind('"') - 1), std::stod(parts[1])};
}

/// What makes a set true: more than a diagnosis will know.
struct Making {
  const TwinPlan& plan;
  TwinExperiment experiment;
  Truth truth;
  std::vector<PointCase> cases;              // of the truth: with its own drag law
  std::map<std::string, std::string> forms;  // by effect: values of keys that choose the other functional forms
  Deviations deviations;
  Vec3 picture_centre;  // about which the camera's scale is wrong
  OutsideForce outside;
};

std::vector<Asked> asked_of(const Making& m) {
  std::vector<Asked> asked;
  for (const TwinInstrument& instrument : m.experiment.instruments) {
    if (!in_subset(m.truth.subset, instrument.id)) continue;
    if (instrument.id == "retention_time")
      asked.push_back({instrument.id});
    else
      for (const double time : m.experiment.times) asked.push_back({instrument.id, time});
  }
  return asked;
}

const TwinInstrument& instrument_of(const Making& m, const std::string& id) {
  return *std::find_if(m.experiment.instruments.begin(), m.experiment.instruments.end(), [&](const auto& i) { return i.id == id; });
}

/// Values without noise at a point with these effects in the form of the truth, and a force of no effect.
std::vector<double> run_with(const Making& m, const std::map<std::string, double>& theta, const OutsideForce& outside, std::size_t point,
                             const std::vector<Asked>& asked, const std::map<std::string, double>& deviations) {
  CaseChange change = m.cases[point].change(theta, deviations, m.plan.seed);
  for (const auto& [name, form] : m.forms)
    if (theta.contains(name)) change.overrides.push_back(form);
  std::vector<double> values = run_for(m.cases[point].with(change.overrides), asked, 0.5, outside);
  const double s = change.picture_scale;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string& id = asked[i].observable;
    if (id == "x" || id == "y" || id == "z") {
      const double c = m.picture_centre[id[0] - 'x'];
      values[i] = c + s * (values[i] - c);
    }
    if (id.starts_with("v")) values[i] *= s;
    if (id == "area") values[i] *= s * s;
  }
  return values;
}

/// `acts`: with what the truth adds.
std::vector<double> run_of(const Making& m, std::size_t point, const std::vector<Asked>& asked, bool acts,
                           const std::map<std::string, double>& deviations) {
  return acts ? run_with(m, m.truth.theta, m.outside, point, asked, deviations) : run_with(m, {}, {}, point, asked, deviations);
}

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
      std::erase(others, *std::get<std::string*>(parameter.target));
      forms[name] =
          "coupling." + name + ".form=\"" + others[static_cast<std::size_t>(random.index(static_cast<int>(others.size())))] + "\"";
    }
  }
  return forms;
}

OutsideForce outside_of(const Truth& truth, NormalNumbers& random, double end) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  if (truth.outside == "periodic") {
    const double a = truth.strength * between(0.5, 1.5), omega = between(15, 40), phase = between(0, 6);
    const Vec3 direction = unit(Vec3{between(-1, 1), between(-0.3, 0.3), between(-1, 1)});
    return [=](double t, const Vec3&) { return a * std::sin(omega * t + phase) * direction; };
  }
  if (truth.outside == "stratified") {
    const double rate = truth.strength * between(10, 30);  // N^2, 1/s2
    return [=](double, const Vec3& x) { return Vec3{0, 0, -rate * x.z}; };
  }
  if (truth.outside == "gust") {
    const double a = truth.strength * between(1, 3), begin = between(0.2, 0.5) * end, length = between(0.1, 0.2) * end;
    const Vec3 direction = unit(Vec3{between(-1, 1), 0, between(-1, 1)});
    return [=](double t, const Vec3&) { return t > begin && t < begin + length ? a * direction : Vec3{}; };
  }
  return {};
}

/// What the base cases can show at all, but for random effects: those are compared by their spread, which replicates of this twin lack.
std::vector<Effect> showable(const std::vector<PointCase>& cases) {
  BaseCase facts = cases.front().facts();
  for (const PointCase& one : cases) {
    facts.wall |= one.facts().wall, facts.gradient |= one.facts().gradient, facts.varies |= one.facts().varies;
    facts.uniform |= one.facts().uniform;
  }
  std::vector<Effect> effects = library_effects(facts, cases.front().forces());
  std::erase_if(effects, [](const Effect& e) { return !e.blind.empty() || e.random; });
  return effects;
}

void draw_strengths(Truth& truth, const std::vector<Effect>& effects, NormalNumbers& random) {
  for (auto& [name, theta] : truth.theta) {
    const auto effect = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name; });
    const double sign = effect->minimum < 0 && effect->maximum > 0 && random.uniform() < 0.5 ? -1 : 1;
    theta = std::clamp(sign * theta * effect->mean * (0.8 + 0.4 * random.uniform()), effect->minimum, effect->maximum);
  }
}

Deviations draw_deviations(const Making& m, NormalNumbers& random) {
  Deviations all(m.cases.size());
  const int off = m.truth.kind == "null_off" ? random.index(static_cast<int>(m.experiment.inputs.size())) : -1;
  for (std::size_t i = 0; i < m.experiment.inputs.size(); ++i) {
    const Input input = input_of(m.experiment.inputs[i]);
    const auto draw = [&] { return input.u * (static_cast<int>(i) == off ? (random.uniform() < 0.5 ? -2.5 : 2.5) : random()); };
    const double shared = draw();
    for (auto& point : all) point[input.key] = input.of_each_point() ? draw() : shared;
  }
  return all;
}

/// What is left of the weaker of two effects when the other one may have any strength: a set whose second effect cannot be seen cannot be
/// told.
double weaker_of_pair(const Making& m, const std::vector<Asked>& asked, const std::vector<double>& variance,
                      const std::vector<std::vector<double>>& columns) {
  std::vector<std::vector<double>> alone;  // what each adds to the other
  for (const auto& [name, theta] : m.truth.theta) {
    auto without = m.truth.theta;
    without.erase(name);
    alone.emplace_back();
    for (std::size_t p = 0; p + n_withheld < m.cases.size(); ++p) {
      const auto both = run_of(m, p, asked, true, m.deviations[p]), other = run_with(m, without, m.outside, p, asked, m.deviations[p]);
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const bool lognormal = instrument_of(m, asked[i].observable).kind == "lognormal";
        const double change = lognormal ? std::log(both[i] / other[i]) : both[i] - other[i];
        alone.back().push_back(std::isfinite(change) ? change : 0);
      }
    }
  }
  double weaker = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < alone.size(); ++e) {
    auto free = columns;
    constexpr double any_strength = 100;
    for (std::size_t other = 0; other < alone.size(); ++other) {
      if (other == e) continue;
      free.push_back(alone[other]);
      for (double& value : free.back()) value *= any_strength;
    }
    weaker = std::min(weaker, signal_size(alone[e], variance, free).detectability);
  }
  return weaker;
}

/// Signal over uncertainty of what acts, over the training points.
void measure_gap(Making& m, const std::vector<Asked>& asked) {
  const std::size_t n_points = m.cases.size() - n_withheld, n = asked.size();
  std::vector<double> signal, variance;
  std::vector<std::vector<double>> columns;
  std::vector<Input> inputs;
  for (const std::string& line : m.experiment.inputs) inputs.push_back(input_of(line));
  const std::size_t rows = n_points * n;
  std::map<std::string, std::vector<double>> shared;
  for (std::size_t p = 0; p < n_points; ++p) {
    const auto with = run_of(m, p, asked, true, m.deviations[p]), without = run_of(m, p, asked, false, m.deviations[p]);
    for (std::size_t i = 0; i < n; ++i) {
      const TwinInstrument& instrument = instrument_of(m, asked[i].observable);
      const bool lognormal = instrument.kind == "lognormal", told = std::isfinite(with[i]) && std::isfinite(without[i]);
      signal.push_back(!told ? 0 : lognormal ? std::log(with[i] / without[i]) : with[i] - without[i]);
      variance.push_back(instrument.noise_u * instrument.noise_u / m.truth.replicates);
    }
    for (const Input& input : inputs) {
      const auto moved = run_of(m, p, asked, false, {{input.key, input.u}}), base = run_of(m, p, asked, false, {});
      auto& column = shared[input.of_each_point() ? input.key + std::to_string(p) : input.key];
      column.resize(rows, 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        const bool lognormal = instrument_of(m, asked[i].observable).kind == "lognormal";
        const double change = lognormal ? std::log(moved[i] / base[i]) : moved[i] - base[i];
        column[p * n + i] = std::isfinite(change) ? change : 0;
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      const TwinInstrument& instrument = instrument_of(m, asked[i].observable);
      if (instrument.bias_u <= 0) continue;
      auto& column = shared["bias " + instrument.group];
      column.resize(rows, 0.0);
      column[p * n + i] = instrument.bias_u;
    }
  }
  for (auto& [name, column] : shared) columns.push_back(std::move(column));
  SignalSize size = signal_size(signal, variance, columns);
  if (m.truth.theta.size() > 1) size.detectability = weaker_of_pair(m, asked, variance, columns);
  m.truth.detectability = size.detectability, m.truth.gap_over_floor = size.gap_over_floor;
}

/// Nothing in it tells the number of the set, and with it what is in it.
std::string diagnosis_text(const Making& m, int seed) {
  std::string text = "[experiment]\nname = \"" + m.plan.twin + " twin\"\ndata = \"data.csv\"\n";
  for (const TwinInstrument& i : m.experiment.instruments) {
    if (!in_subset(m.truth.subset, i.id)) continue;
    text += "[[observable]]\nid = \"" + i.id + "\"\nunit = \"" + i.unit + "\"\nkind = \"" + i.kind +
            "\"\nnoise_u = " + toml_text(i.noise_u) + "\n";
    if (i.bias_u > 0) text += "bias_u = " + toml_text(i.bias_u) + "\ncalibration_group = \"" + i.group + "\"\n";
  }
  for (std::size_t p = 0; p < m.cases.size(); ++p) {
    const std::string id(1, static_cast<char>('A' + p));
    text += "[[point]]\nid = \"" + id + "\"\ncase = \"point_" + id + ".toml\"\nrole = \"" +
            (p + n_withheld < m.cases.size() ? "train" : "withheld") + "\"\ninput_u = { " + joined(m.experiment.inputs) + " }\n";
  }
  return text + "[budget]\nseed = " + std::to_string(seed) + "\n";
}

std::string data_text(const Making& m, const std::vector<Asked>& asked, NormalNumbers& random) {
  std::string text = "point,replicate,t_s,observable,value,censored\n";
  std::map<std::string, double> bias;
  for (const TwinInstrument& instrument : m.experiment.instruments)
    if (instrument.bias_u > 0 && !bias.contains(instrument.group)) bias[instrument.group] = random();
  for (std::size_t p = 0; p < m.cases.size(); ++p) {
    const auto exact = run_of(m, p, asked, true, m.deviations[p]);
    for (int replicate = 1; replicate <= m.truth.replicates; ++replicate)
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const TwinInstrument& instrument = instrument_of(m, asked[i].observable);
        double value = exact[i];
        const bool censored = !std::isfinite(value);
        const double error = instrument.noise_u * random();
        if (censored)
          value = m.experiment.times.back();
        else if (instrument.kind == "lognormal")
          value *= std::exp(error);
        else
          value += error + (instrument.bias_u > 0 ? instrument.bias_u * bias[instrument.group] : 0);
        text += std::string(1, static_cast<char>('A' + p)) + "," + std::to_string(replicate) + "," +
                (std::isnan(asked[i].time) ? "" : toml_text(asked[i].time)) + "," + asked[i].observable + "," + toml_text(value) + "," +
                (censored ? "1" : "0") + "\n";
      }
  }
  return text;
}

/// Base cases go to the set, those of the truth, with another drag law, to a place of their own for as long as they are read.
std::vector<PointCase> write_cases(const Making& m, const std::filesystem::path& folder, const std::string& drag) {
  std::vector<PointCase> cases;
  for (std::size_t p = 0; p < m.experiment.cases.size(); ++p) {
    std::string text = m.experiment.cases[p];
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

}  // namespace

Truth make_twin(const TwinPlan& plan, int number, const std::filesystem::path& folder) {
  if (plan.level != "L1" && plan.level != "L2")
    throw Error(ExitCode::usage, "--bench " + plan.level + ": there is no such level; there are L1, L2");
  const bool other_physics = plan.level == "L2";
  std::filesystem::create_directories(folder);
  NormalNumbers random(plan.seed * 7919 + static_cast<std::uint64_t>(number) * 104729 + 17);
  Making m{plan, twin_experiment(plan.twin, random), {}, {}, {}, {}, {}, {}};
  m.cases = write_cases(m, folder, other_physics && random.uniform() < 0.5 ? "haider_levenspiel" : "schiller_naumann");
  const std::vector<Effect> effects = showable(m.cases);
  std::vector<std::string> names;
  for (const Effect& effect : effects) names.push_back(effect.name);
  m.truth = planned_set(number, plan.seed, names, outside_forces, m.experiment.subsets);
  draw_strengths(m.truth, effects, random);
  if (other_physics) {
    m.forms = other_forms(m.truth, random);
    m.picture_centre = {0.02 * random(), 0, 0.02 * random()};
  }
  m.outside = outside_of(m.truth, random, m.experiment.times.back());
  m.deviations = draw_deviations(m, random);
  const std::vector<Asked> asked = asked_of(m);
  if (!m.truth.theta.empty() || m.outside) measure_gap(m, asked);
  write_atomically(folder / "DIAGNOSIS.toml", diagnosis_text(m, 1 + random.index(1000000)));
  write_atomically(folder / "data.csv", data_text(m, asked, random));
  return m.truth;
}

}  // namespace snag
