// Turning is one product a vector; joining replaces the range of facets in the arrays of the mesh.
//
// Which cells become ghosts: a rank that owns a face of the interface may meet, at some angle, every face of the other side on the same
// cylinder that overlaps in z, or on the same disc that overlaps in r.
#include "mesh/sliding/turning_mesh.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "mesh/geometry.hpp"
#include "mesh/import/connectivity.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// At the rim of a coarse interface a facet may lie beyond the centre of a flat cell; interpolation stays exact for linear fields, as it is
// completed from the point that the weight stands for.
constexpr double least_weight = 0.05;

/// What a face sweeps in a turn: a part of the interface and a range of z or of r.
struct Band {
  int part;
  double lower, upper;
};

Band band_of(const RevolvedSide& side, const RevolvedFace& face) {
  const auto node = [&](int i) -> const RevolvedNode& { return side.node[face.node[static_cast<std::size_t>(i % face.n_nodes)]]; };
  Band band{2 * face.part + (face.is_disc ? 1 : 0), infinity, -infinity};
  double longest = 0;
  for (int i = 0; i < face.n_nodes; ++i) {
    const double x = face.is_disc ? node(i).r : node(i).z;
    band.lower = std::min(band.lower, x), band.upper = std::max(band.upper, x);
    longest = std::max(longest, norm(node(i + 1).position() - node(i).position()));
  }
  // A disc face reaches further in than its nodes, at most by half an edge, or around the axis.
  if (face.is_disc) band.lower = std::max(0.0, band.lower - longest);
  return band;
}

/// The bands of this rank's faces of one side, united and sorted.
std::vector<Band> united_bands(const RevolvedSide& side, int rank) {
  std::vector<Band> bands, united;
  for (const RevolvedFace& face : side.face)
    if (face.rank == rank) bands.push_back(band_of(side, face));
  std::sort(bands.begin(), bands.end(), [](const Band& a, const Band& b) { return std::tie(a.part, a.lower) < std::tie(b.part, b.lower); });
  for (const Band& band : bands) {
    if (!united.empty() && united.back().part == band.part && band.lower <= united.back().upper)
      united.back().upper = std::max(united.back().upper, band.upper);
    else
      united.push_back(band);
  }
  return united;
}

bool meets(const std::vector<Band>& united, const Band& band) {
  return std::any_of(united.begin(), united.end(),
                     [&](const Band& own) { return own.part == band.part && own.lower <= band.upper && band.lower <= own.upper; });
}

/// Cylinders and discs with what the rotor's faces cover of them.
std::vector<InterfacePart> parts_of(const RevolvedSurface& surface) {
  std::vector<InterfacePart> parts;
  for (const bool is_disc : {false, true})
    for (const double level : is_disc ? surface.levels : surface.radii) parts.push_back({is_disc, level, infinity, -infinity, 0});
  for (const RevolvedFace& face : surface.rotor.face) {
    InterfacePart& part = parts[static_cast<std::size_t>(face.part) + (face.is_disc ? surface.radii.size() : 0)];
    part.sign = face.sign;
    for (int i = 0; i < face.n_nodes; ++i) {
      const RevolvedNode& node = surface.rotor.node[static_cast<std::size_t>(face.node[static_cast<std::size_t>(i)])];
      const double along = face.is_disc ? node.r : node.z;
      part.lower = std::min(part.lower, along), part.upper = std::max(part.upper, along);
    }
  }
  // A level may belong to the rims of the other kind alone. A disc around the axis has a cell there, not always a node.
  std::erase_if(parts, [](const InterfacePart& part) { return part.sign == 0; });
  return parts;
}

/// Takes the rows [first, last) out of compressed rows.
void erase_rows(std::vector<int>& start, std::vector<int>& entries, int first, int last) {
  const int removed = start[last] - start[first];
  entries.erase(entries.begin() + start[first], entries.begin() + start[last]);
  start.erase(start.begin() + first, start.begin() + last);
  for (std::size_t i = static_cast<std::size_t>(first); i < start.size(); ++i) start[i] -= removed;
}

template <class T>
std::vector<T> taken(const std::vector<T>& all, const std::vector<int>& which) {
  std::vector<T> some;
  some.reserve(which.size());
  for (const int i : which) some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

}  // namespace

TurningMesh::TurningMesh(Mesh& mesh, const SlidingDescription& description, double angle) : mesh_(mesh), interface_(mesh, description) {
  interface_.curve(mesh_);
  zone_ = static_cast<int>(std::find(mesh.zones.begin(), mesh.zones.end(), description.rotor_zone) - mesh.zones.begin());
  mesh_.turning = {.zone = zone_, .origin = description.origin, .axis = unit(description.axis), .parts = parts_of(interface_.surface())};
  unit_mesh_flux_ = interface_.mesh_flux(mesh_, 1);
  release_interface();
  add_ghosts();
  number_interface_cells();
  keep_reference();
  turn(angle);
  if (const std::int64_t n = n_bounded_global(); n > 0)
    log::warning("sliding interface: " + std::to_string(n) + " of " + std::to_string(n_facets_global()) +
                 " facets lie near or beyond the centre of one of their cells; their interpolation weights are limited to " +
                 number_text(least_weight) + " and " + number_text(1 - least_weight) + "; smaller cells at the interface avoid it");
}

/// Takes the faces of both patches out of the boundary; the patches go.
void TurningMesh::release_interface() {
  const auto& about = interface_.description();
  for (const std::string& name : {about.rotor_patch, about.stator_patch}) {
    const auto p = static_cast<std::size_t>(mesh_.patch_index(name));
    const int first = mesh_.patches[p].first, last = mesh_.patches[p].end();
    const auto erase = [&](auto& field) { field.erase(field.begin() + first, field.begin() + last); };
    erase(mesh_.owner), erase(mesh_.neighbour), erase(mesh_.face_vector), erase(mesh_.face_centre), erase(mesh_.delta), erase(mesh_.weight);
    erase(unit_mesh_flux_);
    erase_rows(mesh_.face_node_start, mesh_.face_node, first, last);
    mesh_.n_faces -= last - first;
    mesh_.patches.erase(mesh_.patches.begin() + static_cast<std::ptrdiff_t>(p));
    for (Patch& patch : mesh_.patches)
      if (patch.first >= last) patch.first -= last - first;
  }
  unit_boundary_mesh_flux_.assign(unit_mesh_flux_.begin() + mesh_.n_interior, unit_mesh_flux_.end());
  unit_mesh_flux_.resize(static_cast<std::size_t>(mesh_.first_facet));
}

void TurningMesh::add_ghosts() {
  const int rank = rank_of(mesh_.comm);
  const RevolvedSurface& surface = interface_.surface();
  // Where each ghost lives: known to the owners.
  std::vector<std::int64_t> home_rank(mesh_.n_all_cells(), rank), home_cell(mesh_.n_all_cells());
  for (int c = 0; c < mesh_.n_cells; ++c) home_cell[c] = c;
  mesh_.halo.exchange(std::span(home_rank)), mesh_.halo.exchange(std::span(home_cell));
  std::vector<std::pair<int, int>> known, added;
  for (int c = mesh_.n_cells; c < mesh_.n_all_cells(); ++c) known.emplace_back(home_rank[c], home_cell[c]);
  std::vector<std::pair<int, int>> homes = known;
  std::sort(known.begin(), known.end());
  for (const auto& [own, other] : {std::pair{&surface.rotor, &surface.stator}, std::pair{&surface.stator, &surface.rotor}}) {
    const std::vector<Band> bands = united_bands(*own, rank);
    if (bands.empty()) continue;
    for (const RevolvedFace& face : other->face) {
      const std::pair home{face.rank, face.cell};
      if (face.rank != rank && !std::binary_search(known.begin(), known.end(), home) && meets(bands, band_of(*other, face)))
        added.push_back(home);
    }
  }
  std::sort(added.begin(), added.end());
  added.erase(std::unique(added.begin(), added.end()), added.end());

  std::vector<int> owner_rank, owner_index;
  homes.insert(homes.end(), added.begin(), added.end());
  for (const auto& [home, cell] : homes) owner_rank.push_back(home), owner_index.push_back(cell);
  mesh_.n_ghosts = static_cast<int>(owner_rank.size());
  mesh_.halo = Halo(mesh_.comm, mesh_.n_cells, owner_rank, owner_index);
  const auto n_all = static_cast<std::size_t>(mesh_.n_all_cells());
  mesh_.cell_centre.resize(n_all), mesh_.cell_volume.resize(n_all), mesh_.cell_id.resize(n_all);
  mesh_.halo.exchange(mesh_.cell_centre), mesh_.halo.exchange(mesh_.cell_volume), mesh_.halo.exchange(std::span(mesh_.cell_id));
  std::vector<std::int64_t> zone(mesh_.cell_zone.begin(), mesh_.cell_zone.end());
  zone.resize(n_all);
  mesh_.halo.exchange(std::span(zone));
  mesh_.cell_zone.assign(zone.begin(), zone.end());
}

void TurningMesh::number_interface_cells() {
  const RevolvedSurface& surface = interface_.surface();
  std::vector<std::int64_t> ids;
  for (const RevolvedSide* side : {&surface.rotor, &surface.stator})
    for (const RevolvedFace& face : side->face) ids.push_back(face.cell_id);
  std::sort(ids.begin(), ids.end());
  for (int c = 0; c < mesh_.n_all_cells(); ++c)
    if (std::binary_search(ids.begin(), ids.end(), mesh_.cell_id[c])) cell_of_id_.emplace_back(mesh_.cell_id[c], c);
  std::sort(cell_of_id_.begin(), cell_of_id_.end());
}

void TurningMesh::keep_reference() {
  Turning& r = reference_;
  const auto turns = [&](int cell) { return mesh_.cell_zone[cell] == zone_; };
  std::vector<char> node_turns(mesh_.node.size(), 0);
  for (int c = 0; c < mesh_.n_all_cells(); ++c) {
    if (!turns(c)) continue;
    r.cell.push_back(c);
    if (c < mesh_.n_cells)
      for (const int n : row(mesh_.cell_node_start, mesh_.cell_node, c)) node_turns[n] = 1;
  }
  for (int f = 0; f < mesh_.n_faces; ++f) {
    if (!turns(mesh_.owner[f])) continue;
    (f < mesh_.n_interior ? r.face : r.boundary_face).push_back(f < mesh_.n_interior ? f : f - mesh_.n_interior);
    for (const int n : row(mesh_.face_node_start, mesh_.face_node, f)) node_turns[n] = 1;
  }
  for (std::size_t n = 0; n < node_turns.size(); ++n)
    if (node_turns[n]) r.node.push_back(static_cast<int>(n));
  unit_mesh_flux_ = taken(unit_mesh_flux_, r.face);
  r.cell_centre = taken(mesh_.cell_centre, r.cell), r.node_position = taken(mesh_.node, r.node);
  for (const auto& [kept, all] : {std::pair{&r.face_vector, &mesh_.face_vector}, std::pair{&r.face_centre, &mesh_.face_centre}}) {
    kept->reserve(r.face.size() + r.boundary_face.size());
    for (const int f : r.face) kept->push_back((*all)[f]);
    for (const int b : r.boundary_face) kept->push_back((*all)[mesh_.n_interior + b]);
  }
  for (const int f : r.face)
    if (const Vec3 across = period(mesh_, f); across != Vec3{}) r.period.emplace_back(f, across);
  for (auto* list : {&r.cell, &r.face, &r.boundary_face, &r.node}) list->shrink_to_fit();
}

void TurningMesh::turn(double angle) {
  angle_ = angle;
  mesh_.turning.rotation = interface_.rotation(angle);
  join(interface_.facets(angle));
  turn_geometry();
  list_cell_faces(mesh_);
}

/// Cells, nodes and faces of the zone; then what facets have of their cells.
void TurningMesh::turn_geometry() {
  n_bounded_ = 0;
  const Turning& r = reference_;
  const Mat3& rotation = mesh_.turning.rotation;
  for (std::size_t i = 0; i < r.cell.size(); ++i) mesh_.cell_centre[r.cell[i]] = interface_.turned_point(rotation, r.cell_centre[i]);
  for (std::size_t i = 0; i < r.node.size(); ++i) mesh_.node[r.node[i]] = interface_.turned_point(rotation, r.node_position[i]);
  const std::size_t n_interior = r.face.size();
  for (std::size_t i = 0; i < n_interior + r.boundary_face.size(); ++i) {
    const int f = i < n_interior ? r.face[i] : mesh_.n_interior + r.boundary_face[i - n_interior];
    mesh_.face_vector[f] = rotation * r.face_vector[i];
    mesh_.face_centre[f] = interface_.turned_point(rotation, r.face_centre[i]);
    mesh_.delta[f] = (i < n_interior ? mesh_.cell_centre[mesh_.neighbour[f]] : mesh_.face_centre[f]) - mesh_.cell_centre[mesh_.owner[f]];
  }
  for (const auto& [f, across] : r.period) mesh_.delta[f] += rotation * across;
  for (int f = mesh_.first_facet; f < mesh_.n_interior; ++f) {
    const Vec3 &x_P = mesh_.cell_centre[mesh_.owner[f]], &x_N = mesh_.cell_centre[mesh_.neighbour[f]], &S = mesh_.face_vector[f];
    mesh_.delta[f] = x_N - x_P;
    const double weight = dot(S, x_N - mesh_.face_centre[f]) / dot(S, mesh_.delta[f]);
    mesh_.weight[f] = std::clamp(weight, least_weight, 1 - least_weight);
    n_bounded_ += mesh_.weight[f] != weight && mesh_.owner[f] < mesh_.n_cells;
  }
}

int TurningMesh::cell_of(const FacetSide& side) const {
  if (side.rank == rank_of(mesh_.comm)) return side.cell;
  const auto found = std::lower_bound(cell_of_id_.begin(), cell_of_id_.end(), std::pair(side.cell_id, 0));
  if (found == cell_of_id_.end() || found->first != side.cell_id)
    throw Error(ExitCode::invariant, "sliding interface: cell " + std::to_string(side.cell_id) + " of rank " + std::to_string(side.rank) +
                                         " meets a cell of this rank, but is not a ghost cell here");
  return found->second;
}

void TurningMesh::join(const std::vector<Facet>& facets) {
  const int n_old = mesh_.n_interior, n_new = mesh_.first_facet + static_cast<int>(facets.size());
  mesh_.n_interior = n_new, mesh_.n_faces += n_new - n_old;
  for (Patch& patch : mesh_.patches) patch.first += n_new - n_old;
  resize_facets(mesh_, mesh_.owner), resize_facets(mesh_, mesh_.neighbour), resize_facets(mesh_, mesh_.weight);
  resize_facets(mesh_, mesh_.face_vector), resize_facets(mesh_, mesh_.face_centre), resize_facets(mesh_, mesh_.delta);
  // Rows without nodes: all begin where those of the boundary begin.
  auto& start = mesh_.face_node_start;
  const int begin = start[static_cast<std::size_t>(mesh_.first_facet)];
  start.erase(start.begin() + mesh_.first_facet, start.begin() + n_old);
  if (const std::size_t n = start.size() + facets.size(); n > start.capacity()) start.reserve(n + n / 64);
  start.insert(start.begin() + mesh_.first_facet, facets.size(), begin);
  mesh_.facet_share.resize(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Facet& facet = facets[i];
    const bool rotor_owns = facet.rotor.cell_id < facet.stator.cell_id;
    const FacetSide &owner = rotor_owns ? facet.rotor : facet.stator, &neighbour = rotor_owns ? facet.stator : facet.rotor;
    const std::size_t f = static_cast<std::size_t>(mesh_.first_facet) + i;
    mesh_.owner[f] = cell_of(owner), mesh_.neighbour[f] = cell_of(neighbour);
    mesh_.face_vector[f] = rotor_owns ? facet.vector : -1 * facet.vector;
    mesh_.face_centre[f] = facet.centre;
    mesh_.facet_share[i] = {owner.share, neighbour.share};
  }
}

void TurningMesh::set_mesh_flux(double omega, std::vector<double>& flux) const {
  flux.assign(static_cast<std::size_t>(mesh_.n_faces), 0);
  for (std::size_t i = 0; i < unit_mesh_flux_.size(); ++i) flux[reference_.face[i]] = omega * unit_mesh_flux_[i];
  for (std::size_t b = 0; b < unit_boundary_mesh_flux_.size(); ++b)
    flux[static_cast<std::size_t>(mesh_.n_interior) + b] = omega * unit_boundary_mesh_flux_[b];
}

double TurningMesh::closure() const {
  double worst = 0;
  for (const auto& [id, cell] : cell_of_id_) {
    if (cell >= mesh_.n_cells) continue;
    Vec3 total;
    double surface = 0;
    for (const int f : row(mesh_.cell_face_start, mesh_.cell_face, cell)) {
      if (mesh_.neighbour[f] == mesh_.owner[f]) continue;  // one period wide: both sides of the face are its own
      total += (mesh_.owner[f] == cell ? 1.0 : -1.0) * mesh_.face_vector[f];
      surface += norm(mesh_.face_vector[f]);
    }
    worst = std::max(worst, norm(total) / surface);
  }
  return maximum(mesh_.comm, worst);
}

std::int64_t TurningMesh::n_bounded_global() const { return sum(mesh_.comm, n_bounded_); }

std::int64_t TurningMesh::n_facets_global() const {
  std::int64_t n = 0;
  for (int f = mesh_.first_facet; f < mesh_.n_interior; ++f) n += mesh_.owner[f] < mesh_.n_cells;
  return sum(mesh_.comm, n);
}

}  // namespace snag
