#include "solver/divergence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/bounding_box.hpp"
#include "mesh/quality.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "solver/convection/convection.hpp"
#include "solver/convection/limiter.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int foreseen_times = 64;    // instants of a run at which its conditions are looked at, with the knots of tables
constexpr double least_speed = 1e-6;  // m/s; slower water cannot be told from round-off

// From which on a cause is named in the advice.
constexpr double large_turn = 5;        // degrees a step; steps of 1.4 to 5.8 degrees give the same head within 0.2 %
constexpr double large_courant = 10;    // with the speed of the case through the cell
constexpr double poor_quality = 0.1;    // 1 is a regular cell
constexpr double oblique_faces = 70;    // degrees
constexpr double large_skewness = 1;    // distance of the face centre from the line of centres over that line's length
constexpr double large_backflow = 0.1;  // of the volume through a patch

// Speed of a cell over that of the fastest cell around it: up to 1.25 in pumps of 16,000 to 92,000 cells that run well, 1.6 to 2.9 in cells
// at sharp edges with a wrong pressure.
constexpr double lone_ratio = 1.5;

enum Bound : int { velocity, k, courant, pressure, lost_volume };
const char* const bound_names[] = {"velocity in m/s", "square root of k in m/s", "speed through the faces in m/s",
                                   "range of pressure in Pa", "volume that leaves in a step over that of the cell"};

/// What is no number is beyond every bound.
double ratio(double value, double bound) { return value <= infinite && value >= -infinite ? value / bound : infinite; }

}  // namespace

/// The worst value of all cells.
struct DivergenceWatch::Finding {
  double ratio = -1;  // over its bound
  std::int64_t id = std::numeric_limits<std::int64_t>::max();
  int bound = velocity, cell = -1, rank = 0;  // `cell` counts on its rank
  double value = 0, limit = 0;
  Vec3 place{};
  std::int64_t step = 0;
  double time = 0;  // s

  bool is_worse_than(const Finding& other) const { return ratio > other.ratio || (ratio == other.ratio && id < other.id); }
  void see(const Finding& candidate) {
    if (candidate.is_worse_than(*this)) *this = candidate;
  }
};

DivergenceWatch::DivergenceWatch(const Mesh& mesh, const FlowSettings& settings)
    : mesh_(mesh), settings_(settings), area_(static_cast<std::size_t>(mesh.n_all_cells())) {
  for (int f = 0; f < mesh.n_faces; ++f) {
    const auto area = static_cast<float>(norm(mesh.face_vector[f]));
    area_[mesh.owner[f]] += area;
    if (mesh.neighbour[f] >= 0) area_[mesh.neighbour[f]] += area;
  }
  length_ = bounding_box(mesh).diagonal();
  const TurningPose& turning = mesh.turning;
  for (int c = 0; c < mesh.n_cells && turning.zone >= 0; ++c)
    if (mesh.cell_zone[c] == turning.zone)
      tip_radius_ = std::max(tip_radius_, norm(cross(turning.axis, mesh.cell_centre[c] - turning.origin)));
  tip_radius_ = maximum(mesh.comm, tip_radius_);
}

void DivergenceWatch::widen(double speed, const std::string& what) {
  if (speed > speed_) speed_ = speed, source_ = what;
}

void DivergenceWatch::begin(const Flow& flow) {
  std::vector<double> energy, volume;
  double k = 0, low = infinite, high = -infinite;  // m2/s2, Pa
  for (int c = 0; c < mesh_.n_cells; ++c) {
    low = std::min(low, flow.pressure[c]), high = std::max(high, flow.pressure[c]);
    energy.push_back(mesh_.cell_volume[c] * norm_squared(flow.velocity[c])), volume.push_back(mesh_.cell_volume[c]);
    if (!flow.turbulent_kinetic_energy.empty()) k = std::max(k, flow.turbulent_kinetic_energy[c]);
  }
  widen(std::sqrt(sum(mesh_.comm, energy) / sum(mesh_.comm, volume)), "water at the start");
  widen(std::sqrt(maximum(mesh_.comm, k)), "k at the start");
  widen(std::sqrt(2 * (maximum(mesh_.comm, high) - minimum(mesh_.comm, low)) / flow.density), "pressure at the start");
  if (flow.rotating_zone) widen(std::abs(flow.rotating_zone->full_speed()) * tip_radius_, "rim of the turning zone");
}

void DivergenceWatch::foresee(const Flow& flow, BoundarySet& boundary, double end) {
  const std::vector<double> state = boundary.state();
  std::vector<double> times = boundary.knots();
  std::erase_if(times, [&](double time) { return !(flow.time < time && time < end); });
  for (int i = 0; i <= foreseen_times; ++i) times.push_back(flow.time + (end - flow.time) * i / foreseen_times);
  std::sort(times.begin(), times.end());
  for (const double time : times) {
    boundary.update(flow, time);
    see_conditions(flow, boundary, time);
  }
  boundary.restore_state(state);
  boundary.update(flow, flow.time);
  boundary.restore_state(state);
  if (flow.rotating_zone) widen(std::abs(flow.rotating_zone->full_speed()) * tip_radius_, "rim of the turning zone");
}

std::vector<double> DivergenceWatch::courant_of(double dt) const {
  std::vector<double> courant(static_cast<std::size_t>(mesh_.n_cells));
  for (int c = 0; c < mesh_.n_cells; ++c) courant[c] = 0.5 * dt * speed_ * area_[c] / mesh_.cell_volume[c];
  return courant;
}

/// What patches give at a time. Of a pressure without the dynamic head that entering water takes from it: that would grow with the speed of
/// a flow that diverges.
void DivergenceWatch::see_conditions(const Flow& flow, const BoundarySet& boundary, double time) {
  std::array<double, 3> largest{0, -infinite, -infinite};  // speed, p, -p
  for (int p = 0; p < static_cast<int>(mesh_.patches.size()); ++p) {
    if (boundary.velocity_is_given(p))
      for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f)
        largest[0] = std::max(largest[0], norm(boundary.values().velocity[f - mesh_.n_interior]));
    if (boundary.pressure_side(p) == Side::value) {
      const double given = boundary.given_pressure(p, time);
      largest[1] = std::max(largest[1], given), largest[2] = std::max(largest[2], -given);
    }
    if (const auto& entering = boundary.turbulence(p).k) largest[0] = std::max(largest[0], std::sqrt(*entering));
  }
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 3, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  const double given_range = std::max(0.0, largest[1] + largest[2]);
  widen(largest[0], "speed given at a patch");
  widen(std::sqrt(2 * (given_range + norm(flow.body_force) * length_) / flow.density), "pressures given at patches and body force");
}

/// Speed that forces gave the water in the step that was done.
void DivergenceWatch::see_forces(const Flow& flow) {
  Vec3 by_rags;  // N
  double volume = 0;
  for (int c = 0; c < mesh_.n_cells; ++c) volume += mesh_.cell_volume[c];
  for (std::size_t c = 0; c < flow.reaction.size(); ++c) by_rags += mesh_.cell_volume[c] * flow.reaction[c];
  const Vec3 mean = sum(mesh_.comm, std::span<const Vec3>(&by_rags, 1)) / sum(mesh_.comm, volume);  // N/m3
  gained_speed_ += flow.time_step_size * norm(flow.body_force + mean) / flow.density;
  widen(gained_speed_, "forces on the water since the start");
}

DivergenceWatch::Finding DivergenceWatch::worst(const Flow& flow, double dt, const CellFluxes* fluxes) const {
  const double scale = std::max(speed_, least_speed), fastest = DivergenceBounds::speed * scale;
  const bool turbulent = !flow.turbulent_kinetic_energy.empty();
  Finding found;
  found.rank = rank_of(mesh_.comm);
  std::array<double, 3> range{-infinite, -infinite, -infinite};  // p, -p, -V
  Finding extreme{.ratio = -1};                                  // of pressure: the largest magnitude
  const auto see = [&](Bound bound, int c, double value, double limit) {
    const double share = ratio(value, limit);
    if (share >= found.ratio) found.see({share, mesh_.cell_id[c], bound, c, found.rank, value, limit, mesh_.cell_centre[c]});
  };
  for (int c = 0; c < mesh_.n_cells; ++c) {
    see(velocity, c, norm(flow.velocity[c]), fastest);
    if (turbulent) see(k, c, std::sqrt(flow.turbulent_kinetic_energy[c]), fastest);
    if (fluxes) see(courant, c, fluxes->through[c] / area_[c], fastest);
    if (fluxes) see(lost_volume, c, std::abs(fluxes->net[c]) * dt / mesh_.cell_volume[c], DivergenceBounds::lost_volume);
    const double p = flow.pressure[c];
    range = {std::max(range[0], p), std::max(range[1], -p), std::max(range[2], -mesh_.cell_volume[c])};
    if (const double size = ratio(std::abs(p), 1); size >= extreme.ratio)
      extreme.see({size, mesh_.cell_id[c], pressure, c, found.rank, 0, 0, mesh_.cell_centre[c]});
  }
  MPI_Allreduce(MPI_IN_PLACE, range.data(), 3, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  const double least_size = std::cbrt(-range[2]);
  const double pressure_limit = flow.density * (fastest * fastest / 2 + scale * length_ / dt) +
                                12 * flow.dynamic_viscosity * fastest * length_ / (least_size * least_size);
  // The cell with the extreme pressure stands for the range; all ranks offer theirs, the largest magnitude wins below.
  std::vector<Finding> all(static_cast<std::size_t>(size_of(mesh_.comm))), extremes(all.size());
  MPI_Allgather(&found, sizeof(Finding), MPI_BYTE, all.data(), sizeof(Finding), MPI_BYTE, mesh_.comm);
  MPI_Allgather(&extreme, sizeof(Finding), MPI_BYTE, extremes.data(), sizeof(Finding), MPI_BYTE, mesh_.comm);
  for (const Finding& other : all) found.see(other);
  for (const Finding& other : extremes) extreme.see(other);
  extreme.value = extreme.ratio == infinite ? infinite : range[0] + range[1], extreme.limit = pressure_limit;
  extreme.ratio = ratio(extreme.value, pressure_limit);
  found.see(extreme);
  found.step = flow.time_step, found.time = flow.time;
  return found;
}

void DivergenceWatch::check(const Flow& flow, const BoundarySet& boundary, const CellFluxes& fluxes, const StepReport& report) {
  see_conditions(flow, boundary, flow.time);
  see_forces(flow);
  const Finding found = worst(flow, flow.time_step_size, &fluxes);
  if (found.bound != lost_volume && found.bound != pressure)
    largest_ratio_ = std::max(largest_ratio_, found.ratio * DivergenceBounds::speed);
  if (!(found.ratio <= 1))
    throw_at(flow, boundary, flow.time_step_size, found,
             std::string(bound_names[found.bound]) + " is " + rounded(found.value) + ", must not exceed " + rounded(found.limit));
  count_unsolved(flow, boundary, report);
}

std::string DivergenceWatch::lone_cell(const Flow& flow) const {
  std::vector<double> around(static_cast<std::size_t>(mesh_.n_all_cells()));  // speed of the fastest neighbour
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    around[P] = std::max(around[P], norm(flow.velocity[N])), around[N] = std::max(around[N], norm(flow.velocity[P]));
  }
  Finding found;
  for (int c = 0; c < mesh_.n_cells; ++c)
    if (const double speed = norm(flow.velocity[c]); around[c] > 0 && speed > std::max(speed_, least_speed))
      found.see({speed / around[c], mesh_.cell_id[c], velocity, c, 0, speed, around[c], mesh_.cell_centre[c]});
  std::vector<Finding> all(static_cast<std::size_t>(size_of(mesh_.comm)));
  MPI_Allgather(&found, sizeof(Finding), MPI_BYTE, all.data(), sizeof(Finding), MPI_BYTE, mesh_.comm);
  for (const Finding& other : all) found.see(other);
  if (found.ratio < lone_ratio) return {};
  return "the water of cell " + std::to_string(found.id) + " at " + point_text(found.place) + " moves with " + rounded(found.value) +
         " m/s, that of the cells around it with " + rounded(found.limit) + " m/s at most, the case with " + rounded(speed_) + " m/s (" +
         source_ + "): its velocity is wrong; refine the mesh there, halve [time] step, or give [flow] n_outer_correctors = 2";
}

void DivergenceWatch::count_unsolved(const Flow& flow, const BoundarySet& boundary, const StepReport& report) {
  if (report.outer.empty()) return;
  const OuterReport& last = report.outer.back();
  const auto is_unsolved = [](const SweepReport& sweeps) { return !sweeps.converged && !(sweeps.final <= DivergenceBounds::residual); };
  const auto& equations = last.turbulence.equations;
  const bool unsolved = last.turbulence.raised_cells > 0 ||  // k or epsilon has fallen without end
                        std::any_of(equations.begin(), equations.end(), [&](const auto& equation) { return is_unsolved(equation.sweeps); });
  unsolved_turbulence_ = unsolved ? unsolved_turbulence_ + 1 : 0;
  unsolved_ = is_unsolved(last.momentum) ? unsolved_ + 1 : 0;
  most_unsolved_ = std::max(most_unsolved_, unsolved_);
  if (unsolved_ > DivergenceBounds::unsolved_steps)
    throw_at(flow, boundary, flow.time_step_size, worst(flow, flow.time_step_size, nullptr),
             "the equation of momentum was not solved in " + std::to_string(unsolved_) + " steps one after the other (residual " +
                 rounded(last.momentum.final) + ", must be below " + rounded(DivergenceBounds::residual) + ")");
}

void DivergenceWatch::fail(const Flow& flow, const BoundarySet& boundary, double dt, const std::string& what) const {
  Finding found = worst(flow, dt, nullptr);
  ++found.step, found.time += dt;
  throw_at(flow, boundary, dt, found, what + "; worst " + bound_names[found.bound] + " " + rounded(found.value));
}

/// What is wrong at an opening near the place: a sentence, or nothing.
std::string DivergenceWatch::fault_of_opening(const Flow& flow, const BoundarySet& boundary, const Finding& found) const {
  for (int p = 0; p < static_cast<int>(mesh_.patches.size()); ++p) {
    if (!boundary.is_open(p)) continue;
    double in = 0, through = 0, area = 0, distance = infinite;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      in += std::max(0.0, -flow.flux[f]), through += std::abs(flow.flux[f]), area += norm(mesh_.face_vector[f]);
      distance = std::min(distance, norm(mesh_.face_centre[f] - found.place));
    }
    in = sum(mesh_.comm, in), through = sum(mesh_.comm, through), area = sum(mesh_.comm, area);
    if (minimum(mesh_.comm, distance) > std::sqrt(area) / 2) continue;
    const std::string name = "\"" + mesh_.patches[p].name + "\"";
    if (boundary.is_outlet(p) && in > large_backflow * through)
      return "water enters again through the outlet " + name + " (" + rounded(100 * in / through) +
             " % of what passes): put the outlet at the end of a longer straight pipe";
    if (const std::string change = boundary.advice(p); !change.empty()) return "at patch " + name + " try " + change;
  }
  return {};
}

std::string DivergenceWatch::cell_in_words(const Finding& found) const {
  const CellQuality shape = quality_of_cell(mesh_, found.cell);
  const std::string zone = mesh_.zones.empty() ? "" : ", zone \"" + mesh_.zones[mesh_.cell_zone[found.cell]] + "\"";
  return "cell " + std::to_string(found.id) + " at " + point_text(found.place) + zone + ", quality " + rounded(shape.quality) +
         " (1 is a regular cell), non-orthogonality " + rounded(shape.non_orthogonality_deg) + " degrees, skewness " +
         rounded(shape.skewness);
}

/// What can be wrong at this cell, the likeliest cause first. Local: on the rank of the cell.
std::string DivergenceWatch::advice(const Flow& flow, const Finding& found, double dt) const {
  std::vector<std::string> causes;
  const RotatingZone* zone = flow.rotating_zone;
  const double turn = zone && zone->slides() ? std::abs(zone->speed(flow.time)) * dt * 180 / std::numbers::pi : 0;
  if (turn > large_turn)
    causes.push_back("the rotor turns " + rounded(turn) + " degrees a step: [time] step_ms = " + rounded(1e3 * dt * large_turn / turn) +
                     " gives 5");
  const auto scheme = convection_schemes().make(settings_.convection, "[flow] convection");
  if (!scheme->is_bounded() || (scheme->is_limited() && !limiters().make(settings_.limiter, "[flow] limiter")->bounds()))
    causes.push_back("[flow] convection = \"" + settings_.convection + "\" with limiter = \"" + settings_.limiter +
                     "\" is not bounded: use linear_upwind with limiter = \"venkatakrishnan\"");
  const CellQuality shape = quality_of_cell(mesh_, found.cell);
  if (shape.quality < poor_quality || shape.non_orthogonality_deg > oblique_faces || shape.skewness > large_skewness)
    causes.push_back("the mesh is poor at this cell: refine or optimise it there (quality above " + rounded(poor_quality) +
                     ", non-orthogonality below " + rounded(oblique_faces) + " degrees, skewness below " + rounded(large_skewness) + ")");
  if (!flow.reaction.empty() && flow.reaction[found.cell] != Vec3{})
    causes.push_back("a rag is in this cell: a wider [coupling] kernel_width softens its force on the water");
  const double courant = 0.5 * dt * speed_ * area_[found.cell] / mesh_.cell_volume[found.cell];
  if (turn <= large_turn && courant > large_courant)
    causes.push_back("the speed of the case gives this cell a Courant number of " + rounded(courant) +
                     ": [time] step_ms = " + rounded(1e3 * dt * large_courant / courant) + " gives " + rounded(large_courant));
  if (causes.empty() && settings_.n_outer_correctors < 2) causes.push_back("[flow] n_outer_correctors = 2 makes steps more robust");
  if (causes.empty())
    causes.push_back(
        "halve [time] step; where that changes nothing, refine the mesh there, or use [flow] convection = \"upwind\", "
        "which is of first order");
  std::string text = causes.front();
  for (std::size_t i = 1; i < causes.size(); ++i) text += "; also, " + causes[i];
  return text;
}

void DivergenceWatch::throw_at(const Flow& flow, const BoundarySet& boundary, double dt, const Finding& found,
                               const std::string& what) const {
  const std::string opening = fault_of_opening(flow, boundary, found);
  on_all_ranks(mesh_.comm, [&] {
    if (rank_of(mesh_.comm) != found.rank) return;
    throw Error(ExitCode::diverged, "the water diverged in step " + std::to_string(found.step) + " (t = " + number_text(found.time) +
                                        " s): " + what + " in " + cell_in_words(found) + "; the case has a speed of " + rounded(speed_) +
                                        " m/s (" + source_ + "); " + (opening.empty() ? "" : opening + "; also, ") +
                                        advice(flow, found, dt));
  });
  throw Error(ExitCode::diverged, what);  // not reached: the rank of the cell has thrown
}

void DivergenceWatch::save(CheckpointWriter& checkpoint) const {
  checkpoint.shared("flow/divergence", std::vector<double>{speed_, gained_speed_, largest_ratio_, static_cast<double>(unsolved_),
                                                           static_cast<double>(unsolved_turbulence_), static_cast<double>(most_unsolved_)});
}

void DivergenceWatch::load(CheckpointReader& checkpoint) {
  const std::vector<double> stored = checkpoint.shared("flow/divergence");
  widen(stored.at(0), "of the run so far");
  gained_speed_ = stored.at(1), largest_ratio_ = stored.at(2);
  unsolved_ = static_cast<int>(stored.at(3)), unsolved_turbulence_ = static_cast<int>(stored.at(4)),
  most_unsolved_ = static_cast<int>(stored.at(5));
}

}  // namespace snag
