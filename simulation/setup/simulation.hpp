#pragma once
// Everything a case is made of, put together: mesh, water, walls, rags, coupling. Each part may be absent.
#include <memory>
#include <optional>

#include "base/case_file.hpp"
#include "coupling/coupled_solver.hpp"
#include "coupling/pipe_flow.hpp"
#include "dem/contacts/contact_settings.hpp"
#include "dem/holds.hpp"
#include "dem/rag_system.hpp"
#include "dem/walls/walls.hpp"
#include "mesh/quality.hpp"
#include "simulation/setup/flow_cache.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/passage.hpp"
#include "simulation/setup/rag_poses.hpp"
#include "simulation/setup/settings.hpp"
#include "simulation/setup/speed_bounds.hpp"
#include "simulation/setup/start_flow.hpp"
#include "solver/flow_solver.hpp"
#include "solver/pump_monitor.hpp"

namespace snag {

struct Prepared;

class Simulation {
 public:
  /// Of a run that is resumed.
  struct Stored {
    std::optional<std::vector<int>> partition;  // rank of every cell
    CheckpointReader* checkpoint;               // null: none; with the poses; only while the simulation is built
  };
  /// Reads the whole case, refuses unknown keys, and builds. `store` holds a mesh and frozen water between runs, which then use it in turn;
  /// `prepared` the files of generated meshes and poses (null: made for this run alone). Collective; throws Error.
  Simulation(const CaseFile& file, MPI_Comm comm, Stored stored = {}, FlowCache* store = nullptr, Prepared* prepared = nullptr);
  ~Simulation();

  /// One step of time.step: water, rags, or both. Collective; throws Error.
  void step();
  /// The time loop: steps until the case has ended, or `goes_on()`, which is asked after each step, says no. Collective; throws Error.
  template <class GoesOn>
  void run(const GoesOn& goes_on) {
    while (!has_ended()) {
      step();
      if (!goes_on()) return;
    }
  }
  double time() const { return static_cast<double>(time_step_) * time_settings.step; }
  std::int64_t time_step() const { return time_step_; }
  /// All rags have left, and the case is to end then: now, or run_on ago.
  bool rags_have_left() const;
  /// There is no step left to do.
  bool has_ended() const { return time_step_ >= time_settings.n_steps() || rags_have_left(); }

  /// The state before the first step: the water of another run, if [initial_flow] names one, and the rags whose time has come, checked.
  /// Returns a line for the log, empty without such water. Collective; throws Error.
  std::string start();
  /// The coupling of these pieces and this water as another case has it; null where there is no water. Collective; throws Error.
  std::unique_ptr<CoupledSolver> coupling_of(const CaseFile& file);
  /// The water stays as [initial_flow] gives it.
  bool frozen() const { return start_settings_.frozen; }
  /// [pipe_flow]; not there without that table.
  const PipeFlow& pipe_flow() const { return pipe_flow_; }
  /// The case says that the water is laminar; it is not only for want of a model.
  bool laminar_asked() const { return laminar_asked_; }
  /// True if patches of the mesh are periodic.
  bool is_periodic() const { return periodic_; }
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);

  /// Looked at after each step: where the rags are, what they touch, whether their speed is possible. It takes as long as the step of one
  /// particle in a prescribed flow, and nobody leaves where there is no mesh.
  bool watches_rags = true;

  CaseSettings case_settings;
  TimeSettings time_settings;
  OutputSettings output_settings;
  CheckpointSettings checkpoint_settings;
  ObserveSettings observe_settings;

  // absent parts are null
  std::shared_ptr<Mesh> mesh;
  MeshQuality mesh_quality;
  WallSet walls;
  ContactSettings contacts;
  std::shared_ptr<FlowSolver> water;
  std::optional<PumpSettings> pump;  // of a case with a rotating zone
  std::unique_ptr<RagPoses> poses;
  std::unique_ptr<RagSystem> rags;
  std::unique_ptr<Holds> holds;  // none if no particle is held
  std::unique_ptr<CoupledSolver> coupled;
  std::unique_ptr<Passage> passage;
  StepReport flow_report;  // of the last step

  struct Seconds {
    double flow = 0, rags = 0, coupling = 0;
  };
  /// Wall clock spent since the start of this process, of the slowest rank. Collective.
  Seconds seconds() const;

 private:
  void read_mesh(const CaseFile& file);
  void build_water(const CaseFile& file);
  void read_pipe_flow(const Table& root);
  void read_pump(const Table& root);
  void build_rags(const CaseFile& file);
  void couple(const CaseFile& file);
  std::string start_water();
  void insert_rags();
  void move_water(double dt);
  void bound_speeds();
  void add_flow_velocity(int rag);
  void remove_rags();
  std::string patches_without_walls() const;
  void check_inside();

  MPI_Comm comm_;
  MeshSettings mesh_settings_;
  StartSettings start_settings_;
  std::filesystem::path start_folder_;
  Stored stored_;
  FlowCache* store_;
  Prepared* prepared_;
  CachedFlow* cached_flow_ = nullptr;  // of the store, for frozen water
  std::string mesh_key_;               // of the store
  std::optional<PrescribedFlow> prescribed_;
  PipeFlow pipe_flow_;
  std::unique_ptr<SpeedBounds> speed_bounds_;  // of the rags
  std::int64_t time_step_ = 0;
  double alone_seconds_ = 0;  // of water or rags without coupling
  bool laminar_asked_ = false, periodic_ = false, warned_of_particles_outside_ = false;
};

}  // namespace snag
