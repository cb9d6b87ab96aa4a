// The lowest cell_id of a region spreads through it, within a rank at once, across ranks by halo.
#include "mesh/regions.hpp"

#include <algorithm>
#include <numeric>

#include "parallel/sum.hpp"

namespace snag {

std::vector<std::int64_t> regions(const Mesh& mesh) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.n_all_cells()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int cell) {
    while (parent[cell] != cell) cell = parent[cell] = parent[parent[cell]];
    return cell;
  };
  for (int f = 0; f < mesh.n_interior; ++f) parent[root(mesh.owner[f])] = root(mesh.neighbour[f]);

  std::vector<std::int64_t> label(mesh.cell_id);
  for (bool changed = true; changed;) {
    for (int c = 0; c < mesh.n_all_cells(); ++c) label[root(c)] = std::min(label[root(c)], label[c]);
    std::int64_t n_changed = 0;
    for (int c = 0; c < mesh.n_all_cells(); ++c)
      if (label[c] != label[root(c)]) label[c] = label[root(c)], ++n_changed;
    const std::vector<std::int64_t> before(label);
    mesh.halo.exchange(std::span(label));
    for (int c = mesh.n_cells; c < mesh.n_all_cells(); ++c) label[c] = std::min(label[c], before[c]), n_changed += label[c] != before[c];
    changed = sum(mesh.comm, n_changed) > 0;
  }
  return label;
}

}  // namespace snag
