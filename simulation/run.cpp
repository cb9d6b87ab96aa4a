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
#include "simulation/output/output_folder.hpp"
#include "simulation/output/outputs.hpp"
#include "simulation/setup/forecast.hpp"
#include "simulation/setup/gap_lines.hpp"
#include "simulation/setup/rag_assumptions.hpp"
#include "simulation/setup/simulation.hpp"
#include "simulation/stop_request.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;

std::filesystem::path output_folder(const RunOptions& options, const CaseFile& file) {
  if (!options.out.empty()) return options.out;
  CaseSettings settings;
  file.root().table("case").read(settings.section().parameters);
  if (const std::filesystem::path name = settings.name; name.empty() || name == "." || name == ".." || name.has_parent_path())
    throw Error(ExitCode::usage,
                "[case] name = \"" + settings.name + "\" cannot name the output folder; give --out, or a name without \"/\"");
  return std::filesystem::path("results") / settings.name;
}

/// When a checkpoint is due: by simulated time, or by the wall clock of rank 0.
class CheckpointClock {
 public:
  CheckpointClock(const CheckpointSettings& settings, double time) : settings_(settings), last_time_(time), last_wall_(MPI_Wtime()) {}
  bool due(double time) {
    int now = settings_.interval && time - last_time_ > *settings_.interval * (1 - 1e-9);
    if (MPI_Wtime() - last_wall_ > settings_.wall_interval) now = 1;
    MPI_Bcast(&now, 1, MPI_INT, 0, world);
    if (now) last_time_ = time, last_wall_ = MPI_Wtime();
    return now != 0;
  }

 private:
  const CheckpointSettings& settings_;
  double last_time_, last_wall_;
};

struct Run {
  const CaseFile& file;
  std::filesystem::path folder;
  Simulation& simulation;
  Outputs& outputs;

  void write_checkpoint() const {
    outputs.sync();  // a checkpoint is never ahead of the monitors
    CheckpointWriter writer(
        world, folder / "checkpoint",
        {.case_sha256 = file.resume_sha256(), .ranks = size_of(world), .time_step = simulation.time_step(), .time = simulation.time()});
    simulation.save(writer);
    outputs.save(writer);
    writer.finish();
  }

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
    CheckpointClock clock(simulation.checkpoint_settings, simulation.time());
    Progress progress(simulation.case_settings.name, simulation.time_settings.end, simulation.time());
    bool is_stopped = false;
    simulation.run([&] {
      outputs.after_step();
      if (rank_of(world) == 0) progress.update(simulation.time(), note());
      if (simulation.has_ended()) return false;
      is_stopped = stop.asked();
      if (!is_stopped && clock.due(simulation.time())) write_checkpoint();
      return !is_stopped;
    });
    write_checkpoint();
    if (is_stopped) {
      log::info("stopped on request (" + stop.reason() + "), checkpoint written; go on with --resume");
      return ExitCode::stopped;
    }
    if (rank_of(world) == 0) progress.finish();  // said to be done only when the disk has it
    if (simulation.rags_have_left())
      log::info("all rags have left at " + words(*simulation.passage->all_exited_at()) + " s: the run ends here");
    return ExitCode::ok;
  }
};

/// The sub-step of the rags and what limits it.
std::string sub_step_words(const RagSystem& rags) {
  const double step = rags.stable_step(), limit = rags.step_limit().step;
  return (std::isfinite(step) ? "sub-step " + words(step) + " s" : "no sub-steps") +
         (std::isfinite(limit) ? " (limit " + words(limit) + " s by " + rags.step_limit().reason + ")"
                               : " (neither bonds nor contacts limit the step)");
}

/// Header of the log: enough to know and repeat the run.
void log_heading(const Simulation& simulation, const CaseFile& file) {
  std::ostringstream text;
  text << "snag " << version_number << " (" << version_git << "), " << version_build << "\n"
       << "case " << simulation.case_settings.name << ", sha256 " << file.sha256() << ", " << counted(size_of(world), "rank") << "\n";
  if (simulation.mesh)
    text << "mesh: " << simulation.mesh->n_cells_global << " cells, " << simulation.mesh->n_interior_global << " interior faces\n";
  if (simulation.rags) {
    text << "rags: " << counted(static_cast<std::int64_t>(simulation.rags->rags().size()), "piece") << " with "
         << counted(simulation.rags->n_particles(), "particle") << ", " << sub_step_words(*simulation.rags) << "\n";
  }
  log::info(text.str());
  for (const std::string& line : rag_assumptions(CaseFile::parse(file.resolved()))) log::info("assumed: " + line);
  if (simulation.coupled)
    for (const std::string& line : left_out_added_mass(simulation.coupled->coupling(), simulation.rags->rags()))
      log::info("left out: " + line);
  if (simulation.poses)
    for (const std::string& line : simulation.poses->lines()) log::info(line);
  if (simulation.holds)
    for (const std::string& line : simulation.holds->lines()) log::info(line);
  if (simulation.rags && rank_of(world) == 0)
    for (const std::string& line : gap_lines(simulation.walls, simulation.rags->rags(), simulation.contacts, simulation.time()))
      log::info(line);
  if (simulation.coupled && simulation.mesh) {
    for (const std::string& warning :
         kernel_warnings(simulation.coupled->coupling(), simulation.rags->rags(), *simulation.mesh, places_of_cloth(simulation)))
      log::warning(warning);
  }
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

/// The folder holds all that a run writes that has ended at the checkpoint. Collective.
bool is_complete(const std::filesystem::path& folder, const CaseFile& file, bool with_report, std::int64_t time_step) {
  int complete = rank_of(world) == 0 && is_of_ended_run(folder / "summary.json", file.sha256(), time_step) &&
                 (!with_report || std::filesystem::exists(folder / "report.html"));
  MPI_Bcast(&complete, 1, MPI_INT, 0, world);
  return complete != 0;
}

void load(Simulation& simulation, CheckpointReader& checkpoint) {
  simulation.load(checkpoint);
  if (simulation.time_step() > simulation.time_settings.n_steps())
    throw Error(ExitCode::usage, "[time] end_s = " + words(simulation.time_settings.end) + " lies before the checkpoint, at " +
                                     words(simulation.time()) + " s; give a later end");
}

/// Initial state, or that of the checkpoint (null: there is none); makes the folders and opens the log.
void begin(Simulation& simulation, const CaseFile& file, const OutputFolder& folder, CheckpointReader* reader) {
  const std::string start = reader ? "" : simulation.start();
  if (!reader) simulation.insert_rags();
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    folder.prepare(!reader);
    if (simulation.poses) simulation.poses->write(folder.path() / "rags");
  });
  log::open(folder.path() / "log.txt", reader != nullptr);
  log_heading(simulation, file);
  if (!start.empty()) log::info(start);
  if (!reader) return;
  if (!reader->fallback().empty()) log::warning(reader->fallback());
  load(simulation, *reader);
}

/// What a run does before its first step, and what it refuses there. Collective; throws Error(usage).
void begin_as_a_run(Simulation& simulation) {
  if (simulation.water) simulation.water->start(simulation.water->flow.time);
  if (simulation.pump) PumpMonitor(simulation.water->flow, *simulation.pump);
}

/// Collective.
void report(const std::filesystem::path& folder, const ReportWriter& write) {
  on_all_ranks(world, [&] {
    if (rank_of(world) == 0) write(folder);
  });
  log::info("report: " + (folder / "report.html").string());
}

/// From where a run that failed can be repeated, as the end of its message. Collective.
std::string last_checkpoint(const std::filesystem::path& folder) {
  const auto slots = checkpoint_slots(world, folder / "checkpoint");
  const int slot = newest(slots);
  if (slot < 0) return "; no checkpoint was written before";
  return "; the last checkpoint is that of t = " + words(slots[static_cast<std::size_t>(slot)].stamp.time) + " s, " +
         slots[static_cast<std::size_t>(slot)].file.string() + ": a case with other settings takes its water by [initial_flow] from = \"" +
         folder.string() + "\"";
}

/// Summary and, with a writer, the report of what was reached; the error that ended the run goes on to the command line.
void summarise_failed(Outputs& outputs, ExitCode code, const std::string& message, const std::filesystem::path& folder,
                      const ReportWriter& write) {
  try {
    outputs.finish(code, message);
    if (write) report(folder, write);
  } catch (const Error& second) {
    log::warning(std::string("no summary of the failed run: ") + second.what());
  }
}

}  // namespace

ExitCode run_case(const RunOptions& options) {
  const double begun = MPI_Wtime();
  const CaseFile file = CaseFile::read(options.case_file, options.overrides);
  const OutputFolder output(output_folder(options, file), options.resume, options.overwrite);
  const auto& folder = output.path();
  std::unique_ptr<CheckpointReader> reader;
  if (options.resume) reader = std::make_unique<CheckpointReader>(world, folder / "checkpoint");

  Simulation::Stored stored{};
  if (reader) stored = {.partition = stored_partition(reader.get()), .checkpoint = reader.get()};
  Simulation simulation(file, world, std::move(stored));
  if (reader) check_same_case(file, folder, *reader);
  const ReportWriter write_report = simulation.output_settings.report ? options.write_report : ReportWriter{};
  if (reader && is_complete(folder, file, write_report != nullptr, reader->stamp().time_step)) {
    if (!reader->fallback().empty()) log::warning(reader->fallback());
    log::info(folder.string() + ": the run ended at " + words(reader->stamp().time) +
              " s; there is nothing to resume and nothing is changed; a later [time] end extends it, --overwrite starts it again");
    return ExitCode::ok;
  }
  begin(simulation, file, output, reader.get());
  Outputs outputs(folder, file, simulation, options.resume, begun);
  if (reader) {
    outputs.load(*reader);
    log::info("resumed at " + words(simulation.time()) + " s");
    reader.reset();
  } else {
    outputs.initial();
  }

  ExitCode code = ExitCode::ok;
  try {
    code = Run{file, folder, simulation, outputs}.steps();
  } catch (const Error& failure) {
    const bool of_the_computation = failure.code == ExitCode::diverged || failure.code == ExitCode::invariant;
    const std::string message = failure.what() + (of_the_computation ? last_checkpoint(folder) : "");
    summarise_failed(outputs, failure.code, message, folder, of_the_computation ? write_report : ReportWriter{});
    throw Error(failure.code, message);
  }
  code = outputs.finish(code);
  if (code != ExitCode::stopped && write_report) report(folder, write_report);
  log::info("done after " + duration(MPI_Wtime() - begun) + ": " + folder.string());
  return code;
}

ExitCode check_case(const RunOptions& options) {
  const CaseFile file = CaseFile::read(options.case_file, options.overrides);
  Simulation simulation(file, world);
  const std::string start = simulation.start();
  simulation.insert_rags();
  begin_as_a_run(simulation);
  log_heading(simulation, file);
  if (!start.empty()) log::info(start);
  if (simulation.mesh) {
    const std::string table = quality_table(*simulation.mesh, simulation.mesh_quality);
    log::info(table);
  }
  const Forecast ahead = forecast(simulation);
  log::info(ahead.text);
  for (const std::string& warning : ahead.warnings) log::warning(warning);
  log::info("the case is ready to run");
  return ExitCode::ok;
}

}  // namespace snag
