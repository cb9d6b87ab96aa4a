#pragma once
// All particles of this rank in one row: particle b of the list is place k of a tile. The transfers work on the list, forces on the tiles.
#include <cstddef>
#include <span>
#include <vector>

#include "dem/particles/tile.hpp"

namespace snag {

class ParticleList {
 public:
  ParticleList() = default;
  explicit ParticleList(std::span<const Tile> tiles) {
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      const Tile& tile = tiles[t];
      for (int j = 0; j < tile.ny; ++j)
        for (int k = tile.index(0, j); k < tile.index(tile.nx, j); ++k)
          if (tile.exists[k] > 0) tile_.push_back(static_cast<int>(t)), place_.push_back(k);
    }
  }
  std::size_t size() const { return place_.size(); }
  int tile(std::size_t b) const { return tile_[b]; }
  int place(std::size_t b) const { return place_[b]; }

 private:
  std::vector<int> tile_, place_;
};

/// Numbers beside those of the tiles, in the tiles' own layout: `n_fields` of them for each place k of each tile.
class TileArrays {
 public:
  /// All zero.
  void reset(std::span<const Tile> tiles, int n_fields) {
    values_.resize(tiles.size());
    for (std::size_t t = 0; t < tiles.size(); ++t) values_[t].assign(static_cast<std::size_t>(n_fields) * tiles[t].exists.size(), 0.0);
    n_fields_ = n_fields;
  }
  /// Of the right size, whatever they hold.
  void fit(std::span<const Tile> tiles, int n_fields) {
    bool fits = n_fields == n_fields_ && tiles.size() == values_.size();
    for (std::size_t t = 0; fits && t < tiles.size(); ++t) fits = values_[t].size() == n_fields * tiles[t].exists.size();
    if (!fits) reset(tiles, n_fields);
  }
  double* field(std::size_t tile, int f) { return values_[tile].data() + f * (values_[tile].size() / n_fields_); }
  const double* field(std::size_t tile, int f) const { return values_[tile].data() + f * (values_[tile].size() / n_fields_); }

 private:
  int n_fields_ = 1;
  std::vector<AlignedDoubles> values_;
};

}  // namespace snag
