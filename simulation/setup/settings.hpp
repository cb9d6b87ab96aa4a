#pragma once
// What a case says of the run as a whole: mesh, time, outputs, checkpoints. The physics' own settings live in their folders.
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace snag {

class CaseFile;

struct CaseSettings {
  std::string name = "case";
  std::string description;
  Section section();
};

struct MeshSettings {
  std::string file;  // relative to the case file; without file and geometry: no mesh (particles only, or a prescribed flow)
  double scale = 1;
  std::string geometry;          // "channel", "pump" ...: made by snag-mesh for this run
  std::string parameters;        // its parameter file, relative to the case file
  std::vector<std::string> set;  // "key=value" instead of what that file says
  Section section();
};

struct PeriodicSettings {
  PeriodicPair pair;
  Section section();
};

struct TimeSettings {
  double end = 1;                                         // s
  double step = 1e-3;                                     // s; not a number: "auto"
  std::optional<double> degrees_per_step, step_accuracy;  // of "auto"
  bool end_when_rags_left = false;
  double run_on = 0;  // s
  Section section();
  bool step_is_auto() const;
  /// Steps to the end; throws Error(usage) if the end is no whole number of steps away (to 1e-6 of a step), or run_on has
  /// no effect.
  std::int64_t n_steps() const;
};

struct OutputSettings {
  std::optional<double> fields_interval, rags_interval;  // s
  bool report = true;
  bool single_precision = true;
  std::string format = "vtk";  // of the files with fields and rags
  Section section();
};

struct CheckpointSettings {
  std::optional<double> interval;  // s of simulated time
  double wall_interval = 600;      // s of wall clock
  Section section();
};

}  // namespace snag
