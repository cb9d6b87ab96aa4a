#include "coupling/cloth_edges.hpp"

#include <algorithm>
#include <cmath>

#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

constexpr double farthest = 1e3;  // m

/// Numbers of the two ends of each row, then of each column, of all rags one after the other.
class Ends {
 public:
  explicit Ends(const std::vector<Rag>& rags) {
    for (const Rag& rag : rags) first_.push_back(first_.back() + 2 * static_cast<std::size_t>(rag.n_rows + rag.n_columns));
  }
  std::size_t count() const { return first_.back(); }
  std::size_t of_row(const Tile& tile, int row) const {
    return first_[static_cast<std::size_t>(tile.rag)] + 2 * static_cast<std::size_t>(row);
  }
  std::size_t of_column(const Tile& tile, const Rag& rag, int column) const { return of_row(tile, rag.n_rows + column); }

 private:
  std::vector<std::size_t> first_{0};
};

/// Half of the cloth's extent along a lattice line that is `across` from the middle; `places` on the longest line.
double half_extent(const Rag& rag, int places, double across) {
  const double R = rag.mask_radius;
  return R > 0 ? std::sqrt(std::max(R * R - across * across, rag.radius * rag.radius)) : places * rag.radius;
}

double open_share(double coverage) { return std::clamp(2 * (1 - coverage), 0.0, 1.0); }

/// visit(tile number, its rag, place, column and row in the rag) for the particles of all tiles.
template <class Visit>
void for_each_particle(const std::vector<Rag>& rags, std::span<const Tile> tiles, const Visit& visit) {
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const Tile& tile = tiles[t];
    for_particles(tile, [&](int k, int i, int j) { visit(t, rags[static_cast<std::size_t>(tile.rag)], k, tile.column + i, tile.row + j); });
  }
}

}  // namespace

void find_edge_distances(MPI_Comm comm, const std::vector<Rag>& rags, std::span<const Tile> tiles, TileArrays& arrays, int coverage,
                         int edge_distance) {
  const Ends ends(rags);
  std::vector<double> open(ends.count(), 0.0);  // one particle fills each: a sum over the ranks adds zeros
  for_each_particle(rags, tiles, [&](std::size_t t, const Rag& rag, int k, int column, int row) {
    const double share = open_share(arrays.field(t, coverage)[k]);
    const std::size_t in_row = ends.of_row(tiles[t], row), in_column = ends.of_column(tiles[t], rag, column);
    if (!rag.exists(column - 1, row)) open[in_row] = share;
    if (!rag.exists(column + 1, row)) open[in_row + 1] = share;
    if (!rag.exists(column, row - 1)) open[in_column] = share;
    if (!rag.exists(column, row + 1)) open[in_column + 1] = share;
  });
  MPI_Allreduce(MPI_IN_PLACE, open.data(), static_cast<int>(open.size()), MPI_DOUBLE, MPI_SUM, comm);
  for_each_particle(rags, tiles, [&](std::size_t t, const Rag& rag, int k, int column, int row) {
    const auto [x, y] = rag.place(column, row);
    const auto inverse = [&](double place, double half, std::size_t end) {
      return open[end] / std::max(half + place, rag.radius) + open[end + 1] / std::max(half - place, rag.radius);
    };
    const double along = inverse(x, half_extent(rag, rag.n_columns, y), ends.of_row(tiles[t], row)),
                 across = inverse(y, half_extent(rag, rag.n_rows, x), ends.of_column(tiles[t], rag, column));
    arrays.field(t, edge_distance)[k] = 1 / std::max(std::hypot(along, across), 1 / farthest);
  });
}

}  // namespace snag
