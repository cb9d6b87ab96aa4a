#pragma once
// What was measured: observables, operating points and data of an experiment, as DIAGNOSIS.toml and its CSV give them.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/vec3.hpp"
#include "diagnosis/data/alternative.hpp"
#include "diagnosis/data/own_candidate.hpp"

namespace snag {

/// A measured quantity.
struct Observable {
  enum class Kind { gaussian, lognormal, count, event, angle };
  std::string id;    // x, vx, area, retention_time, ...
  std::string unit;  // as written; data are converted to SI when they are read
  Kind kind = Kind::gaussian;
  double noise_u = 0;                                            // standard uncertainty of one sample, SI (lognormal: of the logarithm)
  double bias_u = 0;                                             // shared by all samples of the calibration group
  std::string calibration_group;                                 // empty: of its own
  double numerics_u = std::numeric_limits<double>::quiet_NaN();  // of the runs by grid and step, as noise_u; NaN: found by runs
};

/// Name of the deviation that an observable's bias shares with its calibration group, or has of its own.
std::string calibration_of(const Observable& observable);

/// One set of conditions under which replicates were measured.
struct OperatingPoint {
  std::string id;
  std::filesystem::path case_file;                        // the base model
  bool withheld = false;                                  // used for "how far" only
  std::vector<std::string> set{};                         // values of the case that this point replaces, "section.key=value"
  std::vector<std::pair<std::string, double>> input_u{};  // relative standard uncertainty by key of the case
  std::string group{};                                    // of points that share a calibration of their own; empty: none
  std::string where{};                                    // "DIAGNOSIS.toml:12: [point]", for messages
};

/// A box in which cells of a path are treated separately from those elsewhere, by where it was measured.
struct Region {
  std::string id;
  Vec3 lower{-1e9, -1e9, -1e9}, upper{1e9, 1e9, 1e9};  // m
};

/// One number of the data file, SI.
struct Datum {
  int point = 0, observable = 0, replicate = 0;
  double time = std::numeric_limits<double>::quiet_NaN();  // s; NaN: a scalar of the replicate
  double value = 0;
  bool censored = false;  // the true value is larger (a test that ended)
  int line = 0;           // of the data file
  int n = 1;              // repeats whose mean the value is, of paths alone: a scalar is one repeat
  double sd = 0;          // their standard deviation; 0: not given, noise_u is used
};

struct Experiment {
  std::string name;
  std::vector<Observable> observables;
  std::vector<OperatingPoint> points;
  std::vector<Datum> data;              // by point, observable, replicate, time
  std::vector<std::string> candidates;  // empty: all
  std::vector<Alternative> alternatives{};
  std::vector<OwnCandidate> own_candidates{};
  std::vector<Region> regions{};
  bool pairs = true;
  int max_runs = 20000;
  std::filesystem::path runs;  // table of runs that were made elsewhere or before; empty: none
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, double>> costs{};  // of a test with another value of this input, in repeats; absent: 1
  std::string data_sha256, withheld_sha256;             // of all rows, of the rows of withheld points
};

/// Reads DIAGNOSIS.toml and the data file beside it. Throws Error(usage, io) that names file and line: missing unit, point without data,
/// withheld point named for training, repeats without scatter and noise_u, NaN, unknown observable, time that is not finite.
Experiment read_experiment(const std::filesystem::path& file);
Experiment read_experiment(const CaseFile& file);
/// The same file before its keys are read. Throws Error(usage, io).
CaseFile experiment_file(const std::filesystem::path& file);
/// Tables of the experiment file, for the manual.
std::vector<Section> experiment_sections();

}  // namespace snag
