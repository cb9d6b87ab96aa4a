#include "simulation/setup/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"
#include "mesh/bounding_box.hpp"
#include "mesh/geometry.hpp"
#include "parallel/quantile.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "simulation/setup/case_reynolds.hpp"
#include "solver/monitors.hpp"

namespace snag {

namespace {

constexpr double largest_turn = 30;  // degrees a step: 12 steps a revolution; the second order in time then errs by 9 %
constexpr double advised_turn =
    6;                           // degrees a step; with two outer correctors the head of a pump was then within 1 %, its torque within 2 %
constexpr double good_turn = 5;  // degrees a step, for the remedies
constexpr double advised_courant = 100;  // of the median cell without a rotor
constexpr double friction_speed = 0.05;  // u_tau/U
constexpr double viscous_layer = 11;     // y+ below which the wall function takes a cell for one at the edge of the log layer
// Orders of magnitude on one core of a present workstation; timing.csv of a run has those of this machine. Bytes of a cell: what the set-up
// of a pump of a million tetrahedra with k-epsilon takes at its peak, 1.7 kB on one rank, 2.0 kB on two (snag bench flow --level fine); a
// step takes 1.4 and 1.6 kB. Thin layers and other cells have more faces.
constexpr double seconds_per_cell_step = 4e-6, seconds_per_particle_step = 1e-7, bytes_per_cell = 2e3, bytes_per_particle = 2e3,
                 bytes_of_program = 1e8;

double degrees_a_step(const FlowSolver& water, double step) {
  const RotatingZone* zone = water.flow.rotating_zone;
  return zone && zone->slides() ? std::abs(zone->full_speed()) * step * 180 / std::numbers::pi : 0;
}

/// Of the walls of kind moving_wall, at the start. Collective.
double degrees_of_walls(const FlowSolver& water, double step) {
  double fastest = 0;
  for (const Vec3& spin : water.boundary().values().spin) fastest = std::max(fastest, norm(spin));
  return maximum(water.flow.mesh.comm, fastest) * step * 180 / std::numbers::pi;
}

void foresee_step(const Simulation& simulation, Forecast& result) {
  const FlowSolver& water = *simulation.water;
  const double step = simulation.time_settings.step, turn = degrees_a_step(water, step);
  const std::vector<double> courant = water.watch().courant_of(step);
  const auto of_cells = [&](double share) { return quantile(simulation.mesh->comm, courant, share); };
  const double median = of_cells(0.5);
  result.text += "speed of the case " + rounded(water.watch().speed()) + " m/s (" + water.watch().source() + "): Courant number a step " +
                 rounded(median) + " in the median cell, " + rounded(of_cells(0.99)) + " in 1 of 100, " + rounded(of_cells(1)) +
                 " in the smallest\n";
  if (turn > 0) result.text += "the rotor turns " + rounded(turn) + " degrees a step\n";
  if (turn > advised_turn)
    result.warnings.push_back("[time] step: the rotor turns " + rounded(turn) + " degrees a step, advised at most " +
                              rounded(advised_turn) + "; step_ms = " + rounded(1e3 * step * good_turn / turn) + " gives " +
                              rounded(good_turn));
  if (const double walls = degrees_of_walls(water, step); turn == 0 && walls > largest_turn && water.settings().n_outer_correctors == 1)
    result.warnings.push_back(
        "[time] step: the walls turn " + rounded(walls) + " degrees a step, advised at most " + rounded(largest_turn) +
        ": water that turns with them may become steady in a wrong state; step_ms = " + rounded(1e3 * step * largest_turn / walls) +
        " gives that, [flow] n_outer_correctors = 5 makes it right, too");
  if (turn == 0 && median > advised_courant)
    result.warnings.push_back("[time] step: at the speed of the case the median cell has a Courant number of " + rounded(median) +
                              ", advised at most " + rounded(advised_courant) +
                              "; step_ms = " + rounded(1e3 * step * advised_courant / median) + " gives that");
}

/// Warns of pyramids whose tips meet: a channel of them had up to 13 times its speed after 1 s, with two outer correctors 1.13 times.
void foresee_cells(const Simulation& simulation, Forecast& result) {
  const std::int64_t n = simulation.mesh_quality.n_meeting_pyramids;
  if (n > 0 && simulation.water->settings().n_outer_correctors == 1)
    result.warnings.push_back("[mesh] has " + counted(n, "pyramid") +
                              " whose tips meet at a point: with one outer corrector the flow there may grow to several times its speed; "
                              "[flow] n_outer_correctors = 2 prevents this");
}

/// Warns of openings whose velocity, as given at the start, lies along them: no water passes.
void foresee_flow_through_inlets(const Simulation& simulation, Forecast& result) {
  const Mesh& mesh = *simulation.mesh;
  const BoundarySet& boundary = simulation.water->boundary();
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p) {
    if (!boundary.is_open(p) || !boundary.velocity_is_given(p)) continue;
    double through = 0, along = 0;
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
      const Vec3& u = boundary.values().velocity[f - mesh.n_interior];
      through += std::abs(dot(u, mesh.face_vector[f])), along += norm(u) * norm(mesh.face_vector[f]);
    }
    through = sum(mesh.comm, through), along = sum(mesh.comm, along);
    if (along > 0 && through < 1e-6 * along)
      result.warnings.push_back("[[boundary]] \"" + mesh.patches[p].name +
                                "\": the velocity lies along the patch, no water passes; check its direction, or give kind = "
                                "\"moving_wall\" or \"symmetry\"");
  }
}

/// Warns of eddies that are larger than the opening through which they enter.
void foresee_inlets(const Simulation& simulation, Forecast& result) {
  const BoundarySet& boundary = simulation.water->boundary();
  for (int p = 0; p < static_cast<int>(simulation.mesh->patches.size()); ++p) {
    const InletTurbulence& entering = boundary.turbulence(p);
    if (boundary.is_open(p) && entering.length_scale.value_or(0) > entering.diameter)
      result.warnings.push_back("[[boundary]] \"" + simulation.mesh->patches[p].name + "\": turbulence_length_scale is " +
                                rounded(1e3 * *entering.length_scale) + " mm, wider than the patch, " + rounded(1e3 * entering.diameter) +
                                " mm; in pipes it is 0.07 of the diameter");
  }
}

/// Speed of the water along a patch, m/s: that of the rim where the patch turns, else that of the case without the rotor's.
double speed_at(const Simulation& simulation, int patch) {
  const Mesh& mesh = *simulation.mesh;
  const RotatingZone* zone = simulation.water->flow.rotating_zone;
  double speed = 0;
  for (int f = mesh.patches[patch].first; zone && f < mesh.patches[patch].end(); ++f)
    if (mesh.cell_zone[mesh.owner[f]] == zone->zone())
      speed = std::max(speed, norm(cross(zone->full_speed() * zone->axis(), mesh.face_centre[f] - zone->origin())));
  speed = maximum(mesh.comm, speed);
  return speed > 0 ? speed : simulation.water->watch().speed();
}

void foresee_walls(const Simulation& simulation, Forecast& result) {
  const Mesh& mesh = *simulation.mesh;
  const Flow& flow = simulation.water->flow;
  const double nu = flow.dynamic_viscosity / flow.density;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p) {
    if (!simulation.water->boundary().is_wall(p) || mesh.patches[p].count_global == 0) continue;
    const double u_tau = friction_speed * speed_at(simulation, p);
    std::vector<double> y_plus;
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f)
      y_plus.push_back(std::abs(dot(mesh.delta[f], mesh.face_vector[f])) / norm(mesh.face_vector[f]) * u_tau / nu);
    const auto of_faces = [&](double share) { return quantile(mesh.comm, y_plus, share); };
    const double median = of_faces(0.5), distance = median * nu / u_tau, roughness = simulation.water->boundary().roughness(p);
    if (roughness > distance)
      result.warnings.push_back("[[boundary]] \"" + mesh.patches[p].name + "\": roughness_height is " + rounded(1e3 * roughness) +
                                " mm, more than the " + rounded(1e3 * distance) +
                                " mm from the wall to the median cell centre: the law of the rough wall does not hold there; check the "
                                "unit, or make the cells at the wall thicker");
    result.text += "y+ on " + mesh.patches[p].name + ": about " + rounded(of_faces(0)) + " to " + rounded(of_faces(1)) + ", median " +
                   rounded(median) + "\n";
    if (simulation.water->turbulence().wall_treatment() == WallTreatment::wall_functions && median < viscous_layer)
      result.text += "  a cell below " + rounded(viscous_layer) + " counts as one at " + rounded(viscous_layer) +
                     ": cells at the wall may be thicker, y+ 30 to 300, with the same friction and longer steps\n";
  }
}

/// Laminar where the flow is turbulent.
void foresee_transition(const Simulation& simulation, Forecast& result) {
  const std::optional<CaseReynolds> found = case_reynolds(simulation);
  if (!found) return;
  const double Re = found->number;
  result.text += "Reynolds number " + rounded(Re) + " with the speed of the case and the width of " + found->width_of + ", " +
                 rounded(found->width) + " m\n";
  if (simulation.water->flow.turbulent_kinetic_energy.empty() && !simulation.laminar_asked() && Re > transition_of_a_pipe)
    result.warnings.push_back("the flow is computed as laminar at a Reynolds number of " + rounded(Re) + ", turbulent above some " +
                              rounded(transition_of_a_pipe) +
                              "; give [turbulence] model = \"k_epsilon\", or model = \"laminar\" where that is meant");
}

void foresee_cost(const Simulation& simulation, Forecast& result) {
  const std::int64_t n_steps = simulation.time_settings.n_steps();
  const double step = simulation.time_settings.step;
  double cost = 0, memory = bytes_of_program;  // s, bytes
  result.text += std::to_string(n_steps) + " steps of " + rounded(step) + " s";
  if (simulation.mesh && !simulation.frozen()) {
    cost += static_cast<double>(n_steps * simulation.mesh->n_cells_global) * seconds_per_cell_step;
    memory += static_cast<double>(simulation.mesh->n_cells_global) * bytes_per_cell;
  }
  if (simulation.rags) {
    const double sub_steps = std::max(1.0, std::ceil(step / simulation.rags->stable_step() * (1 - 1e-12)));
    result.text += ", each of " + counted(static_cast<std::int64_t>(sub_steps), "sub-step") + " of the rags";
    cost += static_cast<double>(simulation.rags->n_particles() * n_steps) * sub_steps * seconds_per_particle_step;
    memory += static_cast<double>(simulation.rags->n_particles()) * bytes_per_particle;
  }
  const int ranks = size_of(MPI_COMM_WORLD);
  result.text += "\ncost: about " + duration(cost / ranks) + " on " + counted(ranks, "rank") + ", " + rounded(memory / 1e9) + " GB";
}

}  // namespace

Forecast forecast(const Simulation& simulation) {
  Forecast result;
  if (simulation.water && !simulation.frozen()) {
    foresee_step(simulation, result);
    foresee_cells(simulation, result);
    foresee_flow_through_inlets(simulation, result);
    foresee_transition(simulation, result);
    if (!simulation.water->flow.turbulent_kinetic_energy.empty()) foresee_walls(simulation, result), foresee_inlets(simulation, result);
  }
  foresee_cost(simulation, result);
  return result;
}

void check_turn(const FlowSolver& water, double step) {
  const double turn = degrees_a_step(water, step);
  if (turn > largest_turn)
    throw Error(ExitCode::usage, "[time] step = " + number_text(step) + " s: the rotor turns " + rounded(turn) +
                                     " degrees in it, must not exceed " + rounded(largest_turn) +
                                     "; step_ms = " + rounded(1e3 * step * good_turn / turn) + " gives " + rounded(good_turn));
}

std::vector<Vec3> places_of_cloth(const Simulation& simulation) {
  std::vector<Vec3> places;
  const RagSystem& rags = *simulation.rags;
  for (const Tile& tile : rags.tiles()) for_particles(tile, [&](int k, int, int) { places.push_back(tile.vector(Tile::x, k)); });
  for (std::size_t r = 0; r < rags.rags().size() && rank_of(rags.comm()) == 0; ++r) {
    if (rags.presence(static_cast<int>(r)) != RagSystem::Presence::waiting) continue;
    const RagPiece& piece = rags.pieces()[r];
    for (int row = 0; row < rags.rags()[r].n_rows; ++row)
      for (int column = 0; column < rags.rags()[r].n_columns; ++column)
        if (piece.exists(column, row)) places.push_back(piece.pose(column, row).position);
  }
  return places;
}

}  // namespace snag
