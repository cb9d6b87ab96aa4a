#include "coupling/cloth_edges.hpp"

#include <algorithm>
#include <cmath>

#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

constexpr double farthest = 1e3;  // m

/// Half of the cloth's extent along a lattice line that is `across` from the middle; `places` on the longest line.
double half_extent(const Rag& rag, int places, double across) {
  const double R = rag.mask_radius;
  return R > 0 ? std::sqrt(std::max(R * R - across * across, rag.radius * rag.radius)) : places * rag.radius;
}

double open_share(double coverage, double over_width) {
  const double beyond_open_edge = 0.5 * std::erfc(0.5 * over_width);
  return std::clamp((1 - coverage) / beyond_open_edge, 0.0, 1.0);
}

/// visit(tile number, its rag, place, column and row in the rag) for the particles of all tiles.
template <class Visit>
void for_each_particle(const std::vector<Rag>& rags, std::span<const Tile> tiles, const Visit& visit) {
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const Tile& tile = tiles[t];
    for_particles(tile, [&](int k, int i, int j) { visit(t, rags[static_cast<std::size_t>(tile.rag)], k, tile.column + i, tile.row + j); });
  }
}

}  // namespace

ClothEdges::ClothEdges(const std::vector<Rag>& rags) : rags_(rags) {
  for (const Rag& rag : rags) {
    std::vector<Line>& lines = lines_.emplace_back(static_cast<std::size_t>(rag.n_rows + rag.n_columns));
    if (!rag.cuts.empty())
      for (int j = 0; j < rag.n_rows; ++j)
        for (int i = 0; i < rag.n_columns; ++i) {
          if (!rag.exists(i, j)) continue;
          if (rag.exists(i + 1, j) && !rag.has_bond(i, j, 0)) lines[j].cuts.push_back(i);
          if (rag.exists(i, j + 1) && !rag.has_bond(i, j, 1)) lines[rag.n_rows + i].cuts.push_back(j);
        }
    for (Line& line : lines) line.first = n_ends_, n_ends_ += 2 * (line.cuts.size() + 1);
  }
}

void ClothEdges::find_distances(MPI_Comm comm, std::span<const Tile> tiles, TileArrays& arrays, const Fields& fields) const {
  const auto part_of = [](const Line& line, int place) {
    return static_cast<std::size_t>(std::lower_bound(line.cuts.begin(), line.cuts.end(), place) - line.cuts.begin());
  };
  std::vector<double> open(n_ends_, 0.0);  // one particle fills each: a sum over the ranks adds zeros
  for_each_particle(rags_, tiles, [&](std::size_t t, const Rag& rag, int k, int i, int j) {
    const double share = open_share(arrays.field(t, fields.coverage)[k], rag.radius / arrays.field(t, fields.width)[k]);
    const auto fill = [&](const Line& line, int place, bool exists_before, bool exists_after) {
      const std::size_t part = part_of(line, place), end = line.first + 2 * part;
      if (!exists_before || (part > 0 && line.cuts[part - 1] == place - 1)) open[end] = share;
      if (!exists_after || (part < line.cuts.size() && line.cuts[part] == place)) open[end + 1] = share;
    };
    fill(row(tiles[t], j), i, rag.exists(i - 1, j), rag.exists(i + 1, j));
    fill(column(tiles[t], i), j, rag.exists(i, j - 1), rag.exists(i, j + 1));
  });
  MPI_Allreduce(MPI_IN_PLACE, open.data(), static_cast<int>(open.size()), MPI_DOUBLE, MPI_SUM, comm);
  for_each_particle(rags_, tiles, [&](std::size_t t, const Rag& rag, int k, int i, int j) {
    const auto [x, y] = rag.place(i, j);
    // Of the edges to both sides: from `from` at the place `number` of a line of n places that ends at -half and half.
    const auto inverse = [&](const Line& line, int number, int n, double from, double half) {
      const auto at_cut = [&](std::size_t cut) { return (2 * line.cuts[cut] + 1 - (n - 1)) * rag.radius; };
      const std::size_t own = part_of(line, number);
      double sum = 0, closed = 1;
      for (std::size_t p = own + 1; p-- > 0;) {
        const double o = open[line.first + 2 * p], edge = p > 0 ? at_cut(p - 1) : -half;
        sum += closed * o / std::max(from - edge, rag.radius), closed *= 1 - o;
      }
      closed = 1;
      for (std::size_t p = own; p <= line.cuts.size(); ++p) {
        const double o = open[line.first + 2 * p + 1], edge = p < line.cuts.size() ? at_cut(p) : half;
        sum += closed * o / std::max(edge - from, rag.radius), closed *= 1 - o;
      }
      return sum;
    };
    const double along = inverse(row(tiles[t], j), i, rag.n_columns, x, half_extent(rag, rag.n_columns, y)),
                 across = inverse(column(tiles[t], i), j, rag.n_rows, y, half_extent(rag, rag.n_rows, x));
    arrays.field(t, fields.edge_distance)[k] = 1 / std::max(std::hypot(along, across), 1 / farthest);
  });
}

}  // namespace snag
