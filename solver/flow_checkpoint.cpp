// What a resume of the flow needs, by cell id. Values on faces are written cell by cell, as seen from the cell (fluxes out of it), its
// faces sorted by (neighbour's id or patch, way to it): an order that does not depend on ranks. A face between two ranks is written by both
// and read by each from its own. Facets of a sliding interface have no history and are left out.
#include <algorithm>
#include <tuple>

#include "base/flat.hpp"
#include "mesh/geometry.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/face.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

namespace {

std::span<const std::int64_t> owned_ids(const Mesh& mesh) { return {mesh.cell_id.data(), static_cast<std::size_t>(mesh.n_cells)}; }

/// Places of the faces of all owned cells in rows of equal length.
class FaceRows {
 public:
  explicit FaceRows(const Mesh& mesh) : mesh_(mesh) {
    std::int64_t longest = 0;
    for (int c = 0; c < mesh.n_cells; ++c) {
      const auto faces = row(mesh.cell_face_start, mesh.cell_face, c);
      longest = std::max<std::int64_t>(longest, std::count_if(faces.begin(), faces.end(), [&](int f) { return !is_facet(f); }));
    }
    length_ = static_cast<int>(maximum(mesh.comm, static_cast<double>(longest)));
  }
  int length() const { return length_; }

  /// Call visit(face, place, sign) for each face of each owned cell; sign is -1 where the cell is the face's neighbour.
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::vector<std::tuple<std::int64_t, double, double, double, int, double>> order;
    for (int c = 0; c < mesh_.n_cells; ++c) {
      order.clear();
      for (int k = mesh_.cell_face_start[c]; k < mesh_.cell_face_start[c + 1]; ++k) {
        const int f = mesh_.cell_face[k];
        if (is_facet(f)) continue;
        const double sign = mesh_.owner[f] == c ? 1 : -1;
        const Vec3 way = sign * mesh_.delta[f];
        order.emplace_back(key(f, c), way.x, way.y, way.z, f, sign);
      }
      std::sort(order.begin(), order.end());
      std::size_t place = static_cast<std::size_t>(c) * length_;
      for (const auto& face : order) visit(std::get<4>(face), place++, std::get<5>(face));
    }
  }

 private:
  bool is_facet(int f) const { return f >= mesh_.first_facet && f < mesh_.n_interior; }
  std::int64_t key(int f, int c) const {
    if (f < mesh_.n_interior) return mesh_.cell_id[mesh_.owner[f] == c ? mesh_.neighbour[f] : mesh_.owner[f]];
    std::int64_t patch = 0;
    while (f >= mesh_.patches[patch].end() || f < mesh_.patches[patch].first) ++patch;
    return -1 - patch;
  }
  const Mesh& mesh_;
  int length_ = 0;
};

void write_cells(CheckpointWriter& checkpoint, const std::string& name, const Mesh& mesh, const double* values, int components) {
  checkpoint.rows(name, owned_ids(mesh), std::span(values, static_cast<std::size_t>(mesh.n_cells) * components), components);
}

void read_cells(CheckpointReader& checkpoint, const std::string& name, const Mesh& mesh, std::span<double> values, int components) {
  const auto stored = checkpoint.rows(name, owned_ids(mesh), components);
  std::copy(stored.begin(), stored.end(), values.begin());
  mesh.halo.exchange(values, components);
}

/// `signed_by_side`: the value changes its sign with the side it is seen from (a flux).
void write_faces(CheckpointWriter& checkpoint, const std::string& name, const FaceRows& rows, const Mesh& mesh,
                 std::span<const double> values, bool signed_by_side) {
  std::vector<double> stored(static_cast<std::size_t>(mesh.n_cells) * rows.length());
  rows.for_each([&](int f, std::size_t place, double sign) { stored[place] = signed_by_side ? sign * values[f] : values[f]; });
  checkpoint.rows(name, owned_ids(mesh), std::span<const double>(stored), rows.length());
}

void read_faces(CheckpointReader& checkpoint, const std::string& name, const FaceRows& rows, const Mesh& mesh, std::span<double> values,
                bool signed_by_side) {
  const auto stored = checkpoint.rows(name, owned_ids(mesh), rows.length());
  rows.for_each([&](int f, std::size_t place, double sign) { values[f] = signed_by_side ? sign * stored[place] : stored[place]; });
}

/// Values of boundary faces as values of all faces, and back.
std::vector<double> on_all_faces(const Mesh& mesh, const std::vector<double>& boundary) {
  std::vector<double> all(mesh.n_faces);
  std::copy(boundary.begin(), boundary.end(), all.begin() + mesh.n_interior);
  return all;
}

void read_boundary(CheckpointReader& checkpoint, const std::string& name, const FaceRows& rows, const Mesh& mesh,
                   std::vector<double>& boundary) {
  std::vector<double> all(mesh.n_faces);
  read_faces(checkpoint, name, rows, mesh, all, false);
  std::copy(all.begin() + mesh.n_interior, all.end(), boundary.begin());
}

}  // namespace

void FlowSolver::save(CheckpointWriter& checkpoint) const {
  const Mesh& mesh = flow.mesh;
  const FaceRows rows(mesh);
  const Poisson& poisson = continuity_.poisson();
  checkpoint.shared("flow/scalars", std::vector<double>{flow.time, flow.time_step_size, static_cast<double>(flow.time_step),
                                                        started_ ? 1.0 : 0.0, poisson.fresh_cost(), poisson.rebuild_is_due() ? 1.0 : 0.0});
  checkpoint.shared("flow/slides", std::vector<double>{slides() ? 1.0 : 0.0});
  if (const std::vector<double> state = boundary_.state(); !state.empty())
    checkpoint.shared("flow/boundary", std::span<const double>(state));
  write_cells(checkpoint, "flow/velocity", mesh, flat(flow.velocity).data(), 3);
  write_cells(checkpoint, "flow/velocity_old", mesh, flat(flow.velocity_old).data(), 3);
  write_cells(checkpoint, "flow/velocity_gradient", mesh, flat(flow.velocity_gradient).data(), 9);
  write_cells(checkpoint, "flow/velocity_gradient_old", mesh, flat(flow.velocity_gradient_old).data(), 9);
  write_cells(checkpoint, "flow/pressure", mesh, flow.pressure.data(), 1);
  write_cells(checkpoint, "flow/pressure_gradient", mesh, flat(flow.pressure_gradient).data(), 3);
  if (sum(mesh.comm, static_cast<std::int64_t>(flow.reaction.size())) > 0)
    write_cells(checkpoint, "flow/reaction", mesh, flat(flow.reaction).data(), 3);
  if (sum(mesh.comm, static_cast<std::int64_t>(flow.solid_fraction.size())) > 0)
    write_cells(checkpoint, "flow/solid_fraction", mesh, flow.solid_fraction.data(), 1);
  if (sum(mesh.comm, static_cast<std::int64_t>(flow.screen.size())) > 0)
    write_cells(checkpoint, "flow/screen", mesh, flow.screen.data(), 1);
  for (const StoredField& field : turbulence_->stored()) write_cells(checkpoint, "flow/" + field.name, mesh, field.values->data(), 1);
  write_faces(checkpoint, "flow/flux", rows, mesh, flow.flux, true);
  write_faces(checkpoint, "flow/flux_old", rows, mesh, flow.flux_old, true);
  write_faces(checkpoint, "flow/psi", rows, mesh, continuity_.history.deviation, true);
  write_faces(checkpoint, "flow/psi_old", rows, mesh, continuity_.history.deviation_old, true);
  write_faces(checkpoint, "flow/boundary_pressure", rows, mesh, on_all_faces(mesh, flow.boundary_pressure), false);
  write_faces(checkpoint, "flow/wall_slope", rows, mesh, on_all_faces(mesh, continuity_.wall_slope), false);
  checkpoint.shared("flow/preconditioner_angle", std::vector<double>{continuity_.preconditioner_angle()});
  watch_.save(checkpoint);
}

void FlowSolver::load(CheckpointReader& checkpoint) {
  const Mesh& mesh = flow.mesh;
  const auto scalars = checkpoint.shared("flow/scalars");
  flow.time = scalars.at(0), flow.time_step_size = scalars.at(1), flow.time_step = static_cast<std::int64_t>(scalars.at(2));
  started_ = scalars.at(3) != 0;
  if (started_) load_preconditioner(checkpoint, scalars.at(4), scalars.at(5) != 0);
  if (rotating_zone_) turn_mesh(flow.time);
  if (checkpoint.has("flow/boundary")) boundary_.restore_state(checkpoint.shared("flow/boundary"));
  load_water(checkpoint);
  // Owned cells only: these fields have no ghosts.
  if (checkpoint.has("flow/reaction")) {
    const auto reaction = checkpoint.rows("flow/reaction", owned_ids(mesh), 3);
    flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
    std::copy(reaction.begin(), reaction.end(), flat(flow.reaction).begin());
    continuity_.keep_held(flow);
  }
  if (checkpoint.has("flow/solid_fraction")) flow.solid_fraction = checkpoint.rows("flow/solid_fraction", owned_ids(mesh), 1);
  if (checkpoint.has("flow/screen")) {
    flow.screen.resize(static_cast<std::size_t>(mesh.n_all_cells()));
    read_cells(checkpoint, "flow/screen", mesh, flow.screen, 1);
  }
  watch_.load(checkpoint);
  if (started_) turbulence_->restore(flow, boundary_);
}

bool FlowSolver::go_on_from(CheckpointReader& checkpoint) {
  const auto scalars = checkpoint.shared("flow/scalars");
  const auto lacks = [&](const StoredField& field) { return !checkpoint.has("flow/" + field.name); };
  const std::vector<StoredField> stored = turbulence_->stored();
  if (scalars.at(1) <= 0 || std::any_of(stored.begin(), stored.end(), lacks)) return false;
  load_water(checkpoint);
  flow.time_step_size = scalars.at(1);
  if (rotating_zone_ && checkpoint.has("flow/slides")) {
    const bool slid = checkpoint.shared("flow/slides").at(0) != 0;
    if (slid != slides()) turn_history((slid ? 1 : -1) * rotating_zone_->speed(0) * flow.time_step_size);
  }
  boundary_.update(flow, 0);
  turbulence_->restore(flow, boundary_);
  watch_.begin(flow);
  started_ = true;
  return true;
}

/// With motion = "frame" the old velocity of a cell has components that turn with the rotor; with a sliding mesh its components are in the
/// frame at rest. Turns the old velocity and its gradient by `angle` from the one to the other.
void FlowSolver::turn_history(double angle) {
  const Mat3 R = rotation(rotating_zone_->axis(), angle);
  for (int c = 0; c < flow.mesh.n_all_cells(); ++c) {
    if (flow.mesh.cell_zone[c] != rotating_zone_->zone()) continue;
    flow.velocity_old[c] = R * flow.velocity_old[c];
    Mat3 G_R = flow.velocity_gradient_old[c];  // G R^T
    for (Vec3& row : G_R) row = R * row;
    for (int i = 0; i < 3; ++i) flow.velocity_gradient_old[c][i] = transposed_product(G_R, R[i]);
  }
}

/// Velocity, pressure and turbulence with their history, on the mesh as it stands.
void FlowSolver::load_water(CheckpointReader& checkpoint) {
  const Mesh& mesh = flow.mesh;
  const FaceRows rows(mesh);
  read_cells(checkpoint, "flow/velocity", mesh, flat(flow.velocity), 3);
  read_cells(checkpoint, "flow/velocity_old", mesh, flat(flow.velocity_old), 3);
  read_cells(checkpoint, "flow/velocity_gradient", mesh, flat(flow.velocity_gradient), 9);
  read_cells(checkpoint, "flow/velocity_gradient_old", mesh, flat(flow.velocity_gradient_old), 9);
  read_cells(checkpoint, "flow/pressure", mesh, flow.pressure, 1);
  read_cells(checkpoint, "flow/pressure_gradient", mesh, flat(flow.pressure_gradient), 3);
  for (const StoredField& field : turbulence_->stored()) read_cells(checkpoint, "flow/" + field.name, mesh, *field.values, 1);
  read_faces(checkpoint, "flow/flux", rows, mesh, flow.flux, true);
  read_faces(checkpoint, "flow/flux_old", rows, mesh, flow.flux_old, true);
  read_faces(checkpoint, "flow/psi", rows, mesh, continuity_.history.deviation, true);
  read_faces(checkpoint, "flow/psi_old", rows, mesh, continuity_.history.deviation_old, true);
  read_boundary(checkpoint, "flow/boundary_pressure", rows, mesh, flow.boundary_pressure);
  read_boundary(checkpoint, "flow/wall_slope", rows, mesh, continuity_.wall_slope);
}

/// On the mesh as it was when the preconditioner was set up.
void FlowSolver::load_preconditioner(CheckpointReader& checkpoint, double fresh_cost, bool rebuild_due) {
  const double angle = checkpoint.shared("flow/preconditioner_angle").at(0);
  if (slides()) rotating_zone_->mesh().turn(angle);
  continuity_.restore(angle, boundary_, fresh_cost, rebuild_due);
}

}  // namespace snag
