#include "simulation/step/rag_trial.hpp"

#include <algorithm>

#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "simulation/output/free_motion.hpp"
#include "simulation/setup/simulation.hpp"
#include "simulation/step/trial_case.hpp"

namespace snag {

namespace {

constexpr double most_revolutions = 2;

std::filesystem::path state_before_entry(const TrialCase& trial) { return trial.folder() / "rag"; }

int first_rag(const Simulation& simulation) {
  const auto& pieces = simulation.rags->pieces();
  const auto earlier = [](const RagPiece& a, const RagPiece& b) { return a.insert_time < b.insert_time; };
  return static_cast<int>(std::min_element(pieces.begin(), pieces.end(), earlier) - pieces.begin());
}

void begin(const TrialCase& trial, Simulation& simulation, bool from_start) {
  const log::Silence silence;
  if (from_start) {
    simulation.start();
    return;
  }
  CheckpointReader reader(MPI_COMM_WORLD, state_before_entry(trial));
  simulation.load(reader);
}

}  // namespace

RagInstant RagTrial::at(double duration) const {
  RagInstant before;
  for (const RagInstant& now : course) {
    if (now.duration < duration * (1 - 1e-9)) {
      before = now;
      continue;
    }
    const double share = (duration - before.duration) / (now.duration - before.duration);
    const auto between = [&](double a, double b) { return a + share * (b - a); };
    return {duration, between(before.path, now.path), between(before.impulse, now.impulse)};
  }
  return before;
}

std::optional<double> first_entry(const Simulation& simulation) {
  if (!simulation.rags) return {};
  return std::max(0.0, simulation.rags->pieces()[static_cast<std::size_t>(first_rag(simulation))].insert_time);
}

void store_before_entry(const TrialCase& trial, const Simulation& simulation) {
  CheckpointWriter writer(
      MPI_COMM_WORLD, state_before_entry(trial),
      {.case_sha256 = "", .ranks = size_of(MPI_COMM_WORLD), .time_step = simulation.time_step(), .time = simulation.time()});
  simulation.save(writer);
  writer.finish();
}

RagTrial try_rag(const TrialCase& trial, int steps_per_revolution, bool from_start) {
  const auto simulation = trial.simulation(steps_per_revolution);
  begin(trial, *simulation, from_start);
  const auto rag = static_cast<std::size_t>(first_rag(*simulation));
  const double step = simulation->time_settings.step, longest = most_revolutions * trial.request().period;
  FreeMotion motion(simulation->rags->rags().size());
  RagTrial result{.steps_per_revolution = steps_per_revolution, .course = {}};
  while (!simulation->has_ended() && result.duration() < longest * (1 - 1e-9)) {
    trial.stop_if_asked();
    const log::Silence silence;
    simulation->step();
    motion.after_step(*simulation->rags, *simulation->passage, rag_forces(*simulation->rags, simulation->coupled.get(), step),
                      simulation->time(), step);
    const FreeMotionResult& moved = motion.result(rag);
    if (moved.duration > result.duration()) result.course.push_back({moved.duration, moved.path, norm(moved.impulse)});
    if (moved.first_contact || simulation->passage->n_out()[rag] > 0) break;
  }
  const RagInstant last = result.at(result.duration());
  log::info("trial of the step, " + rounded(360.0 / steps_per_revolution) + " degrees: rag after " + number_text(last.duration) +
            " s, path " + number_text(last.path) + " m, impulse of the water " + number_text(last.impulse) + " N s");
  return result;
}

std::vector<StepTrial> at_same_time(const std::vector<RagTrial>& trials) {
  double shortest = trials.front().duration();
  for (const RagTrial& trial : trials) shortest = std::min(shortest, trial.duration());
  std::vector<StepTrial> values;
  for (const RagTrial& trial : trials) {
    const RagInstant then = trial.at(shortest);
    values.push_back({.steps_per_revolution = trial.steps_per_revolution, .means = {{then.path, then.impulse}}});
  }
  return values;
}

}  // namespace snag
