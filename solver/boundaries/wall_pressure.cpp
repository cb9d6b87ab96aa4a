#include "solver/boundaries/wall_pressure.hpp"

#include <algorithm>
#include <utility>

#include "mesh/geometry.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "solver/fields/face.hpp"

namespace snag {

namespace {

/// A node of a wall and the direction out of the water of a face of it.
struct NodeNormal {
  std::int64_t node;
  Vec3 normal;
};

/// Numbers of the nodes where faces of walls meet at more than 45 degrees, as at an octagon: those of a coarse curved wall do not. Sorted.
/// Collective.
std::vector<std::int64_t> nodes_at_edges(const Mesh& mesh, const BoundarySet& boundary) {
  constexpr double least_cosine = 0.7;
  std::vector<NodeNormal> own;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    for (int f = mesh.patches[p].first; boundary.is_wall(p) && f < mesh.patches[p].end(); ++f)
      for (const int node : row(mesh.face_node_start, mesh.face_node, f)) own.push_back({mesh.node_id[node], unit(mesh.face_vector[f])});
  // The rank with the number `node` modulo the number of ranks judges a node: ranks that share it need not share a face there.
  const int n_ranks = size_of(mesh.comm);
  const auto judge = [n_ranks](const NodeNormal& row) { return static_cast<int>(row.node % n_ranks); };
  std::sort(own.begin(), own.end(), [&](const NodeNormal& a, const NodeNormal& b) { return judge(a) < judge(b); });
  std::vector<int> counts(static_cast<std::size_t>(n_ranks));
  for (const NodeNormal& row : own) ++counts[judge(row)];
  std::vector<NodeNormal> met = exchanged(mesh.comm, RowsByRank<NodeNormal>{std::move(own), std::move(counts)}).rows;
  std::sort(met.begin(), met.end(), [](const NodeNormal& a, const NodeNormal& b) { return a.node < b.node; });
  std::vector<std::int64_t> judged;
  for (std::size_t i = 0; i < met.size(); ++i)
    for (std::size_t j = i + 1; j < met.size() && met[j].node == met[i].node; ++j)
      if (dot(met[i].normal, met[j].normal) < least_cosine && (judged.empty() || judged.back() != met[i].node))
        judged.push_back(met[i].node);
  std::vector<std::int64_t> found = gathered(mesh.comm, judged);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<WallCell> wall_cells(const Mesh& mesh, const BoundarySet& boundary) {
  std::vector<double> kind(static_cast<std::size_t>(mesh.n_all_cells()));
  const auto set = [&](int c, WallCell where) { kind[c] = static_cast<double>(where); };
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    for (int f = mesh.patches[p].first; boundary.is_wall(p) && f < mesh.patches[p].end(); ++f) set(mesh.owner[f], WallCell::at_wall);
  const std::vector<std::int64_t> edges = nodes_at_edges(mesh, boundary);
  for (int c = 0; c < mesh.n_cells; ++c)
    for (const int node : row(mesh.cell_node_start, mesh.cell_node, c))
      if (std::binary_search(edges.begin(), edges.end(), mesh.node_id[node])) set(c, WallCell::at_edge);
  mesh.halo.exchange(kind);
  std::vector<WallCell> all;
  for (const double k : kind) all.push_back(static_cast<WallCell>(static_cast<int>(k)));
  return all;
}

Vec3 acceleration_at_wall(const Vec3& velocity, const BoundaryValues& values, int b, bool slips) {
  if (!slips) return values.acceleration[b];
  const Vec3& v = values.velocity[b];
  if (norm_squared(v) == 0) return {};
  const double carried = std::clamp(dot(velocity, v) / norm_squared(v), 0.0, 1.0);
  return carried * carried * values.acceleration[b];
}

std::optional<double> slope_at_wall_function(const Mesh& mesh, std::span<const WallCell> wall_cell, const Flow& flow,
                                             std::span<const Vec3> held, int face) {
  const int cell = mesh.owner[face];
  if (wall_cell[cell] == WallCell::at_edge) return {};
  Vec3 total, total_held;
  double n = 0;
  for_each_neighbour(mesh, cell, [&](int other, double share) {
    if (wall_cell[other] != WallCell::inner) return;
    total += share * flow.pressure_gradient[other], n += share;
    if (!held.empty()) total_held += share * held[other];
  });
  if (n == 0) return {};
  // How much of G the pressures of the neighbours show: the least squares of p_N - p_P - a G.d.
  const Vec3 gradient = total / n;
  double shown = 0, expected = 0;
  for (const int f : row(mesh.cell_face_start, mesh.cell_face, cell)) {
    if (f >= mesh.n_interior) continue;
    const bool is_owner = mesh.owner[f] == cell;
    const double share = share_of_face(mesh, f, is_owner), change = dot(gradient, mesh.delta[f]) * (is_owner ? 1 : -1);
    shown += share * change * (flow.pressure[mesh.owner[f] + mesh.neighbour[f] - cell] - flow.pressure[cell]);
    expected += share * change * change;
  }
  const double part = 2 * shown < expected ? std::max(2 * shown / expected, 0.0) : 1;
  return part * dot(gradient - total_held / n, unit(mesh.face_vector[face]));
}

}  // namespace snag
