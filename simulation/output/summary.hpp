#pragma once
// summary.json: what came out of a run, for people, scripts and the report. Keys are stable, numbers in SI.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "observe/passage_result.hpp"
#include "simulation/output/balance_output.hpp"
#include "simulation/output/free_motion.hpp"
#include "simulation/output/pump_output.hpp"
#include "simulation/output/pump_record.hpp"
#include "simulation/output/step_record.hpp"
#include "solver/monitors.hpp"
#include "solver/turbulence/turbulence.hpp"

namespace snag {

struct RagSummary {
  int id = 0;
  std::string name;
  std::int64_t particles = 0, bonds = 0, broken_bonds = 0;
  PassageResult verdict;
  FreeMotionResult free_motion;
  PumpPassage pump;
  double elongation_ratio_at_start = 0, elongation_ratio = 0, projected_area = 0, max_wall_overlap_over_radius = 0,
         max_overlap_over_radius = 0, bond_strain_p99 = 0;
};

/// Of rags in computed water, over the whole run.
struct CouplingSummary {
  double kernel_width = 0;  // m; 0: that of one cell
  double width_over_cell_least = 0, width_over_cell_largest = 0;
  double max_solid_fraction = 0;
  // Of what the rags gave to the water; absent: they gave nothing.
  std::optional<double> force_share_at_walls;  // in cells at walls
  std::optional<double> force_displacement;    // mean distance from where it was given, m
  std::optional<double> couple_lost;           // over the torque of the forces about each rag's centre
};

struct WaterSummary {
  double speed_scale = 0, max_speed_over_scale = 0;  // m/s; 1
  int unsolved_steps = 0;                            // most in a row
  /// nu over the largest nu_t of the cells away from walls at the end, 1; absent: no turbulence model, or a Reynolds number without
  /// turbulence.
  std::optional<double> molecular_over_eddy_viscosity;
};

/// y+ at the walls, where a turbulence model is in use.
struct WallsSummary {
  struct PatchOfWall {
    std::string patch;
    YPlus y_plus;
  };
  WallTreatment treatment = WallTreatment::none;
  std::vector<PatchOfWall> patches;
};
/// The words of summary.json for it.
std::string name_of(WallTreatment treatment);

struct Summary {
  std::string case_name, case_sha256;
  int ranks = 1, exit = 0;
  double wall = 0, simulated = 0;  // s
  std::int64_t time_steps = 0;
  struct {
    std::int64_t cells = 0, interior_faces = 0, facets = 0;
    double min_quality = 0;
  } mesh;
  struct {
    double flow = 0, dem = 0, coupling = 0, output = 0;  // s of wall clock
    double cell_steps = 0, particle_steps = 0;
    std::int64_t peak_memory = 0;  // bytes, all ranks
  } performance;
  std::optional<StepRecord> auto_step;    // of [time] step = "auto"
  std::optional<PumpSummary> pump;        // of a case with [pump]
  std::optional<BalanceSummary> balance;  // of a case with a turning zone
  std::vector<RagSummary> rags;
  std::string error;                  // what ended the run early, empty if nothing did
  std::optional<WaterSummary> water;  // where it is computed
  std::optional<CouplingSummary> coupling;
  std::optional<WallsSummary> walls;  // with a turbulence model
  // relative; none where there is nothing to measure: no flow through, no two-way coupling, no interface, no rags
  struct {
    std::optional<double> mass_imbalance, momentum_exchange, interface_closure;
    std::optional<std::int64_t> particles_lost, bonds_lost, particles_beyond_walls;
  } conservation;
};

/// The summary in this file is that of a run of this case that ended as planned after this number of steps.
bool is_of_ended_run(const std::filesystem::path& file, const std::string& case_sha256, std::int64_t time_steps);

/// Outcome, times and recirculations of the first rag of a run in a folder; absent: its summary has no rag.
std::optional<PassageResult> first_passage(const std::filesystem::path& summary_file);

nlohmann::ordered_json summary_json(const Summary& summary);
/// Throws Error(io).
void write_summary(const std::filesystem::path& file, const Summary& summary);

/// Keys of all values that a summary can hold, "pump.head_m"; 0 stands for the number of a rag or of another entry of a list.
std::vector<std::string> summary_keys();

/// What most want to know, a line a rag and one for the pump; empty without both.
std::string results_in_words(const Summary& summary);

/// Peak resident memory of all ranks, bytes. Collective.
std::int64_t peak_memory();

}  // namespace snag
