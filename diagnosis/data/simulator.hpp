#pragma once
// What the diagnosis sees of the physics: named effects, each one number, and runs that answer with the observables. The solver behind it
// is not seen (casework/ implements it; tests use formulas).
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace snag {

/// Something that the base model may lack. Its strength theta = 0 is the base model to the bit.
struct Effect {
  std::string name;                   // added_mass; names of candidates are fixed
  std::string parameter{};            // what theta is: "added-mass coefficient"
  std::string unit = "1";             // of theta
  double mean = 0, sd = 1;            // prior of theta given that the effect is there
  double minimum = 0, maximum = 1e9;  // physical range of theta
  bool is_share = false;              // of one law in the place of another: there is nothing beyond 1
  bool fixed = false;                 // there or not, at its mean: nothing of it is fitted
  bool random = false;                // runs with another seed give another result
  bool acts_on_water = false;         // cannot be expressed where the water is prescribed or replayed
  std::string blind{};                // why this base case cannot show it; empty: it can
  int n_forms = 1;                    // functional forms under which its law is written; a run takes one by its index
  bool exclusive_forms = false;       // its law is exactly one of them; else it may lie between them
  int n_deviations = 0;               // indices after them: one standard deviation of something else that its law leaves open
  double least = 0;                   // strengths below this size are not named
  bool is_mistake = false;            // of inputs or data (mistakes.hpp), no effect that the model lacks
  bool may_be_local = false;          // runs can have it behind a gate
  bool is_local = false;              // has a gate (Responses::add_local)
};

/// Where and when an effect acts that does not act everywhere: from a time on, while the centre of what moves is in a box.
struct Gate {
  static constexpr double far = 1e9;
  std::string effect;                                                   // its name
  double from = -far;                                                   // s
  std::array<double, 3> lower{-far, -far, -far}, upper{far, far, far};  // m

  /// Along which it opens: t, or x, y, z.
  std::string coordinate() const {
    if (from > -far) return "t";
    std::size_t axis = 0;
    while (axis < 2 && lower.at(axis) == -far && upper.at(axis) == far) ++axis;
    return {"xyz"[axis]};
  }
};

/// The whole flow field as an input. At all points by one factor it is what `operating_point` is, to the bit.
inline constexpr const char* flow_field = "flow.amplitude";

/// An input that is known up to a relative standard uncertainty; free with a tight prior in every hypothesis.
struct Nuisance {
  std::string name;         // "flow.amplitude", "drag_law_uncertainty", "camera" (a calibration group)
  double u = 0;             // standard uncertainty of its relative deviation (of a calibration group: in units of bias_u)
  std::vector<int> points;  // that share one deviation; each of several nuisances may have the same name at other points
};

/// One number that a run is asked for.
struct Slot {
  int observable = 0;
  double time = std::numeric_limits<double>::quiet_NaN();  // s; NaN: a scalar of the run
};

/// A run goes on from a measured state: at this time its pieces are moved, each as it lies, and made faster.
struct Restart {
  double time = 0;                               // s
  std::array<double, 3> position{}, velocity{};  // changes of both, m, m/s
};

/// One run of the model of an operating point.
struct RunRequest {
  int point = 0;
  std::map<std::string, double> effects;    // theta by name; absent: 0
  std::map<std::string, double> nuisances;  // relative deviation by name; absent: 0
  std::uint64_t seed = 0;                   // of random effects and of the initial pose
  double step_factor = 1;                   // time step over that of the case, for u_num
  std::map<std::string, int> forms{};       // of the effects, by name; absent: the first
  std::optional<Restart> restart{};         // absent: the run goes its own way
  std::optional<Gate> gate{};               // of one of the effects; absent: all act everywhere
};

struct RunResult {
  std::vector<double> values;  // at the slots of the point, SI; NaN: the run has no such number (not retained, left before)
  std::string failure;         // empty: it ran
};

/// Runs that did not come to their end.
struct FailedRuns {
  int n = 0;
  std::string why{};  // the first one did not
};

/// Collective over the ranks of the program; the same answers on every rank.
class Simulator {
 public:
  virtual ~Simulator() = default;
  /// All effects of the library, those that are blind here included, by name.
  virtual const std::vector<Effect>& effects() const = 0;
  virtual const std::vector<Nuisance>& nuisances() const = 0;
  /// What the runs of a point answer with.
  virtual const std::vector<Slot>& slots(int point) const = 0;
  /// Time at which the runs of a point end, s; NaN: not known.
  virtual double run_end(int) const { return std::numeric_limits<double>::quiet_NaN(); }
  /// Whether runs of a point can go on from a measured state.
  virtual bool restarts(int) const { return false; }
  /// Runs all of them, in parallel where it can; equal requests are run once and cached.
  virtual std::vector<RunResult> run(std::span<const RunRequest> requests) = 0;
  /// Runs done so far, without those from the cache.
  virtual int n_runs() const = 0;
  /// Distinct runs asked for so far, those from the cache among them: what a budget counts, the same after a new start.
  virtual int n_used() const { return n_runs(); }
  /// Those of them that were taken from a table of runs of whatever program.
  virtual int n_imported() const { return 0; }
  /// Of those that were used.
  virtual FailedRuns failed() const { return {}; }
};

}  // namespace snag
