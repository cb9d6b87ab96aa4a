// Measures of quality. Per interior face with vector S, centre x_f, owner P, neighbour N, delta = x_N - x_P:
//
//   non-orthogonality = angle(S, delta),   skewness = |s| / |delta|   (mesh/skewness.hpp)
//
// Per cell:  closure = |sum_f S| / sum_f |S|;  quality of a tetrahedron = 3 r_in / R_circ (1 when regular), with
//
//   r_in = 3 V / sum |S|,   R_circ = sqrt((aA + bB + cC)(-aA + bB + cC)(aA - bB + cC)(aA + bB - cC)) / (24 V)
//
// (Crelle; aA, bB, cC: products of opposite edges)
// and of other shapes the least over the corners of det(e1, e2, e3)/(|e1||e2||e3|), e the corner's edges (the apex of a pyramid, with four,
// is left out).
#include "mesh/quality.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <tuple>

#include "base/words.hpp"
#include "mesh/bounding_box.hpp"
#include "mesh/geometry.hpp"
#include "mesh/regions.hpp"
#include "mesh/skewness.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {
namespace {

// Limits of a usable mesh.
constexpr double least_volume = 1e-15;  // of the volume of the bounding box
constexpr double largest_closure = 1e-10;
constexpr double largest_non_orthogonality = 85;  // degrees
constexpr double least_quality = 0.01;

/// The worst value over all ranks and where it is. Larger is worse.
struct Worst {
  double value = -std::numeric_limits<double>::max();
  std::int64_t id = std::numeric_limits<std::int64_t>::max();  // of the cell
  Vec3 place;

  void see(double candidate, std::int64_t candidate_id, const Vec3& where) {
    if (std::isnan(candidate)) candidate = std::numeric_limits<double>::infinity();  // of a cell without volume: nothing is worse
    const auto order = [](std::int64_t cell, const Vec3& x) { return std::tuple(cell, x.x, x.y, x.z); };  // the same on any ranks
    if (candidate > value || (candidate == value && order(candidate_id, where) < order(id, place)))
      *this = {candidate, candidate_id, where};
  }
};

Worst over_ranks(MPI_Comm comm, const Worst& mine) {
  std::vector<Worst> all(static_cast<std::size_t>(size_of(comm)));
  MPI_Allgather(&mine, sizeof(Worst), MPI_BYTE, all.data(), sizeof(Worst), MPI_BYTE, comm);
  Worst worst;
  for (const Worst& other : all)
    if (other.value > -std::numeric_limits<double>::max()) worst.see(other.value, other.id, other.place);
  return worst;
}

double tetrahedron_quality(std::span<const Vec3> x) {
  const auto edge = [&](std::size_t i, std::size_t j) { return norm(x[i] - x[j]); };
  const auto area = [&](std::size_t i, std::size_t j, std::size_t k) { return 0.5 * norm(cross(x[j] - x[i], x[k] - x[i])); };
  const double volume = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6;
  if (volume <= 0) return volume < 0 ? -1 : 0;
  const double r_in = 3 * volume / (area(0, 1, 2) + area(0, 1, 3) + area(0, 2, 3) + area(1, 2, 3));
  const double p = edge(0, 1) * edge(2, 3), q = edge(0, 2) * edge(1, 3), r = edge(0, 3) * edge(1, 2);
  const double R_circ = std::sqrt(std::max(0.0, (p + q + r) * (-p + q + r) * (p - q + r) * (p + q - r))) / (24 * volume);
  return 3 * r_in / R_circ;
}

/// Neighbours along the edges of every corner, right-handed; a pyramid's apex is not among its corners.
std::span<const std::array<int, 3>> corner_edges(CellShape shape) {
  static constexpr std::array<std::array<int, 3>, 4> pyramid{{{1, 3, 4}, {2, 0, 4}, {3, 1, 4}, {0, 2, 4}}};
  static constexpr std::array<std::array<int, 3>, 6> prism{{{2, 1, 3}, {0, 2, 4}, {1, 0, 5}, {4, 5, 0}, {5, 3, 1}, {3, 4, 2}}};
  static constexpr std::array<std::array<int, 3>, 8> hexahedron{
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  if (shape == CellShape::pyramid) return pyramid;
  if (shape == CellShape::prism) return prism;
  return hexahedron;
}

double cell_quality(CellShape shape, std::span<const Vec3> x) {
  if (shape == CellShape::tetrahedron) return tetrahedron_quality(x);
  double least = 1;
  std::size_t corner = 0;
  for (const auto& [i, j, k] : corner_edges(shape)) {
    const Vec3 a = x[static_cast<std::size_t>(i)] - x[corner], b = x[static_cast<std::size_t>(j)] - x[corner],
               c = x[static_cast<std::size_t>(k)] - x[corner];
    const double lengths = norm(a) * norm(b) * norm(c);
    least = std::min(least, lengths > 0 ? dot(a, cross(b, c)) / lengths : 0);
    ++corner;
  }
  return least;
}

struct FaceShape {
  double angle_deg, skewness;
};

FaceShape shape_of_face(const Mesh& mesh, int f) {
  const Vec3 &S = mesh.face_vector[f], &delta = mesh.delta[f];
  const double distance = norm(delta);
  return {.angle_deg = std::acos(std::clamp(dot(S, delta) / (norm(S) * distance), -1.0, 1.0)) * 180 / std::numbers::pi,
          .skewness = norm(skewness(mesh, f)) / distance};
}

std::int64_t count_regions(const Mesh& mesh) {
  const std::vector<std::int64_t> region = regions(mesh);
  std::int64_t n_regions = 0;
  for (int c = 0; c < mesh.n_cells; ++c) n_regions += region[c] == mesh.cell_id[c];
  return sum(mesh.comm, n_regions);
}

/// The places of the worst cells and faces.
struct Places {
  Worst volume, closure, non_orthogonality, quality;
};

void see_cells(const Mesh& mesh, MeshQuality& q, Places& places) {
  std::vector<Vec3> total(static_cast<std::size_t>(mesh.n_all_cells()));
  std::vector<double> area(total.size(), 0), quality(static_cast<std::size_t>(mesh.n_cells));
  for (int f = 0; f < mesh.n_faces; ++f) {
    const double magnitude = norm(mesh.face_vector[f]);
    total[mesh.owner[f]] += mesh.face_vector[f], area[mesh.owner[f]] += magnitude;
    if (mesh.neighbour[f] >= 0) total[mesh.neighbour[f]] -= mesh.face_vector[f], area[mesh.neighbour[f]] += magnitude;
  }
  std::array<Vec3, 8> points;
  double largest = -std::numeric_limits<double>::max();
  for (int c = 0; c < mesh.n_cells; ++c) {
    const std::int64_t id = mesh.cell_id[c];
    const Vec3& x = mesh.cell_centre[c];
    quality[c] = cell_quality(mesh.cell_shape[c], positions(mesh.node, row(mesh.cell_node_start, mesh.cell_node, c), points));
    places.volume.see(-mesh.cell_volume[c], id, x);
    places.closure.see(norm(total[c]) / area[c], id, x);
    places.quality.see(-quality[c], id, x);
    largest = std::max(largest, mesh.cell_volume[c]);
  }
  q.n_cells = mesh.n_cells_global;
  q.volume = sum(mesh.comm, std::span(mesh.cell_volume.data(), static_cast<std::size_t>(mesh.n_cells)));
  q.max_volume = maximum(mesh.comm, largest);
  q.mean_quality = sum(mesh.comm, quality) / static_cast<double>(q.n_cells);
  places.volume = over_ranks(mesh.comm, places.volume);
  places.closure = over_ranks(mesh.comm, places.closure);
  places.quality = over_ranks(mesh.comm, places.quality);
  q.min_volume = -places.volume.value, q.closure = places.closure.value, q.min_quality = -places.quality.value;
}

void see_faces(const Mesh& mesh, MeshQuality& q, Places& places) {
  std::vector<double> angles;
  double skewness = 0, spacing = std::numeric_limits<double>::max();
  for (int f = 0; f < mesh.n_interior; ++f) {
    const int P = mesh.owner[f];
    if (P >= mesh.n_cells) continue;  // seen by the rank of its owner
    const FaceShape shape = shape_of_face(mesh, f);
    angles.push_back(shape.angle_deg);
    places.non_orthogonality.see(shape.angle_deg, mesh.cell_id[P], mesh.face_centre[f]);
    skewness = std::max(skewness, shape.skewness);
    spacing = std::min(spacing, norm(mesh.delta[f]));
  }
  q.n_interior = mesh.n_interior_global;
  q.n_boundary = sum(mesh.comm, std::int64_t{mesh.n_faces - mesh.n_interior});
  if (q.n_interior == 0) return;
  places.non_orthogonality = over_ranks(mesh.comm, places.non_orthogonality);
  q.max_non_orthogonality_deg = places.non_orthogonality.value;
  q.mean_non_orthogonality_deg = sum(mesh.comm, angles) / static_cast<double>(q.n_interior);
  q.max_skewness = maximum(mesh.comm, skewness);
  q.min_spacing = minimum(mesh.comm, spacing);
}

/// Number and volume of some cells of every rank. Collective.
void count(const Mesh& mesh, const std::vector<int>& cells, std::int64_t& n, double& volume) {
  std::vector<double> volumes;
  for (const int c : cells) volumes.push_back(mesh.cell_volume[c]);
  n = sum(mesh.comm, static_cast<std::int64_t>(cells.size())), volume = sum(mesh.comm, volumes);
}

void judge(const Mesh& mesh, const Places& places, MeshQuality& q) {
  const auto fail = [&](const std::string& what, double value, const Worst& where, const std::string& rule) {
    q.failures.push_back(what + " (" + number_text(value) + ") of cell " + std::to_string(where.id) + " at " + point_text(where.place) +
                         ", " + rule);
  };
  const Vec3 box = bounding_box(mesh).size();
  const double rule_volume = least_volume * box.x * box.y * box.z;
  if (!(q.min_volume > rule_volume))
    fail("volume in m3", q.min_volume, places.volume, "must be positive; mesh again, the cell is flat or turned inside out");
  if (!(q.closure <= largest_closure))
    fail("sum of the face vectors over their magnitudes", q.closure, places.closure,
         "must be below 1e-10 for a closed cell; mesh again without overlap");
  if (!(q.max_non_orthogonality_deg <= largest_non_orthogonality))
    fail("non-orthogonality in degrees", q.max_non_orthogonality_deg, places.non_orthogonality,
         "must not exceed 85; refine or optimise the mesh there");
  if (!(q.min_quality >= least_quality))
    fail("quality", q.min_quality, places.quality, "must be at least 0.01 (1 is a regular cell); refine or optimise the mesh there");
}

/// Collective.
std::int64_t count_meeting_pyramids(const Mesh& mesh) {
  std::vector<double> is_pyramid(static_cast<std::size_t>(mesh.n_all_cells()));
  for (int c = 0; c < mesh.n_cells; ++c) is_pyramid[c] = mesh.cell_shape[c] == CellShape::pyramid;
  mesh.halo.exchange(is_pyramid);
  std::int64_t n = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    if (is_pyramid[c] == 0) continue;
    int shared = 0;
    for (const int f : row(mesh.cell_face_start, mesh.cell_face, c))
      if (f < mesh.n_interior && mesh.face_node_start[f + 1] - mesh.face_node_start[f] == 3)
        shared += is_pyramid[mesh.owner[f] == c ? mesh.neighbour[f] : mesh.owner[f]] != 0;
    n += shared >= 2;
  }
  return sum(mesh.comm, n);
}

/// Round-off depends on the ranks, the table must not.
std::string words_above_round_off(double value) { return value < 1e-12 ? "below 1e-12" : number_text(value); }

}  // namespace

CellQuality quality_of_cell(const Mesh& mesh, int cell) {
  std::array<Vec3, 8> points;
  CellQuality found{.quality =
                        cell_quality(mesh.cell_shape[cell], positions(mesh.node, row(mesh.cell_node_start, mesh.cell_node, cell), points))};
  for (const int f : row(mesh.cell_face_start, mesh.cell_face, cell)) {
    if (mesh.neighbour[f] < 0) continue;
    const FaceShape shape = shape_of_face(mesh, f);
    found.non_orthogonality_deg = std::max(found.non_orthogonality_deg, shape.angle_deg);
    found.skewness = std::max(found.skewness, shape.skewness);
  }
  return found;
}

MeshQuality quality(const Mesh& mesh) {
  MeshQuality q;
  Places places;
  see_cells(mesh, q, places);
  see_faces(mesh, q, places);
  count(mesh, skew_cells(mesh), q.n_skew_cells, q.skew_volume);
  count(mesh, corner_cells(mesh), q.n_corner_cells, q.corner_volume);
  q.n_meeting_pyramids = count_meeting_pyramids(mesh);
  q.n_regions = count_regions(mesh);
  judge(mesh, places, q);
  return q;
}

std::string quality_table(const Mesh& mesh, const MeshQuality& q) {
  std::string table;
  const auto line = [&](const std::string& name, const std::string& value) {
    table.append(name).append(std::max<std::size_t>(2, 38 - std::min<std::size_t>(36, name.size())), ' ').append(value).append("\n");
  };
  line("cells", std::to_string(q.n_cells));
  line("faces, interior and boundary", std::to_string(q.n_interior) + "  " + std::to_string(q.n_boundary));
  line("unconnected regions", std::to_string(q.n_regions));
  line("volume, m3", number_text(q.volume));
  line("cell volume, least and largest, m3", number_text(q.min_volume) + "  " + number_text(q.max_volume));
  line("least distance of centres, mm", number_text(1e3 * q.min_spacing));
  line("quality, least and mean", number_text(q.min_quality) + "  " + number_text(q.mean_quality));
  line("non-orthogonality, max and mean",
       number_text(q.max_non_orthogonality_deg) + "  " + number_text(q.mean_non_orthogonality_deg) + " deg");
  line("skewness, max", words_above_round_off(q.max_skewness));
  if (q.n_skew_cells > 0)
    line("skew cells (a face by over " + number_text(skew_from) + ")",
         std::to_string(q.n_skew_cells) + ", " + number_text(100 * q.skew_volume / q.volume) + " % of the volume");
  if (q.n_corner_cells > 0)
    line("cells in corners (few neighbours)",
         std::to_string(q.n_corner_cells) + ", " + number_text(100 * q.corner_volume / q.volume) + " % of the volume");
  if (q.n_meeting_pyramids > 0) line("pyramids whose tips meet", std::to_string(q.n_meeting_pyramids));
  line("closure, max", words_above_round_off(q.closure));
  for (std::size_t zone = 0; zone < mesh.zones.size(); ++zone) {
    std::vector<double> volume;
    for (int c = 0; c < mesh.n_cells; ++c)
      if (mesh.cell_zone[c] == static_cast<int>(zone)) volume.push_back(mesh.cell_volume[c]);
    const std::int64_t n = sum(mesh.comm, static_cast<std::int64_t>(volume.size()));
    line("zone " + mesh.zones[zone], std::to_string(n) + " cells, " + number_text(sum(mesh.comm, volume)) + " m3");
  }
  for (const Patch& patch : mesh.patches) {
    std::vector<double> area;
    for (int f = patch.first; f < patch.end(); ++f) area.push_back(norm(mesh.face_vector[f]));
    line("patch " + patch.name, std::to_string(patch.count_global) + " faces, " + number_text(sum(mesh.comm, area)) + " m2");
  }
  for (const std::string& failure : q.failures) table.append("BAD: ").append(failure).append("\n");
  return table;
}

}  // namespace snag
