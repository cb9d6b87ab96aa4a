#pragma once
// What a run writes when, and what a resume keeps.
#include <filesystem>
#include <memory>
#include <string>

#include "base/atomic_file.hpp"
#include "base/case_file.hpp"
#include "base/monitor.hpp"
#include "simulation/output/balance_output.hpp"
#include "simulation/output/checkpoint_clock.hpp"
#include "simulation/output/field_output.hpp"
#include "simulation/output/free_motion.hpp"
#include "simulation/output/pump_output.hpp"
#include "simulation/output/rag_monitors.hpp"
#include "simulation/output/rag_output.hpp"
#include "simulation/output/report_writer.hpp"
#include "simulation/output/summary.hpp"
#include "simulation/output/wall_contact_output.hpp"
#include "simulation/setup/simulation.hpp"
#include "solver/monitors.hpp"

namespace snag {

/// Of the last outer corrector of a step.
struct WaterRecord {
  double time = 0;  // s
  std::int64_t time_step = 0;
  StepReport step;
  OuterReport outer;
};

/// What the water does at each patch of the mesh, m3/s, Pa, N.
struct PatchRecord {
  double time = 0;  // s
  std::vector<double> flow, pressure;
  std::vector<PatchForce> load;  // about the origin of the coordinates
};

/// y+ on each wall of a turbulence model.
struct WallRecord {
  double time = 0;  // s
  std::vector<YPlus> y_plus;
};

struct SilhouetteRecord {
  double time = 0;  // s
  std::size_t rag = 0;
  Silhouette seen;
};

/// Wall clock and work that led to a state, in all processes of the run.
struct Effort {
  double wall = 0, flow = 0, rags = 0, coupling = 0, output = 0;  // s
  double particle_steps = 0;
};

struct EffortRecord {
  double time = 0;  // s
  Effort spent;
};

class Outputs {
 public:
  /// Writes the resolved case and the poses of the rags, opens monitors and collections; after a resume what lies behind the simulation's
  /// time is cut. `begun`: MPI_Wtime() at the beginning of this process. Collective; throws Error(io).
  Outputs(std::filesystem::path folder, const CaseFile& file, Simulation& simulation, bool resume, double begun);
  /// Monitors of the step just done, and fields and a checkpoint where they are due; after the last step whoever ends the run writes it.
  /// Collective; throws Error(io).
  void after_step();
  /// State before the first step. Collective.
  void initial();
  /// With all monitors on the disk: a checkpoint is never ahead of them. Collective; throws Error(io).
  void write_checkpoint() const;
  /// summary.json, with what ended the run early, and the report where there is a writer; returns the code of the run: that of a check that
  /// fails where all else went well. Collective.
  ExitCode finish(ExitCode exit, const ReportWriter& write_report, const std::string& error = "");
  /// The past of this run. Collective.
  void load(CheckpointReader& reader);

 private:
  void open_monitors(bool resume);
  SeriesPlace series_in(const char* name, bool resume) const;
  void open_water(const std::shared_ptr<const FieldWriter>& writer, bool resume);
  void open_rags(const std::shared_ptr<const FieldWriter>& writer, bool resume);
  Effort effort() const;
  /// Open on rank 0.
  std::vector<const Series*> series() const;
  void write_monitors();
  void write_water_monitors();
  void write_rotor_monitors();
  void write_phase() const;
  void write_wall_monitors();
  void write_coupling_monitors();
  void write_rags();
  void summarise_rags(Summary& summary) const;
  void summarise_passages(Summary& summary) const;
  void summarise_checks(Summary& summary) const;
  bool due(double interval) const;
  void sync() const;
  /// What a resume needs of the past of this run. Collective.
  void save(CheckpointWriter& writer) const;

  std::filesystem::path folder_;
  const CaseFile& file_;
  Simulation& simulation_;
  CheckpointClock checkpoint_clock_;
  // open on rank 0
  Monitor<WaterRecord> residuals_;
  Monitor<PatchRecord> patches_;
  Monitor<WallRecord> wall_;
  Monitor<SilhouetteRecord> silhouettes_;
  Monitor<CouplingReport> coupling_;
  Monitor<EffortRecord> timing_;
  Monitor<HoldReaction> holds_;
  std::unique_ptr<FieldOutput> fields_;
  std::unique_ptr<WallOutput> walls_;
  std::unique_ptr<RagMonitors> rag_monitors_;
  std::optional<FreeMotion> free_motion_;    // of the rags
  std::vector<double> elongation_at_start_;  // [n_rags] of the first silhouette, on rank 0; 0: not seen yet
  std::unique_ptr<RagOutput> rag_output_;
  std::unique_ptr<WallContactOutput> wall_contacts_;
  RagForces forces_;  // of the last step
  std::unique_ptr<PumpOutput> pump_;
  std::unique_ptr<BalanceOutput> balance_;          // with a turning zone
  double fields_interval_ = 0, rags_interval_ = 0;  // s
  double seconds_ = 0;                              // spent here by this process
  double begun_;                                    // MPI_Wtime()
  Effort effort_before_;                            // up to the checkpoint that was resumed
  std::vector<int> walls_with_y_plus_;              // patches, none without a turbulence model
  std::vector<int> cells_at_walls_;                 // where rags and computed water meet
  double cross_section_ = 0;                        // of the water, for the scale of a flow rate, m2

  // over the whole run, kept by checkpoints: relative, m3/s, relative, m3/s
  double largest_exchange_ = 0, largest_imbalance_ = 0, largest_closure_ = 0, largest_through_ = 0;
  // The same of the coupling: relative, relative, relative; sums over the steps of |force| on the water, at walls and everywhere, N, and of
  // what coupling/force_places.hpp has: N s, N m s, N m s, N m s
  struct {
    double width_least = 0, width_largest = 0, solid_fraction = 0, force_at_walls = 0, force = 0;
    double impulse = 0, displaced = 0, couple_lost = 0, couple = 0;
  } coupled_;
};

}  // namespace snag
