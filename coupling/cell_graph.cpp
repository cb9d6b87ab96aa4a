// A face conducts k = |S|/|d|, d from centre to centre: of the three usual choices for lines that are not normal to their face the one
// between S.d/|d|^2 and |S|^2/(S.d). On distorted tetrahedra a diffusion is then 2 % too wide, with the others 6 % too narrow and 10
// % too wide (tests/unit/coupling/diffusion_kernel.cpp).
#include "coupling/cell_graph.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

struct CellRow {
  std::int64_t id;
  Vec3 centre;
  double volume;
  int rank, number;  // that owns it, and its number there
};
struct FaceRow {
  std::int64_t a, b;  // cell_id
  double conductance;
  bool is_facet;
};

}  // namespace

int CellGraph::find(std::int64_t cell_id) const {
  // Where all cells of the mesh are near, the numbers have no gaps.
  const std::int64_t guess = id.empty() ? -1 : cell_id - id.front();
  if (guess >= 0 && guess < size() && id[static_cast<std::size_t>(guess)] == cell_id) return static_cast<int>(guess);
  const auto place = std::lower_bound(id.begin(), id.end(), cell_id);
  return place != id.end() && *place == cell_id ? static_cast<int>(place - id.begin()) : -1;
}

void CellGraph::update(const Mesh& mesh, const RankBoxes& boxes, double margin) {
  const int me = rank_of(mesh.comm);
  RowsByRank<CellRow> cells;
  RowsByRank<FaceRow> faces;
  for (const CellBox& box : boxes) {
    const std::size_t n_cells = cells.rows.size(), n_faces = faces.rows.size();
    for (int c = 0; c < mesh.n_cells; ++c)
      if (box.is_near(mesh.cell_centre[c], margin))
        cells.rows.push_back({mesh.cell_id[c], mesh.cell_centre[c], mesh.cell_volume[c], me, c});
    for (int f = 0; f < mesh.n_interior; ++f) {
      const int P = mesh.owner[f], N = mesh.neighbour[f];
      if (P >= mesh.n_cells || mesh.cell_id[P] == mesh.cell_id[N] || !box.is_near(mesh.cell_centre[P], margin)) continue;
      const Vec3& d = mesh.delta[f];
      faces.rows.push_back({mesh.cell_id[P], mesh.cell_id[N], norm(mesh.face_vector[f]) / norm(d), f >= mesh.first_facet});
    }
    cells.counts.push_back(static_cast<int>(cells.rows.size() - n_cells)),
        faces.counts.push_back(static_cast<int>(faces.rows.size() - n_faces));
  }
  cells = exchanged(mesh.comm, cells), faces = exchanged(mesh.comm, faces);

  std::sort(cells.rows.begin(), cells.rows.end(), [](const CellRow& a, const CellRow& b) { return a.id < b.id; });
  const std::size_t n = cells.rows.size();
  id.resize(n), centre.resize(n), volume.resize(n), own.resize(n), at_interface.assign(n, 0);
  for (std::size_t c = 0; c < n; ++c) {
    const CellRow& row = cells.rows[c];
    id[c] = row.id, centre[c] = row.centre, volume[c] = row.volume, own[c] = row.rank == me ? row.number : -1;
  }

  std::vector<std::array<int, 2>> ends(faces.rows.size());  // numbers in the graph; -1: the face leads beyond the margin
  start.assign(n + 1, 0);
  for (std::size_t f = 0; f < ends.size(); ++f) {
    const FaceRow& face = faces.rows[f];
    const int a = find(face.a), b = a < 0 ? -1 : find(face.b);
    ends[f] = {a, b};
    if (b < 0) continue;
    ++start[static_cast<std::size_t>(a) + 1], ++start[static_cast<std::size_t>(b) + 1];
    if (face.is_facet) at_interface[a] = at_interface[b] = 1;
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::pair<int, double>> links(static_cast<std::size_t>(start.back()));
  std::vector<int> next(start.begin(), start.end() - 1);
  for (std::size_t f = 0; f < ends.size(); ++f) {
    const auto [a, b] = ends[f];
    if (b < 0) continue;
    links[next[a]++] = {b, faces.rows[f].conductance}, links[next[b]++] = {a, faces.rows[f].conductance};
  }
  for (std::size_t c = 0; c < n; ++c) std::sort(links.begin() + start[c], links.begin() + start[c + 1]);
  beyond.resize(links.size()), conductance.resize(links.size());
  for (std::size_t l = 0; l < links.size(); ++l) std::tie(beyond[l], conductance[l]) = links[l];
}

}  // namespace snag
