// The end of a run: summary.json from the state of the simulation and the sums of the outputs, and the report.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/output/outputs.hpp"
#include "simulation/output/wall_cells.hpp"
#include "simulation/setup/case_reynolds.hpp"
#include "simulation/setup/checks.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

/// nu over the largest nu_t of the cells that no wall function sets: where it is above 1 in a flow that is turbulent, the turbulence has
/// died out in the computation. Collective.
std::optional<double> molecular_over_eddy_viscosity(const Simulation& simulation) {
  const Flow& flow = simulation.water->flow;
  const std::optional<CaseReynolds> Re = case_reynolds(simulation);
  if (!Re || Re->number < transition_of_a_pipe || sum(MPI_COMM_WORLD, static_cast<std::int64_t>(flow.eddy_viscosity.size())) == 0)
    return {};
  std::vector<char> at_wall(static_cast<std::size_t>(flow.mesh.n_cells), 0);
  for (const int c : cells_at_walls(*simulation.water)) at_wall[static_cast<std::size_t>(c)] = 1;
  double largest = -1;  // no cell yet
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    if (!at_wall[static_cast<std::size_t>(c)]) largest = std::max(largest, flow.eddy_viscosity[c]);
  largest = maximum(MPI_COMM_WORLD, largest);
  if (largest < 0) return {};
  const double molecular = flow.dynamic_viscosity / flow.density;
  return molecular / std::max(largest, 1e-12 * molecular);  // so that it is a number
}

/// The code of a run: that of the first check that fails where all else went well. Says which.
ExitCode judged(const Summary& summary, ExitCode exit) {
  if (exit != ExitCode::ok) return exit;
  for (const CheckedValue& one : checked(summary_json(summary))) {
    if (!one.fails()) continue;
    log::error("a check failed: " + failure_in_words(one));
    if (exit == ExitCode::ok) exit = one.check.code;
  }
  int code = static_cast<int>(exit);  // some of the summary is known on rank 0 only
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return static_cast<ExitCode>(code);
}

}  // namespace

void Outputs::summarise_rags(Summary& summary) const {
  if (!simulation_.rags) return;
  const RagSystem& rags = *simulation_.rags;
  const RagCounts left = rags.count();
  summary.conservation.particles_lost = summary.conservation.bonds_lost = 0;
  for (std::size_t r = 0; r < rags.rags().size(); ++r) {
    const Rag& rag = rags.rags()[r];
    RagSummary one;
    one.id = static_cast<int>(r), one.name = rag.name;
    one.particles = left.particles[r], one.bonds = left.bonds[r].whole, one.broken_bonds = left.bonds[r].broken;
    one.verdict = simulation_.passage->verdict(r);
    one.elongation_ratio = simulation_.passage->last_elongation(r);
    if (!rag_output_->silhouettes().empty()) {
      one.projected_area = rag_output_->silhouettes()[r].area;
      if (one.projected_area > 0) one.elongation_ratio = rag_output_->silhouettes()[r].elongation_ratio;
    }
    one.max_wall_overlap_over_radius = rag_monitors_->max_wall_overlap(r), one.max_overlap_over_radius = rag_monitors_->max_overlap();
    one.free_motion = free_motion_->result(r);
    one.bond_strain_p99 = rag_monitors_->max_bond_strain_p99(r), one.elongation_ratio_at_start = elongation_at_start_[r];
    summary.rags.push_back(one);
    if (rags.presence(static_cast<int>(r)) == RagSystem::Presence::waiting) continue;
    *summary.conservation.particles_lost += rag.n_particles - one.particles;
    *summary.conservation.bonds_lost += rag.n_bonds - one.bonds - one.broken_bonds;
  }
}

void Outputs::summarise_passages(Summary& summary) const {
  if (!pump_) return;
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) != 0) return;
    const PumpRecord pump(folder_ / "monitors");
    for (RagSummary& rag : summary.rags) rag.pump = pump.passage(rag.verdict.entered.value_or(NAN), rag.verdict.exited.value_or(NAN));
  });
}

void Outputs::summarise_checks(Summary& s) const {
  if (const FlowSolver* water = simulation_.frozen() ? nullptr : simulation_.water.get()) {
    s.water = {water->watch().speed(), water->watch().largest_speed_ratio(), water->watch().unsolved_steps(),
               molecular_over_eddy_viscosity(simulation_)};
    constexpr double least_share = 0.01;  // at shut-off nothing passes but round-off
    const double scale = std::max(largest_through_, least_share * water->watch().speed() * cross_section_);
    if (scale > 0) s.conservation.mass_imbalance = largest_imbalance_ / scale;
    if (const RotatingZone* zone = water->flow.rotating_zone) {
      s.mesh.facets = zone->mesh().n_facets_global();
      s.conservation.interface_closure = largest_closure_;
    }
  }
  if (simulation_.coupled && simulation_.water && simulation_.coupled->coupling().settings.two_way())
    s.conservation.momentum_exchange = largest_exchange_;
  if (simulation_.coupled && simulation_.water) {
    const Coupling& coupling = simulation_.coupled->coupling();
    const double width = coupling.kernel_width(simulation_.rags->rags());
    s.coupling = {
        coupling.shape->has_width() ? width : 0, coupled_.width_least, coupled_.width_largest, coupled_.solid_fraction, {}, {}, {}};
    if (coupled_.force > 0) s.coupling->force_share_at_walls = coupled_.force_at_walls / coupled_.force;
    if (coupled_.impulse > 0) s.coupling->force_displacement = coupled_.displaced / coupled_.impulse;
    if (coupled_.couple > 0) s.coupling->couple_lost = coupled_.couple_lost / coupled_.couple;
  }
  if (rag_monitors_) s.conservation.particles_beyond_walls = rag_monitors_->most_beyond_walls();
}

ExitCode Outputs::finish(ExitCode exit, const ReportWriter& write_report, const std::string& error) {
  Summary s;
  s.case_name = simulation_.case_settings.name;
  s.case_sha256 = file_.sha256();
  s.ranks = size_of(MPI_COMM_WORLD), s.error = error;
  s.simulated = simulation_.time(), s.time_steps = simulation_.time_step();
  if (simulation_.mesh)
    s.mesh = {simulation_.mesh->n_cells_global, simulation_.mesh->n_interior_global, 0, simulation_.mesh_quality.min_quality};
  summarise_rags(s);
  const Effort spent = effort();
  s.wall = spent.wall;
  s.performance = {spent.flow, spent.rags, spent.coupling, spent.output, 0, spent.particle_steps, peak_memory()};
  if (simulation_.mesh)
    s.performance.cell_steps = static_cast<double>(simulation_.time_step()) * static_cast<double>(simulation_.mesh->n_cells_global);
  summarise_checks(s);
  if (!walls_with_y_plus_.empty()) {
    s.walls.emplace().treatment = simulation_.water->turbulence().wall_treatment();
    for (const int patch : walls_with_y_plus_)
      s.walls->patches.push_back({simulation_.mesh->patches[patch].name, y_plus_of(simulation_.water->flow, patch)});
  }
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) s.auto_step = read_step_record(folder_);
  });
  if (balance_) s.balance = balance_->summary();
  if (pump_) {
    s.pump = pump_->summary();
    write_phase();
    summarise_passages(s);
  }
  const ExitCode code = judged(s, exit);
  s.exit = static_cast<int>(code);
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) write_summary(folder_ / "summary.json", s);
  });
  if (const std::string results = results_in_words(s); !results.empty()) log::info(results);
  if (exit == ExitCode::ok && simulation_.water && !simulation_.frozen()) {
    for (const std::string& one : simulation_.water->boundary().unmet(simulation_.water->flow)) log::warning(one);
    if (const std::string lone = simulation_.water->watch().lone_cell(simulation_.water->flow); !lone.empty()) log::warning(lone);
  }
  if (s.pump && s.pump->flow < 0)
    log::warning("[pump]: water leaves through the inlet \"" + simulation_.pump->inlet + "\" (" + rounded(-1e3 * s.pump->flow) +
                 " L/s): head and efficiency are those of the way from it to \"" + simulation_.pump->outlet +
                 "\"; exchange inlet and outlet if this is not meant");
  if (!write_report) return code;
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) write_report(folder_);
  });
  log::info("report: " + (folder_ / "report.html").string());
  return code;
}

}  // namespace snag
