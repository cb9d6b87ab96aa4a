#pragma once
// What [time] step = "auto" found, and the trial that shows why: in step.json of the output folder, from which a resume takes the step, in
// the log, in summary.json and in the report.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace snag {

struct StepRecord {
  /// Water alone: means over the last revolution of a trial, and its errors, relative.
  struct OfWater {
    int steps_per_revolution = 0, revolutions = 0;
    double step = 0, head = 0, torque = 0;  // s, m, N m
    double head_error = 0, torque_error = 0;
  };
  /// With the rag, from where it is put in until the first contact of either trial: at the same time after that.
  struct OfRag {
    int steps_per_revolution = 0;
    double step = 0, duration = 0, path = 0, impulse = 0;  // s, s, m, N s
    double path_error = 0, impulse_error = 0;
  };

  double step = 0;               // s
  int steps_per_revolution = 0;  // of the rotor at full speed
  std::optional<double> accuracy = {},
                        rag_accuracy = {};  // asked for, relative; absent: the step follows from degrees, or no rag moves freely
  bool is_reached = true;                   // the accuracy
  int settling_revolutions = 0;             // before the trials
  std::vector<OfWater> water = {};
  std::vector<OfRag> rag = {};
  std::vector<std::string> notes = {};  // what a reader must know of the choice
  double wall = 0;                      // s, of the trial

  double degrees() const { return 360.0 / steps_per_revolution; }
};

nlohmann::ordered_json step_json(const StepRecord& record);
/// Writes step.json. Throws Error(io).
void write_step_record(const std::filesystem::path& folder, const StepRecord& record);
/// Absent: the step of the run in this folder was given. Throws Error(io) if the file is damaged.
std::optional<StepRecord> read_step_record(const std::filesystem::path& folder);

/// "step: 0.000833333 s, 6 degrees a step, ...", the trials as a table, the notes.
std::string step_in_words(const StepRecord& record);

}  // namespace snag
