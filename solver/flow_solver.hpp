#pragma once
// The flow solver: one time step of the incompressible equations of solver/fields/flow.hpp on any mesh.
#include <optional>
#include <string>
#include <vector>

#include "solver/balances.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/continuity.hpp"
#include "solver/divergence.hpp"
#include "solver/fields/rotating_zone.hpp"
#include "solver/flow_settings.hpp"
#include "solver/momentum.hpp"
#include "solver/turbulence/turbulence.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;

struct OuterReport {
  SweepReport momentum;
  ContinuityReport continuity;
  TurbulenceReport turbulence;
};

/// What one step did.
struct StepReport {
  std::vector<OuterReport> outer;
  double continuity_local = 0;   // largest |sum of fluxes| of a cell times dt over its volume
  double continuity_global = 0;  // net flux out of the domain, m3/s
  double courant_mean = 0, courant_max = 0;
  double seconds_momentum = 0, seconds_pressure = 0, seconds_turbulence = 0, seconds_rest = 0;
  double seconds_mesh = 0;  // of seconds_rest: turning the mesh, and all that follows from it
};

class FlowSolver {
 public:
  /// Laminar if no turbulence model is given. Throws Error(usage) if the conditions do not suit the mesh. Collective, as are all functions
  /// below.
  FlowSolver(const Mesh& mesh, const FlowSettings& settings, std::vector<PatchBoundary> boundary,
             std::unique_ptr<Turbulence> turbulence = nullptr, std::unique_ptr<RotatingZone> rotating_zone = nullptr);

  /// State of the water. Before the first step velocity, pressure, k and epsilon may be set (owned cells); the coupling sets reaction, drag
  /// and solid_fraction.
  Flow flow;

  /// Advance by dt, second order in space and time. Throws Error(diverged) that names step, field and place.
  StepReport advance(double dt);
  /// The water stays as it is for dt: a frozen field, for bodies that it carries. Not for a rotating zone.
  void advance_frozen(double dt);
  /// What the first step does before it begins: the velocity as it was given becomes divergence-free, gradients and halos are made. Once.
  /// Conditions on the boundary are those of the given time, s: of water from another run the time at which it is taken.
  void initialise(double boundary_time);

  /// Coefficients of d/dt in the last step.
  const TimeScheme& time_scheme() const { return time_; }
  /// From the next step on balances() are made, of the cells that turn and of the rest, about the axis. Collective.
  void keep_balances(const Vec3& origin, const Vec3& axis);
  /// Of angular momentum and of energy in the last step; null if they are not kept.
  const Balances* balances() const { return balances_ ? &*balances_ : nullptr; }

  /// Everything a resume needs; the same numbers to the bit on the same ranks. Names begin with "flow/".
  void save(CheckpointWriter& checkpoint) const;
  void load(CheckpointReader& checkpoint);
  /// Reads the water and its history from the checkpoint of another run on the same mesh, with its rotor at the same angle; the time stays
  /// 0. The next step is that of the other run if both slide or neither. Returns false, and reads nothing, if a field is missing.
  /// Collective.
  bool go_on_from(CheckpointReader& checkpoint);

  const FlowSettings& settings() const { return settings_; }
  const BoundarySet& boundary() const { return boundary_; }
  const Turbulence& turbulence() const { return *turbulence_; }
  /// Lets the bounds on the water know what the conditions will give until `end`, s.
  void foresee(double end) { watch_.foresee(flow, boundary_, end); }
  /// Bounds on the water; whoever puts moving bodies into it widens them.
  DivergenceWatch& watch() { return watch_; }
  const DivergenceWatch& watch() const { return watch_; }

 private:
  bool slides() const { return rotating_zone_ && rotating_zone_->slides(); }
  void find_rest_pressure();
  void begin_step(const TimeScheme& time, StepReport& report);
  void turn_mesh(double time);
  void turn_history(double angle);
  void fields_follow_facets();
  void correct_once(int outer, bool is_last, const TimeScheme& time, StepReport& report);
  void update_gradient();
  void measure(double dt, StepReport& report);
  void correct_turbulence(int outer, const TimeScheme& time, StepReport& report);
  void load_water(CheckpointReader& checkpoint);
  void load_preconditioner(CheckpointReader& checkpoint, double fresh_cost, bool rebuild_due);

  FlowSettings settings_;
  BoundarySet boundary_;
  Workspace workspace_;
  LeastSquares squares_;
  Momentum momentum_;
  Continuity continuity_;
  std::unique_ptr<Turbulence> turbulence_;
  std::unique_ptr<RotatingZone> rotating_zone_;
  DivergenceWatch watch_;
  std::optional<Balances> balances_;
  TimeScheme time_;
  bool started_ = false;
};

}  // namespace snag
