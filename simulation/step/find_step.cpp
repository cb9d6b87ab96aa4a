#include "simulation/step/find_step.hpp"

#include <mpi.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "simulation/step/rag_trial.hpp"
#include "simulation/step/step_choice.hpp"
#include "simulation/step/trial_case.hpp"
#include "simulation/step/water_trial.hpp"

namespace snag {

namespace {

constexpr int most_trial_steps = 480;  // 0.75 degrees
constexpr double rag_accuracy = 0.03;  // of path and impulse before the first contact

bool is_shorter(const RagTrial& a, const RagTrial& b) { return a.duration() < b.duration(); }

std::string degrees_text(int steps_per_revolution) { return rounded(360.0 / steps_per_revolution) + " degrees"; }

/// The result of a trial at n steps a revolution; of half the step, and a note, as long as the water diverges.
template <class Trial>
auto with_smaller_steps(int& n, std::vector<std::string>& notes, const Trial& trial) {
  for (;; n *= 2) {
    try {
      return trial(n);
    } catch (const Error& failure) {
      if (failure.code != ExitCode::diverged || n >= most_trial_steps) throw;
      leave_together(failure);
      notes.push_back("at " + degrees_text(n) + " a step the water diverged; smaller steps are tried");
      log::warning(notes.back() + ": " + failure.what());
    }
  }
}

/// Trials from `n` steps a revolution on, until one is accurate.
StepChoice try_steps(const TrialCase& trial, int n, std::vector<StepTrial>& trials, StepRecord& record) {
  const double accuracy = trial.request().accuracy();
  for (;; n *= 2) {
    const int first = n;
    trials.push_back(with_smaller_steps(n, record.notes, [&](int steps) { return try_water(trial, steps); }));
    if (n != first) trials = {trials.back()};  // those before have steps that the water does not bear
    if (trials.size() < 2) continue;
    StepChoice choice = choose_step(trials, accuracy);
    if (choice.chosen || n >= most_trial_steps) return choice;
  }
}

void note_choice(const Settling& settling, const StepChoice& choice, StepRecord& record) {
  if (!settling.has_settled)
    record.notes.push_back("the flow had not settled before the trials: its means still changed by " + rounded(100 * settling.last_change) +
                           " % a revolution");
  if (!choice.has_settled)
    record.notes.push_back("the difference between two steps still changed in the last revolution; the change counts as an error");
  if (!choice.converges)
    record.notes.push_back(
        "the differences between the steps do not shrink as they should, by noise or chance; a smaller step was required");
}

void find_for_water(const TrialCase& trial, int n, const Settling& settling, StepRecord& record) {
  std::vector<StepTrial> trials;
  const StepChoice choice = try_steps(trial, n, trials, record);
  record.is_reached = choice.chosen.has_value();
  record.steps_per_revolution = trials[choice.chosen.value_or(trials.size() - 1)].steps_per_revolution;
  note_choice(settling, choice, record);
  for (std::size_t i = 0; i < trials.size(); ++i)
    record.water.push_back({.steps_per_revolution = trials[i].steps_per_revolution,
                            .revolutions = static_cast<int>(trials[i].means.size()),
                            .step = trial.request().step(trials[i].steps_per_revolution),
                            .head = trials[i].means.back()[trial_head],
                            .torque = trials[i].means.back()[trial_torque],
                            .head_error = choice.error[i][trial_head],
                            .torque_error = choice.error[i][trial_torque]});
}

/// From the step that suits the water on.
void find_for_rag(const TrialCase& trial, RagEntry entry, StepRecord& record) {
  std::vector<RagTrial> trials;
  StepChoice choice;
  for (int n = record.steps_per_revolution; !choice.chosen && n <= most_trial_steps; n *= 2) {
    trials.push_back(try_rag(trial, n, entry == RagEntry::at_start));
    if (trials.back().at(trials.back().duration()).path == 0) {
      record.notes.push_back("the rag does not move freely: the step is that for the water");
      return;
    }
    if (trials.size() > 1) choice = choose_step(at_same_time(trials), rag_accuracy);
  }
  if (trials.size() < 2) return record.notes.push_back("the rag was not looked at: the step is the smallest one already");
  record.rag_accuracy = rag_accuracy;
  record.is_reached = record.is_reached && choice.chosen;
  record.steps_per_revolution = trials[choice.chosen.value_or(trials.size() - 1)].steps_per_revolution;
  const std::vector<StepTrial> compared = at_same_time(trials);
  for (std::size_t i = 0; i < trials.size(); ++i)
    record.rag.push_back({.steps_per_revolution = trials[i].steps_per_revolution,
                          .step = trial.request().step(trials[i].steps_per_revolution),
                          .duration = std::min_element(trials.begin(), trials.end(), is_shorter)->duration(),
                          .path = compared[i].means[0][rag_path],
                          .impulse = compared[i].means[0][rag_impulse],
                          .path_error = choice.error[i][rag_path],
                          .impulse_error = choice.error[i][rag_impulse]});
}

}  // namespace

StepRecord find_step(const TrialCase& trial) {
  const double begun = MPI_Wtime();
  StepRecord record{.accuracy = trial.request().accuracy()};
  log::info("[time] step = \"auto\": a trial looks for the largest step that gives head and torque within " +
            rounded(100 * *record.accuracy) + " %");
  int n = fewest_trial_steps;
  const Settling settling = with_smaller_steps(n, record.notes, [&](int steps) { return settle_water(trial, steps); });
  record.settling_revolutions = settling.revolutions;
  find_for_water(trial, n, settling, record);
  if (settling.rag != RagEntry::none) find_for_rag(trial, settling.rag, record);
  if (!record.is_reached)
    record.notes.push_back(
        "no step down to " + degrees_text(record.steps_per_revolution) +
        " is as accurate as asked for; the smallest one is taken. More [flow] n_outer_correctors often make larger steps accurate");
  record.step = trial.request().step(record.steps_per_revolution);
  record.wall = MPI_Wtime() - begun;
  return record;
}

std::string trial_in_words(const StepRequest& request) {
  const int first = fewest_trial_steps, finest = most_trial_steps;
  const int fewest = first * (n_settling_least + n_trial_revolutions) + 2 * first * n_trial_revolutions;
  int most = first * n_settling_most;
  for (int n = first; n <= finest; n *= 2) most += n * n_trial_revolutions;
  return "[time] step = \"auto\": before the run a trial computes the water alone, until it has settled at " + degrees_text(first) +
         " a step, then " + std::to_string(n_trial_revolutions) + " revolutions each at " + degrees_text(first) + ", " +
         degrees_text(2 * first) + " and, as far as needed, by halves down to " + degrees_text(finest) +
         ", and takes the largest step that gives head and torque within " + rounded(100 * request.accuracy()) + " %: about " +
         std::to_string(fewest) + " to " + std::to_string(most) +
         " steps; a rag that enters is tried at the step that was found and at half of it. What follows is for " + degrees_text(first) +
         " a step:";
}

}  // namespace snag
