#include "simulation/run.hpp"

#include <cmath>
#include <optional>
#include <sstream>

#include "base/log.hpp"
#include "base/progress.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/checkpoint_slots.hpp"
#include "parallel/session.hpp"
#include "parallel/stop_request.hpp"
#include "simulation/output/output_folder.hpp"
#include "simulation/output/outputs.hpp"
#include "simulation/setup/forecast.hpp"
#include "simulation/setup/heading.hpp"
#include "simulation/setup/prepared.hpp"
#include "simulation/setup/simulation.hpp"
#include "simulation/step/case_with_step.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;

struct Run {
  std::filesystem::path folder;
  Simulation& simulation;
  Outputs& outputs;

  std::string note() const {
    std::ostringstream text;
    text.precision(3);
    if (simulation.water) {
      text << "Courant " << simulation.flow_report.courant_max;
      if (!simulation.flow_report.outer.empty())
        text << ", pressure " << simulation.flow_report.outer.back().continuity.iterations << " iterations";
    }
    return text.str();
  }

  /// Steps to the end of the case, or to a request to stop.
  ExitCode steps() {
    if (simulation.has_ended()) {
      log::info("the run had reached its end: no step is left, only the summary and the report are written");
      return ExitCode::ok;
    }
    const StopRequest stop(world, folder);
    Progress progress(simulation.case_settings.name, simulation.time_settings.end, simulation.time());
    bool is_stopped = false;
    simulation.run([&] {
      outputs.after_step();
      if (rank_of(world) == 0) progress.update(simulation.time(), note());
      if (simulation.has_ended()) return false;
      is_stopped = stop.asked();
      return !is_stopped;
    });
    outputs.write_checkpoint();
    if (is_stopped) {
      log::info("stopped on request (" + stop.reason() + "), checkpoint written; go on with --resume");
      return ExitCode::stopped;
    }
    if (rank_of(world) == 0) progress.finish();  // said to be done only when the disk has it
    if (simulation.rags_have_left())
      log::info("all rags have left at " + number_text(*simulation.passage->all_exited_at()) + " s: the run ends here");
    return ExitCode::ok;
  }
};

void log_warnings(const Forecast& ahead) {
  for (const std::string& warning : ahead.warnings) log::warning(warning);
}

/// Partition of the checkpoint, if it was written on as many ranks.
std::optional<std::vector<int>> stored_partition(CheckpointReader* reader) {
  if (!reader || reader->stamp().ranks != size_of(world) || !reader->has("mesh/partition")) return {};
  const std::vector<std::int64_t> stored = reader->shared_integers("mesh/partition");
  return std::vector<int>(stored.begin(), stored.end());
}

void check_same_case(const CaseFile& file, const std::filesystem::path& folder, const CheckpointReader& reader) {
  const std::string stored = reader.stamp().case_sha256, own = file.resume_sha256();
  if (stored != own)
    throw Error(ExitCode::usage, (folder / "checkpoint").string() + ": was written by another case (sha256 " + stored.substr(0, 12) +
                                     ", this one " + own.substr(0, 12) +
                                     "); resume with the same case and --set values; only [time] end may be another");
}

/// The folder holds all that a run writes that has ended at the checkpoint: says so. Collective.
bool has_ended_before(const std::filesystem::path& folder, const CaseFile& file, bool with_report, const CheckpointReader& reader) {
  int complete = rank_of(world) == 0 && is_of_ended_run(folder / "summary.json", file.sha256(), reader.stamp().time_step) &&
                 (!with_report || std::filesystem::exists(folder / "report.html"));
  MPI_Bcast(&complete, 1, MPI_INT, 0, world);
  if (complete == 0) return false;
  if (!reader.fallback().empty()) log::warning(reader.fallback());
  log::info(folder.string() + ": the run ended at " + number_text(reader.stamp().time) +
            " s; there is nothing to resume and nothing is changed; a later [time] end extends it, --overwrite starts it again");
  return true;
}

void load(Simulation& simulation, CheckpointReader& checkpoint) {
  if (!checkpoint.fallback().empty()) log::warning(checkpoint.fallback());
  simulation.load(checkpoint);
  if (simulation.time_step() > simulation.time_settings.n_steps())
    throw Error(ExitCode::usage, "[time] end_s = " + number_text(simulation.time_settings.end) + " lies before the checkpoint, at " +
                                     number_text(simulation.time()) + " s; give a later end");
}

/// From where a run that failed can be repeated, as the end of its message. Collective.
std::string last_checkpoint(const std::filesystem::path& folder) {
  const auto slots = checkpoint_slots(world, folder / "checkpoint");
  const int slot = newest(slots);
  if (slot < 0) return "; no checkpoint was written before";
  return "; the last checkpoint is that of t = " + number_text(slots[static_cast<std::size_t>(slot)].stamp.time) + " s, " +
         slots[static_cast<std::size_t>(slot)].file.string() + ": a case with other settings takes its water by [initial_flow] from = \"" +
         folder.string() + "\"";
}

/// Summary and, with a writer, the report of what was reached; the error that ended the run goes on to the command line.
void finish_failed(Outputs& outputs, ExitCode code, const std::string& message, const ReportWriter& write) {
  try {
    outputs.finish(code, write, message);
  } catch (const Error& second) {
    log::warning(std::string("no summary of the failed run: ") + second.what());
  }
}

}  // namespace

ExitCode run_case(const RunOptions& options) {
  const double begun = MPI_Wtime();
  const CaseFile given = CaseFile::read(options.case_file, options.overrides);
  const OutputFolder output = OutputFolder::of(given, options.out, options.resume, options.overwrite);
  const auto& folder = output.path();
  std::unique_ptr<CheckpointReader> reader;
  if (options.resume) reader = std::make_unique<CheckpointReader>(world, folder / "checkpoint");
  Prepared of_this_run;
  Prepared* prepared = options.prepared ? options.prepared : &of_this_run;
  const auto [file, step_found] = options.resume ? case_with_stored_step(options.case_file, options.overrides, folder)
                                                 : case_with_step(options.case_file, options.overrides, folder, *prepared);

  Simulation::Stored stored{};
  if (reader) stored = {.partition = stored_partition(reader.get()), .checkpoint = reader.get()};
  Simulation simulation(file, world, std::move(stored), nullptr, prepared);
  if (reader) check_same_case(file, folder, *reader);
  const ReportWriter write_report = simulation.output_settings.report ? options.write_report : ReportWriter{};
  if (reader && has_ended_before(folder, file, write_report != nullptr, *reader)) return ExitCode::ok;

  const std::string start = reader ? "" : simulation.start();
  output.open(simulation, file, options.resume);
  if (!start.empty()) log::info(start);
  if (step_found) say_and_store(*step_found, folder, options.resume);
  if (!reader) log_warnings(forecast(simulation));
  if (reader) load(simulation, *reader);
  Outputs outputs(folder, file, simulation, options.resume, begun);
  if (reader) {
    outputs.load(*reader);
    log::info("resumed at " + number_text(simulation.time()) + " s");
    reader.reset();
  } else {
    outputs.initial();
  }

  ExitCode code = ExitCode::ok;
  try {
    code = Run{folder, simulation, outputs}.steps();
  } catch (const Error& failure) {
    const bool of_the_computation = failure.code == ExitCode::diverged || failure.code == ExitCode::invariant;
    const std::string message = failure.what() + (of_the_computation ? last_checkpoint(folder) : "");
    finish_failed(outputs, failure.code, message, of_the_computation ? write_report : ReportWriter{});
    throw Error(failure.code, message);
  }
  code = outputs.finish(code, code == ExitCode::stopped ? ReportWriter{} : write_report);
  const double spent = MPI_Wtime() - begun;
  const bool had_trial = step_found && step_found->wall > 0 && !options.resume;
  log::info("done after " + duration(spent) + (had_trial ? ", " + duration(step_found->wall) + " of it for the trial of the step" : "") +
            ": " + folder.string());
  return code;
}

ExitCode check_case(const RunOptions& options) {
  const auto [file, about_step] = case_with_first_step(options.case_file, options.overrides);
  Simulation simulation(file, world);
  const std::string start = simulation.start();
  if (simulation.pump) PumpMonitor(simulation.water->flow, *simulation.pump);  // refuses what a run would refuse
  log_heading(simulation, file);
  if (!start.empty()) log::info(start);
  if (simulation.mesh) {
    const std::string table = quality_table(*simulation.mesh, simulation.mesh_quality);
    log::info(table);
  }
  if (!about_step.empty()) log::info(about_step);
  const Forecast ahead = forecast(simulation);
  log::info(ahead.text);
  log_warnings(ahead);
  log::info("the case is ready to run");
  return ExitCode::ok;
}

}  // namespace snag
