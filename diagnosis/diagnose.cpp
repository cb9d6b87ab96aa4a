#include "diagnosis/diagnose.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "base/error.hpp"
#include "base/words.hpp"

#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/attribution/restart.hpp"
#include "diagnosis/data/noise.hpp"
#include "diagnosis/judgement/curves.hpp"
#include "diagnosis/judgement/how_far.hpp"
#include "diagnosis/judgement/judgement.hpp"
#include "diagnosis/judgement/next_experiment.hpp"
#include "diagnosis/localisation/where.hpp"

namespace snag {

namespace {

// Runs without which nothing can be said: the base model with two seeds and another step, its derivatives, and each effect once a point.
void check_budget(const Experiment& experiment, const Simulator& simulator) {
  const int points = static_cast<int>(experiment.points.size());
  int training = 0, needed = 2 * points;
  for (const OperatingPoint& point : experiment.points) training += !point.withheld;
  std::set<std::tuple<std::string, double, int>> moved;  // what is common and what is a point's own of one input take the same runs
  for (const Nuisance& nuisance : simulator.nuisances())
    for (const int p : nuisance.points)
      if (!experiment.points[p].withheld) moved.emplace(nuisance.name, nuisance.u, p);
  needed += static_cast<int>(moved.size());
  int live = 0;
  for (const Effect& effect : simulator.effects()) {
    const bool wanted =
        experiment.candidates.empty() || std::count(experiment.candidates.begin(), experiment.candidates.end(), effect.name) > 0;
    live += wanted && effect.blind.empty();
  }
  constexpr int one_fit = 20;
  needed += training * (1 + live + one_fit);
  if (needed > experiment.max_runs)
    throw Error(ExitCode::usage, "[budget] max_runs = " + std::to_string(experiment.max_runs) + " is too few: " + std::to_string(live) +
                                     " candidates at " + std::to_string(training) + " points need at least " + std::to_string(needed) +
                                     " runs; raise it, or name fewer candidates");
}

void note_noise(const Experiment& experiment, Verdict& verdict) {
  const std::vector<NoiseModel> all = noise_of_repeats(experiment);
  for (std::size_t o = 0; o < all.size(); ++o) {
    const NoiseModel& noise = all[o];
    if (noise.nats == 0) continue;
    const std::string& id = experiment.observables[o].id;
    verdict.noise[id] = {noise.factor, noise.correlation_time, noise.nats};
    verdict.notes.push_back("The repeats of " + id + " scatter " + words(noise.factor) + " times as much as noise_u says" +
                            (noise.correlation_time > 0 ? ", and their noise lasts " + words(noise.correlation_time) + " s" : "") +
                            "; this noise is used. Correct noise_u, or find what the repeats differ by.");
  }
}

}  // namespace

Verdict diagnose(const Experiment& experiment, Simulator& simulator, const DiagnosisOptions& options) {
  check_budget(experiment, simulator);
  Verdict verdict;
  verdict.name = experiment.name;
  verdict.data_sha256 = experiment.data_sha256, verdict.withheld_sha256 = experiment.withheld_sha256;
  Responses model(experiment, simulator);
  Fitter fitter(model);
  Attribution attribution = attribute(model, fitter, options.progress);
  const int chosen = judge(model, attribution, verdict);
  note_noise(experiment, verdict);
  verdict.notes.insert(verdict.notes.end(), model.notes().begin(), model.notes().end());
  verdict.identifiability = attribution.identifiability;
  verdict.identifiability.next_experiment = next_experiment(model, attribution, verdict.verdict == "outside");
  verdict.where = gap_cells(model, fitter);
  verdict.curves = gap_curves(model, fitter, chosen > 0 ? &attribution.fits[static_cast<std::size_t>(chosen)] : nullptr, verdict.where);
  if (options.progress) options.progress("withheld points", 0.9);
  measure_shrinkage(model, attribution, chosen, verdict);
  withdraw_what_shrinks_nothing(verdict);
  judge_origins(model, fitter, verdict.where);  // last: with what the budget has left
  verdict.runs = simulator.n_runs();
  if (const int taken = simulator.n_imported(); taken > 0)
    verdict.notes.push_back(std::to_string(taken) + " runs were not made for this verdict but taken from [budget] runs_table = \"" +
                            experiment.runs.filename().string() + "\".");
  return verdict;
}

}  // namespace snag
