#include "benchmark/blind/twin_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parameter_text.hpp"
#include "base/random_numbers.hpp"
#include "base/words.hpp"
#include "diagnosis/data/summary.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

/// What the camera makes of a value: its scale about a centre, then pixels that are not square (x broader, z lower).
double pictured(const std::string& id, double value, double scale, double ratio, const Vec3& centre) {
  const std::array stretch{scale * std::sqrt(ratio), scale, scale * (1 / std::sqrt(ratio))};
  const ObservableRecord& record = *find_observable(id);
  switch (record.measure) {
    case Measure::position:
      return centre[record.axis] + stretch[static_cast<std::size_t>(record.axis)] * (value - centre[record.axis]);
    case Measure::velocity:
      return stretch[static_cast<std::size_t>(record.axis)] * value;
    case Measure::area:
      return scale * scale * value;
    case Measure::axis_angle:
      return std::remainder(std::atan2(stretch[2] * std::sin(value), stretch[0] * std::cos(value)), record.period());
    default:
      return value;
  }
}

}  // namespace

std::vector<TwinInput> TwinSet::inputs() const {
  std::vector<TwinInput> all;
  for (const std::string& line : experiment.inputs) {
    const auto parts = split(line, '=');
    all.push_back({parts[0].substr(1, parts[0].rfind('"') - 1), std::stod(parts[1])});
  }
  return all;
}

std::vector<ObservableRequest> TwinSet::asked(const std::string& subset) const {
  std::vector<ObservableRequest> all;
  for (const TwinInstrument& one : experiment.instruments) {
    if (!in_subset(subset, one.id)) continue;
    if (find_observable(one.id)->is_of_whole_run())
      all.push_back({one.id});
    else
      for (const double time : experiment.times) all.push_back({one.id, time});
  }
  return all;
}

const TwinInstrument& TwinSet::instrument(const std::string& id) const {
  return *std::find_if(experiment.instruments.begin(), experiment.instruments.end(), [&](const auto& i) { return i.id == id; });
}

std::vector<double> TwinSet::values(std::size_t point, const std::vector<ObservableRequest>& asked,
                                    const std::map<std::string, double>& theta, bool unmodelled_acts,
                                    const std::map<std::string, double>& input_deviations, int replicate) const {
  CaseChange change = cases[point].change(theta, input_deviations, mixed(mixed(run_seed) + static_cast<std::uint64_t>(replicate)));
  for (const auto& [name, form] : forms)
    if (theta.contains(name)) change.overrides.push_back(form);
  change.overrides.push_back(cases[point].with_step_factor(0.5));
  std::vector<double> values =
      run_in_memory(cases[point].with(change.overrides), asked, unmodelled_acts ? unmodelled.force : UnmodelledForce{});
  const double ratio = unmodelled_acts ? unmodelled.pixel_ratio : 1;
  for (std::size_t i = 0; i < asked.size(); ++i)
    values[i] = pictured(asked[i].observable, values[i], change.picture_scale, ratio, picture_centre);
  return values;
}

double TwinSet::difference(const std::string& observable, double with, double without) const {
  const std::string& kind = instrument(observable).kind;
  const double change = kind == "lognormal" ? std::log(with / without)
                        : kind == "angle"   ? wrapped(with - without, std::numbers::pi)  // an axis has no head
                                            : with - without;
  return std::isfinite(change) ? change : 0;
}

std::string twin_diagnosis(const TwinSet& set, int seed) {
  std::string text = "[experiment]\nname = \"" + set.twin + " twin\"\ndata = \"data.csv\"\n";
  for (const TwinInstrument& i : set.experiment.instruments) {
    if (!in_subset(set.truth.subset, i.id)) continue;
    text += "[[observable]]\nid = \"" + i.id + "\"\nunit = \"" + i.unit + "\"\nkind = \"" + i.kind +
            "\"\nnoise_u = " + toml_text(i.noise_u) + "\n";
    if (i.bias_u > 0) text += "bias_u = " + toml_text(i.bias_u) + "\ncalibration_group = \"" + i.group + "\"\n";
  }
  for (std::size_t p = 0; p < set.cases.size(); ++p) {
    const std::string id(1, static_cast<char>('A' + p));
    text += "[[point]]\nid = \"" + id + "\"\ncase = \"point_" + id + ".toml\"\nrole = \"" + (p < set.n_training() ? "train" : "withheld") +
            "\"\ninput_u = { " + joined(set.experiment.inputs) + " }\n";
  }
  return text + "[budget]\nseed = " + std::to_string(seed) + "\n";
}

std::string twin_data(const TwinSet& set, NormalNumbers& random) {
  const std::vector<ObservableRequest> asked = set.asked();
  std::string text = "point,replicate,t_s,observable,value,censored\n";
  std::map<std::string, double> bias;
  for (const TwinInstrument& instrument : set.experiment.instruments)
    if (instrument.bias_u > 0 && !bias.contains(instrument.group)) bias[instrument.group] = random();
  for (std::size_t p = 0; p < set.cases.size(); ++p) {
    auto exact = set.true_values(p, asked);
    for (int replicate = 1; replicate <= set.truth.replicates; ++replicate) {
      // Another one at every point, too.
      if (!set.random.empty()) exact = set.true_values(p, asked, static_cast<int>(p) * set.truth.replicates + replicate);
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const TwinInstrument& instrument = set.instrument(asked[i].observable);
        double value = exact[i];
        const bool censored = !std::isfinite(value);
        const double error = instrument.noise_u * random();
        if (censored)
          value = set.experiment.times.back();
        else if (instrument.kind == "lognormal")
          value *= std::exp(error);
        else
          value += error + (instrument.bias_u > 0 ? instrument.bias_u * bias[instrument.group] : 0);
        text += std::string(1, static_cast<char>('A' + p)) + "," + std::to_string(replicate) + "," +
                (std::isnan(asked[i].time) ? "" : toml_text(asked[i].time)) + "," + asked[i].observable + "," + toml_text(value) + "," +
                (censored ? "1" : "0") + "\n";
      }
    }
  }
  return text;
}

}  // namespace snag
