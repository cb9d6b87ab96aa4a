#include "simulation/setup/start_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/flat.hpp"
#include "base/words.hpp"
#include "mesh/point_tree.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/checkpoint_slots.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

const char* const velocity_name = "flow/velocity";
const char* const centre_name = "mesh/cell_centre";
constexpr double same_place = 1e-3;      // of a cell's width: centres of one mesh agree to its rounding
constexpr std::size_t equally_near = 8;  // cells about a node of a regular mesh

std::span<const std::int64_t> owned_ids(const Mesh& mesh) { return {mesh.cell_id.data(), static_cast<std::size_t>(mesh.n_cells)}; }

std::vector<Vec3> centres_of(CheckpointReader& reader, std::span<const std::int64_t> ids) {
  const auto stored = reader.rows(centre_name, ids, 3);
  std::vector<Vec3> centres(ids.size());
  std::copy(stored.begin(), stored.end(), flat(centres).begin());
  return centres;
}

void check_checkpoint(MPI_Comm comm, const std::filesystem::path& folder, const std::string& where) {
  const auto slots = checkpoint_slots(comm, folder);
  if (newest(slots) >= 0) return;
  throw Error(ExitCode::io, where + ": " + folder.string() + " has no valid checkpoint (" + states(slots) +
                                "); name the output folder of a run with water that has ended or written a checkpoint");
}

/// Throws unless the cells of the checkpoint are those of this mesh, by number and place.
void check_same_mesh(CheckpointReader& reader, const Mesh& mesh, const std::string& where) {
  const std::string remedy = "; take the run's own mesh, or set map_nearest_cell = true to take each cell's values from the nearest cell";
  const auto n_stored = sum(mesh.comm, static_cast<std::int64_t>(reader.ids(velocity_name).size()));
  if (n_stored != mesh.n_cells_global)
    throw Error(ExitCode::usage, where + ": that run has " + std::to_string(n_stored) + " cells and this mesh " +
                                     std::to_string(mesh.n_cells_global) + remedy);
  if (!reader.has(centre_name)) return;
  const std::vector<Vec3> centres = centres_of(reader, owned_ids(mesh));
  double off = 0;  // of a cell's width
  for (int c = 0; c < mesh.n_cells; ++c) off = std::max(off, norm(centres[c] - mesh.cell_centre[c]) / std::cbrt(mesh.cell_volume[c]));
  off = maximum(mesh.comm, off);
  if (off > same_place)
    throw Error(ExitCode::usage, where + ": the cells of that run have other positions, by up to " + number_text(off) +
                                     " of a cell's width: it is another mesh, or its rotor is at another angle" + remedy);
}

/// Nearest cell of the checkpoint so far, for a cell of this mesh.
struct Nearest {
  double distance2 = std::numeric_limits<double>::infinity();  // m2
  std::int64_t id = -1;
};

void search(const std::vector<std::int64_t>& ids, const std::vector<Vec3>& centres, const Mesh& mesh, std::vector<Nearest>& nearest) {
  if (ids.empty()) return;
  const PointTree tree(centres);
  std::array<unsigned, equally_near> index{};
  std::array<double, equally_near> distance2{};
  for (int c = 0; c < mesh.n_cells; ++c) {
    const auto found = tree->knnSearch(&mesh.cell_centre[c].x, equally_near, index.data(), distance2.data());
    for (std::size_t k = 0; k < found; ++k) {
      const Nearest candidate{distance2[k], ids[index[k]]};
      // Of equally near cells that of the lowest number, so that the result does not depend on the ranks.
      if (candidate.distance2 < nearest[c].distance2 || (candidate.distance2 == nearest[c].distance2 && candidate.id < nearest[c].id))
        nearest[c] = candidate;
    }
  }
}

/// Of each owned cell the number of the nearest cell of the checkpoint: the ranks' shares of the stored centres go round one after another.
std::vector<std::int64_t> nearest_ids(CheckpointReader& reader, const Mesh& mesh, const std::string& where, double& farthest) {
  if (!reader.has(centre_name))
    throw Error(ExitCode::usage, where + ": that checkpoint has no cell centres, which map_nearest_cell = true needs; repeat that run");
  const std::vector<std::int64_t> mine = reader.ids(centre_name);
  const std::vector<Vec3> my_centres = centres_of(reader, mine);
  std::vector<Nearest> nearest(static_cast<std::size_t>(mesh.n_cells));
  for (int rank = 0; rank < size_of(mesh.comm); ++rank) {
    int n = static_cast<int>(mine.size());
    MPI_Bcast(&n, 1, MPI_INT, rank, mesh.comm);
    std::vector<std::int64_t> ids = rank == rank_of(mesh.comm) ? mine : std::vector<std::int64_t>(n);
    std::vector<Vec3> centres = rank == rank_of(mesh.comm) ? my_centres : std::vector<Vec3>(n);
    MPI_Bcast(ids.data(), n, MPI_INT64_T, rank, mesh.comm);
    MPI_Bcast(centres.data(), 3 * n, MPI_DOUBLE, rank, mesh.comm);
    search(ids, centres, mesh, nearest);
  }
  std::vector<std::int64_t> ids;
  farthest = 0;
  for (const Nearest& found : nearest) ids.push_back(found.id), farthest = std::max(farthest, std::sqrt(found.distance2));
  farthest = maximum(mesh.comm, farthest);
  return ids;
}

}  // namespace

Section StartSettings::section() {
  return {.name = "initial_flow",
          .meaning = "Flow of another run, such as a steady one, as the initial flow instead of a uniform velocity. Time begins at 0.",
          .parameters = {file_setting("from", &from,
                                      "Output folder of the other run, relative to the case file; its newest checkpoint gives velocity, "
                                      "pressure, k and epsilon. The mesh must be the same, unless map_nearest_cell is true."),
                         renamed(setting("map_nearest_cell", &map_nearest_cell,
                                         "Each cell takes the values of the nearest cell of the other run, whose mesh may be another one."),
                                 {.key = "map"}),
                         setting("frozen", &frozen,
                                 "true: the flow does not change in time and carries the rags (one_way coupling): many rags use one flow. "
                                 "Not possible with a rotating zone."),
                         {"velocity_factor", &velocity_factor, "1", 0, 100, Basis::assumed,
                          "frozen: factor on the velocities of the other run; k has its square, epsilon its cube. This is the same flow at "
                          "another rate, if the Reynolds number has little influence."}},
          .former_name = "start"};
}
const bool start_table = add_case_table<StartSettings>(90);

void scale_flow(Flow& flow, const Flow& as_started, double factor) {
  const auto scale = [](auto& values, const auto& from, double by) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = by * from[i];
  };
  const double square = factor * factor;
  flow.time = as_started.time, flow.time_step = as_started.time_step;
  scale(flow.velocity, as_started.velocity, factor);
  for (std::size_t c = 0; c < flow.velocity_gradient.size(); ++c) scale(flow.velocity_gradient[c], as_started.velocity_gradient[c], factor);
  scale(flow.flux, as_started.flux, factor), scale(flow.eddy_viscosity, as_started.eddy_viscosity, factor);
  scale(flow.pressure, as_started.pressure, square), scale(flow.pressure_gradient, as_started.pressure_gradient, square);
  scale(flow.boundary_pressure, as_started.boundary_pressure, square);
  scale(flow.turbulent_kinetic_energy, as_started.turbulent_kinetic_energy, square);
  scale(flow.dissipation_rate, as_started.dissipation_rate, square * factor);
  for (std::size_t i = 0; i < flow.model_fields.size(); ++i)
    scale(flow.model_fields[i].values, as_started.model_fields[i].values, std::pow(factor, flow.model_fields[i].velocity_power));
}

StartedFlow start_flow(FlowSolver& water, const StartSettings& settings, const std::filesystem::path& folder) {
  const std::string where = "[initial_flow] from = \"" + settings.from + "\"";
  Flow& flow = water.flow;
  const Mesh& mesh = flow.mesh;
  check_checkpoint(mesh.comm, folder / "checkpoint", where);
  CheckpointReader reader(mesh.comm, folder / "checkpoint");
  if (!reader.has(velocity_name)) throw Error(ExitCode::usage, where + ": that run has no water; name the output folder of one that has");
  const double time = reader.stamp().time;
  std::string log_message = "start: water of " + folder.string() + " at " + number_text(time) + " s";
  if (!reader.fallback().empty()) log_message += "; " + reader.fallback();
  std::vector<std::int64_t> ids(owned_ids(mesh).begin(), owned_ids(mesh).end());
  if (settings.map_nearest_cell) {
    double farthest = 0;
    ids = nearest_ids(reader, mesh, where, farthest);
    log_message += ", from the nearest cells, " + number_text(farthest) + " m away or less";
  } else {
    check_same_mesh(reader, mesh, where);
    if (!settings.frozen && water.go_on_from(reader)) return {.log_message = log_message, .time = time};
  }

  const auto velocity = reader.rows(velocity_name, ids, 3);
  if (mesh.n_cells > 0) std::copy(velocity.begin(), velocity.end(), &flow.velocity[0].x);
  const auto read_scalar = [&](const std::string& name, std::vector<double>& field) {
    const auto values = reader.rows(name, ids, 1);
    std::copy(values.begin(), values.end(), field.begin());
  };
  read_scalar("flow/pressure", flow.pressure);
  if (!flow.turbulent_kinetic_energy.empty()) {
    if (reader.has("flow/k") && reader.has("flow/epsilon")) {
      read_scalar("flow/k", flow.turbulent_kinetic_energy);
      read_scalar("flow/epsilon", flow.dissipation_rate);
    } else {
      log_message += "; that run had no k and epsilon: they start as [turbulence] says";
    }
  }
  return {.log_message = log_message, .time = time};
}

void save_cell_centres(CheckpointWriter& checkpoint, const Mesh& mesh) {
  checkpoint.rows(centre_name, owned_ids(mesh),
                  std::span<const double>(mesh.n_cells > 0 ? &mesh.cell_centre[0].x : nullptr, 3 * static_cast<std::size_t>(mesh.n_cells)),
                  3);
}

}  // namespace snag
