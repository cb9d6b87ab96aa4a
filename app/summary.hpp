#pragma once
// summary.json: what came out of a run, for people, scripts and the report. Keys are stable, numbers in SI.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/pump_output.hpp"
#include "app/rag_journey.hpp"

namespace snag {

struct RagSummary {
  int id = 0;
  std::string name;
  std::int64_t particles = 0, bonds = 0, broken_bonds = 0;
  RagVerdict verdict;
  double elongation_ratio_at_start = 0, elongation_ratio = 0, projected_area = 0, max_wall_overlap_over_radius = 0,
         max_overlap_over_radius = 0, bond_strain_p99 = 0;
  std::int64_t corrected_positions = 0;
};

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
  std::optional<PumpSummary> pump;  // of a case with [pump]
  std::vector<RagSummary> rags;
  struct {
    double mass_imbalance = 0, momentum_exchange = 0;  // relative
    std::optional<double> interface_closure;           // relative; none without an interface
    std::int64_t particles_lost = 0, bonds_lost = 0, particles_beyond_walls = 0;
  } conservation;
};

/// The summary in this file is that of a run of this case that ended as planned after this number of steps.
bool is_of_ended_run(const std::filesystem::path& file, const std::string& case_sha256, std::int64_t time_steps);

/// Throws Error(io).
void write_summary(const std::filesystem::path& file, const Summary& summary);

/// Keys of all values that a summary can hold, "pump.head_m"; 0 stands for the number of a rag or of another entry of a list.
std::vector<std::string> summary_keys();

/// What most want to know, a line a rag and one for the pump; empty without both.
std::string results_in_words(const Summary& summary);

/// Peak resident memory of all ranks, bytes. Collective.
std::int64_t peak_memory();

}  // namespace snag
