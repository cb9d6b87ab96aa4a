#include "diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "base/error.hpp"
#include "base/words.hpp"

#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/attribution/gap_origin.hpp"
#include "diagnosis/data/noise.hpp"
#include "diagnosis/data/outliers.hpp"
#include "diagnosis/judgement/curves.hpp"
#include "diagnosis/judgement/decision.hpp"
#include "diagnosis/judgement/new_conditions.hpp"
#include "diagnosis/judgement/next_experiment.hpp"
#include "diagnosis/judgement/posterior.hpp"
#include "diagnosis/judgement/shrinkage.hpp"
#include "diagnosis/localisation/gap_cells.hpp"
#include "diagnosis/localisation/missing_force.hpp"

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

void check_costs(const Experiment& experiment, const Simulator& simulator) {
  std::vector<std::string> inputs;
  for (const Nuisance& nuisance : simulator.nuisances())
    if (std::count(inputs.begin(), inputs.end(), nuisance.name) == 0) inputs.push_back(nuisance.name);
  for (const auto& [key, cost] : experiment.costs)
    if (std::count(inputs.begin(), inputs.end(), key) == 0)
      throw Error(ExitCode::usage, "[budget.cost] \"" + key + "\" is no uncertain input of these points; there are " + joined(inputs));
}

void note_noise(const Experiment& experiment, Verdict& verdict) {
  const std::vector<NoiseModel> all = noise_of_repeats(experiment);
  for (std::size_t o = 0; o < all.size(); ++o) {
    const NoiseModel& noise = all[o];
    if (noise.scatter > 0)
      verdict.notes.push_back("The repeats of " + experiment.observables[o].id + " scatter " + rounded(noise.scatter) +
                              " times as much as noise_u says: this is taken as scatter of the tests, not of the instrument. If the "
                              "tests were alike, correct noise_u or its unit.");
    if (noise.nats == 0) continue;
    const std::string& id = experiment.observables[o].id;
    verdict.noise[id] = {noise.factor, noise.correlation_time, noise.nats};
    verdict.notes.push_back("The repeats of " + id + " scatter " + number_text(noise.factor) + " times as much as noise_u says" +
                            (noise.correlation_time > 0 ? ", and their noise lasts " + number_text(noise.correlation_time) + " s" : "") +
                            "; this noise is used. Correct noise_u, or find what the repeats differ by.");
  }
}

// Lines of the data file as they stand in a note, the first ones.
std::string lines_of(const std::vector<OutlierRow>& rows) {
  constexpr std::size_t most = 20;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(most, rows.size()); ++i) lines.push_back(std::to_string(rows[i].line));
  return joined(lines) + (rows.size() > most ? " and " + std::to_string(rows.size() - most) + " more, which verdict.json lists" : "");
}

void note_outliers(const Experiment& given, const std::vector<OutliersFound>& all, Verdict& verdict) {
  for (std::size_t o = 0; o < all.size(); ++o) {
    if (all[o].samples.empty()) continue;
    const std::string& id = given.observables[o].id;
    OutlierRows& found = verdict.outliers[id];
    found.share = all[o].share, found.nats = all[o].nats;
    for (const std::size_t i : all[o].samples) {
      const Datum& d = given.data[i];
      found.rows.push_back({d.line, given.points[static_cast<std::size_t>(d.point)].id, d.replicate, d.time});
    }
    std::stable_sort(found.rows.begin(), found.rows.end(), [](const OutlierRow& a, const OutlierRow& b) { return a.line < b.line; });
    verdict.notes.push_back(counted(std::ssize(found.rows), "row") + " of " + id + " (" + number_text(100 * found.share) +
                            " %) lie where no noise brings them, by " + rounded(found.nats) + " nats; they are left out: line" +
                            (found.rows.size() > 1 ? "s " : " ") + lines_of(found.rows) + " of the data. Look at them.");
  }
}

// Largest difference between the runs of a state and those of a fit at the training points, in standard uncertainties of the data.
double off_by(Responses& model, const State& state, const Fit& fit) {
  const std::vector<Response> answers = model.run(state, model.training());
  double off = 0;
  for (std::size_t p = 0; p < answers.size(); ++p) {
    const PointSummary& point = model.points()[static_cast<std::size_t>(model.training()[p])];
    const Eigen::VectorXd difference = finite(answers[p].value - fit.at.responses[p].value);
    for (int i = 0; i < point.n_gaussian; ++i) off = std::max(off, std::abs(difference[i]) / std::sqrt(point.covariance(i, i)));
  }
  return off;
}

// A case has one form of each law: those forms that come nearest to the fitted mixture, one effect after the other.
ImprovedModel improved_model(Responses& model, const Fit& fit) {
  ImprovedModel improved;
  State state = lead_of(fit.at.state);
  if (fit.at.state.shares.size() > 0) {
    improved.off_by_forms = off_by(model, state, fit);
    for (std::size_t e = 0; e < state.effects.size(); ++e) {
      const int n_forms = model.effects()[static_cast<std::size_t>(state.effects[e].first)].n_forms;
      for (int form = 0; form < n_forms && model.runs_left() > static_cast<int>(model.training().size()); ++form) {
        State tried = state;
        tried.forms.resize(state.effects.size(), 0);
        if (tried.forms[e] == form) continue;
        tried.forms[e] = form;
        if (const double off = off_by(model, tried, fit); off < improved.off_by_forms)
          improved.off_by_forms = off, state = std::move(tried);
      }
    }
  }
  for (std::size_t p = 0; p < model.points().size(); ++p) improved.runs.push_back(model.leading_run(state, static_cast<int>(p)));
  return improved;
}

}  // namespace

Verdict diagnose(const Experiment& given, Simulator& simulator, const DiagnosisOptions& options) {
  check_budget(given, simulator);
  check_costs(given, simulator);
  Verdict verdict;
  const std::vector<OutliersFound> outliers = find_outliers(given);
  const Experiment experiment = without(given, outliers);
  verdict.name = experiment.name;
  verdict.data_sha256 = experiment.data_sha256, verdict.withheld_sha256 = experiment.withheld_sha256;
  Responses model(experiment, simulator);
  Fitter fitter(model);
  Attribution attribution = attribute(model, fitter, options.progress);
  const int chosen = judge(model, attribution, verdict);
  note_noise(experiment, verdict);
  note_outliers(given, outliers, verdict);
  verdict.notes.insert(verdict.notes.end(), model.notes().begin(), model.notes().end());
  verdict.identifiability = attribution.identifiability;
  verdict.identifiability.next_experiment = next_experiment(model, attribution, verdict.verdict == VerdictKind::outside);
  const Fit* const with_effects = chosen > 0 ? &attribution.fits[static_cast<std::size_t>(chosen)] : nullptr;
  const FittedGap before(model, attribution.fits.front(), with_effects);
  const auto after = with_effects ? std::optional<FittedGap>(std::in_place, model, *with_effects) : std::nullopt;
  verdict.where = gap_cells(model, fitter, before, after ? &*after : nullptr, static_cast<int>(attribution.fits.size()) - 1);
  verdict.missing_force = missing_forces(model, before, after ? &*after : nullptr);
  verdict.curves = gap_curves(model, fitter, with_effects, verdict.where);
  if (options.progress) options.progress("withheld points", 0.9);
  measure_shrinkage(model, attribution, chosen, verdict);
  withdraw_what_shrinks_nothing(verdict);
  if (with_effects) {
    verdict.posterior = posterior_draws(model, *with_effects, attribution.names[static_cast<std::size_t>(chosen)], experiment.seed);
    if (verdict.verdict == VerdictKind::effects) verdict.improved = improved_model(model, *with_effects);
  }
  if (verdict.verdict == VerdictKind::tie) verdict.identifiability.new_conditions = new_conditions(model, attribution);
  judge_origins(model, fitter, verdict.where);  // last: with what the budget has left
  verdict.runs = simulator.n_runs();
  if (const FailedRuns failed = simulator.failed(); failed.n > 0)
    verdict.notes.push_back(counted(failed.n, "run") + " failed, and no fit goes to where " + (failed.n > 1 ? "they are" : "it is") +
                            ". The first: " + failed.why);
  if (const int taken = simulator.n_imported(); taken > 0)
    verdict.notes.push_back(std::to_string(taken) + " runs were not made for this verdict but taken from [budget] runs_table = \"" +
                            experiment.runs.filename().string() + "\".");
  return verdict;
}

}  // namespace snag
