#include "dem/particles/tile.hpp"

#include <algorithm>

namespace snag {

void Tile::allocate(int tile_nx, int tile_ny) {
  nx = tile_nx, ny = tile_ny;
  stride = (nx + 2 + 7) / 8 * 8;
  const std::size_t places = static_cast<std::size_t>(ny + 2) * stride;
  // Consecutive fields start 3 cache lines apart modulo the 4 KiB after which a first-level cache repeats: no two of the 19 streams share a
  // set.
  constexpr std::size_t line = 8, lines_of_a_way = 64, stagger = 3;
  std::size_t lines = places / line;
  while (lines % lines_of_a_way != stagger) ++lines;
  field_size = lines * line;
  values.assign(n_fields * field_size, 0.0);
  std::fill_n(field(qw), field_size, 1.0);
  exists.assign(places, 0.0), free.assign(places, 0.0), bond_x.assign(places, 0.0), bond_y.assign(places, 0.0);
}

}  // namespace snag
