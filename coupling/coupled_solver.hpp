#pragma once
// Water and rags together: the coupled time step.
#include <functional>

#include "base/monitor.hpp"
#include "coupling/cell_owner.hpp"
#include "coupling/coupling_settings.hpp"
#include "coupling/exchange.hpp"
#include "coupling/force_places.hpp"
#include "coupling/kernel_field.hpp"
#include "coupling/prescribed_field.hpp"
#include "dem/rag_system.hpp"

namespace snag {

/// What one step exchanged, for monitors; the same on every rank.
struct CouplingReport {
  double time = 0;                     // s
  Vec3 force_on_rags, force_on_water;  // means over the step, N; of the first only what reacts is the opposite of the second
  double momentum_exchange = 0;        // lost of what was exchanged, 1
  ForcePlaces places;
  double max_solid_fraction = 0;  // 1; above 1 rags are folded closer than the kernel resolves
  double max_drag_number = 0;     // dt K d, d: answer of the water to the particle, 1/kg
  double max_stiffness = 0;       // dt K/m
  double width_over_cell_least = 0, width_over_cell_largest = 0;
  std::int64_t particles_outside = 0;  // held by no cell
  std::int64_t points_outside = 0;     // the same, with further points by which the kernel finds cells
};

/// Seconds of wall clock spent on this rank.
struct CouplingSeconds {
  double flow = 0, rags = 0, coupling = 0;
};

class CoupledSolver {
 public:
  /// `advance_flow` takes the water from t to t + dt with flow.reaction. Arguments by reference must outlive the solver. `known`: of the
  /// mesh of the flow (Kernel), for this call. Collective.
  CoupledSolver(Coupling coupling, RagSystem& rags, Flow& flow, std::function<void(double dt)> advance_flow, KnownFactors* known = nullptr);
  /// Rags in a prescribed flow, one-way.
  CoupledSolver(Coupling coupling, RagSystem& rags, const PrescribedFlow& flow);

  /// Walls for forces that need them; `walls` must outlive the solver.
  void set_walls(const WallSet& walls) { load_->set_walls(walls); }
  /// One coupled step, t -> t + dt: staggered; drag implicit in the velocities of particles and water together.
  /// Collective. Throws Error(invariant) if the exchange made or lost momentum, or a particle or bond was lost; Error(usage) if the
  /// particles fill more of a cell than the drag law holds for.
  void step(double dt);
  /// Mean velocity of the water at the particles of a rag, m/s. Collective.
  Vec3 water_velocity(int rag);

  double time() const { return rags_.time(); }
  const Coupling& coupling() const { return coupling_; }
  const CouplingReport& report() const { return report_; }
  const CouplingSeconds& seconds() const { return seconds_; }
  /// What the water gave each particle of this rank in the last step, N s, in the order of ParticleList; without weight and buoyancy.
  /// Empty before the first step.
  const std::vector<Vec3>& impulses() const { return impulses_; }

  /// Columns of monitors/coupling.csv, of a report.
  static std::vector<Column<CouplingReport>> columns();

  /// What the next step needs of the last one. Flow and rags save themselves and are loaded before. Collective; throws Error(io).
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);

 private:
  void mesh_moved();
  void spread(double dt);
  void judge_packing();
  void write_report(double dt);

  Coupling coupling_;
  RagSystem& rags_;
  Flow* flow_ = nullptr;  // null: prescribed
  std::function<void(double)> advance_flow_;
  std::unique_ptr<CellOwner> owner_;
  std::unique_ptr<Kernel> kernel_;
  std::unique_ptr<WaterPrediction> prediction_;
  std::unique_ptr<KernelField> kernel_field_;
  std::unique_ptr<PrescribedField> prescribed_field_;
  std::unique_ptr<FluidLoad> load_;
  std::unique_ptr<Exchange> exchange_;
  bool screens_ = false;                // a force gives screens, and the water has eddies that they hinder
  std::vector<Vec3> impulses_, given_;  // of the last step: with what the water does not feel; I (coupling/exchange.hpp)
  CouplingReport report_;
  bool warned_of_packing_ = false;
  CouplingSeconds seconds_;
};

}  // namespace snag
