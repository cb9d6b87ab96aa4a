#pragma once
// Studies: one case, run again and again with other values, a sweep or an ensemble; a table and plots of what came out.
//
//   DIR/NAME_OF_RUN/    a run as `snag run` leaves it, and input.toml: the case and the values it was run with
//   DIR/study.csv       a row a run: the values that vary, the chosen keys of summary.json
//   DIR/study.html      the same as a table, and the plots
//   DIR/plateau.json    with [plateau]: the values over which the results do not depend on a choice of the computation
// The runs go one after another on all ranks. What has ended is not run again, what was stopped goes on where its checkpoint is.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "simulation/run.hpp"

namespace snag {

struct StudySettings {
  std::string name = "study", description;
  std::string case_file;             // relative to the study file
  std::vector<std::string> set;      // overrides of all runs
  std::vector<std::string> results;  // keys of summary.json
  bool zip = false;
  Section section();
};

/// A key of the case and its values.
struct VarySettings {
  std::string key, name;
  std::vector<double> values;
  std::vector<std::string> texts;
  std::vector<std::string> with;  // an override that goes with each value; empty: none
  Section section();
};

struct StudyPlotSettings {
  std::string title, x, x_label, y_label;
  std::vector<std::string> y;
  Section section();
};

/// A value that is a choice of the computation: over which of its values do the results not depend on it (simulation/plateau.hpp)?
struct PlateauSettings {
  std::string x;                      // name of a [[vary]] with numbers
  std::vector<std::string> results;   // keys of summary.json
  std::vector<std::string> physical;  // names of [[vary]] on which results may depend
  double tolerance = 0.03;
  int n_least = 3;
  std::string recommend = "middle";  // middle | largest | smallest
  Section section();
};

/// One run of a study.
struct StudyRun {
  std::string name;                    // of its folder: "flow-26.8_speed-1200"
  std::vector<std::string> values;     // of what varies, in the order of the study file
  std::vector<std::string> overrides;  // as for --set
  int failed_with = 0;                 // code of a run that failed; shown where it has no summary
};

struct Study {
  StudySettings settings;
  std::vector<VarySettings> vary;
  std::vector<StudyPlotSettings> plots;
  std::optional<PlateauSettings> plateau;
  std::filesystem::path case_file;
  std::vector<StudyRun> runs;
};

/// Reads a study file and lays out its runs: all combinations, the last one fastest, or value by value with zip. Throws Error(usage, io).
Study read_study(const std::filesystem::path& file);

struct StudyOptions {
  std::filesystem::path study_file, out;  // out empty: results/NAME
  bool dry_run = false;
  ReportWriter write_report{};  // of each run; empty: none
  /// Table and plots of the study; what came out, for people. On one rank; throws Error(io).
  std::function<std::string(const Study& study, const std::filesystem::path& folder)> write_results;
};

/// Runs what has not been run, then writes table and plots; the code of the first run that failed. Collective; throws Error.
ExitCode run_study(const StudyOptions& options);

/// Sections of the manual; they point to settings that live as long as the program.
std::vector<Section> study_sections();

}  // namespace snag
