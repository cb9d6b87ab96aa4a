#include "simulation/step/water_trial.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/simulation.hpp"
#include "simulation/step/rag_trial.hpp"
#include "simulation/step/trial_case.hpp"
#include "solver/pump_monitor.hpp"

namespace snag {

namespace {

constexpr double settled_change = 2;  // of the means from a revolution to the next, over the accuracy: most of it cancels

/// The water of a simulation, step by step, with the means of head and torque over revolutions.
class TrialWater {
 public:
  TrialWater(const TrialCase& trial, Simulation& simulation, int steps_per_revolution)
      : trial_(trial),
        simulation_(simulation),
        pump_(simulation.water->flow, *simulation.pump),
        n_(steps_per_revolution),
        step_(simulation.time_settings.step) {}

  double time() const { return simulation_.water->flow.time; }
  void advance() {
    trial_.stop_if_asked();
    const log::Silence silence;
    if (!waits_for_rag_) {
      simulation_.water->advance(step_);
    } else if (*waits_for_rag_ > simulation_.time() + 1e-6 * step_) {
      simulation_.step();
    } else {
      store_before_entry(trial_, simulation_);
      waits_for_rag_.reset();
      simulation_.water->advance(step_);
    }
  }
  /// The state just before the first rag enters is stored, if it is not there from the start; for a simulation that has started.
  void wait_for_rag() {
    const std::optional<double> entry = first_entry(simulation_);
    if (entry && *entry > 0) waits_for_rag_ = entry;
  }
  bool waits_for_rag() const { return waits_for_rag_.has_value(); }
  /// Means over the next revolution, linear between the steps.
  std::vector<double> revolution() {
    std::vector<double> sum(2), before = read();
    for (int k = 0; k < n_; ++k) {
      advance();
      const std::vector<double> now = read();
      for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += 0.5 * (before[q] + now[q]) / n_;
      before = now;
    }
    return sum;
  }

 private:
  std::vector<double> read() const {
    const Flow& flow = simulation_.water->flow;
    const RotatingZone& zone = *flow.rotating_zone;
    const PumpReading now = pump_.read(flow, {zone.origin(), zone.axis(), zone.speed(flow.time)});
    return {now.head, now.torque()};
  }

  const TrialCase& trial_;
  Simulation& simulation_;
  PumpMonitor pump_;
  int n_;
  double step_;                          // s
  std::optional<double> waits_for_rag_;  // s; until then the whole simulation takes the steps, as its state is stored
};

void log_revolution(int steps_per_revolution, const std::string& what, int number, const std::vector<double>& means) {
  log::info("trial of the step, " + rounded(360.0 / steps_per_revolution) + " degrees: " + what + " " + std::to_string(number) + ", head " +
            number_text(means[trial_head]) + " m, torque " + number_text(means[trial_torque]) + " N m");
}

double largest_change(const std::vector<double>& means, const std::vector<double>& before) {
  double largest = 0;
  for (std::size_t q = 0; q < means.size(); ++q) largest = std::max(largest, std::abs(means[q] - before[q]) / std::abs(means[q]));
  return largest;
}

std::filesystem::path state_of_water(const TrialCase& trial) { return trial.folder() / "water"; }

}  // namespace

Settling settle_water(const TrialCase& trial, int steps_per_revolution) {
  const auto simulation = trial.simulation(steps_per_revolution);
  {
    const log::Silence silence;
    simulation->start();
  }
  TrialWater water(trial, *simulation, steps_per_revolution);
  water.wait_for_rag();
  const double ramp = simulation->water->flow.rotating_zone->ramp();
  while (water.time() < ramp * (1 - 1e-9)) water.advance();
  Settling settling;
  std::vector<double> before;
  bool was_settled = false;
  while (water.waits_for_rag() || settling.revolutions < n_settling_least ||
         (!settling.has_settled && settling.revolutions < n_settling_most)) {
    const std::vector<double> means = water.revolution();
    log_revolution(steps_per_revolution, "settling, revolution", ++settling.revolutions, means);
    if (!before.empty()) settling.last_change = largest_change(means, before);
    const bool is_settled_now = !before.empty() && settling.last_change <= settled_change * trial.request().accuracy();
    settling.has_settled = is_settled_now && was_settled;  // once may be by chance
    was_settled = is_settled_now;
    before = means;
  }
  CheckpointWriter writer(MPI_COMM_WORLD, state_of_water(trial),
                          {.case_sha256 = "", .ranks = size_of(MPI_COMM_WORLD), .time_step = 0, .time = water.time()});
  simulation->water->save(writer);
  writer.finish();
  if (const std::optional<double> entry = first_entry(*simulation)) settling.rag = *entry > 0 ? RagEntry::later : RagEntry::at_start;
  return settling;
}

StepTrial try_water(const TrialCase& trial, int steps_per_revolution) {
  const auto simulation = trial.simulation(steps_per_revolution);
  CheckpointReader reader(MPI_COMM_WORLD, state_of_water(trial));
  simulation->water->load(reader);
  TrialWater water(trial, *simulation, steps_per_revolution);
  StepTrial result{.steps_per_revolution = steps_per_revolution, .means = {}};
  for (int k = 1; k <= n_trial_revolutions; ++k) {
    result.means.push_back(water.revolution());
    log_revolution(steps_per_revolution, "revolution", k, result.means.back());
  }
  return result;
}

}  // namespace snag
