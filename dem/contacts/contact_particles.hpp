#pragma once
// The particles that one rank sees for contacts: those of its own tiles and of ghost tiles, numbered in the order of their global ids.
// The order makes sums over contacts independent of the ranks: a list of pairs sorted by these numbers is sorted by ids.
//
// Rows of tiles are gathered into records (one particle = one cache line or two), because contacts reach for partners in no order that
// tiles know.
#include <cstdint>
#include <span>
#include <vector>

#include "dem/rag.hpp"
#include "dem/tile.hpp"

namespace snag {

/// A row of a tile: particles `first` .. first + count of the local numbering, `place` .. place + count of the tile's fields.
struct ParticleRow {
  const Tile* tile = nullptr;
  Tile* owned = nullptr;  // the same tile, or null for a ghost
  int place = 0, count = 0, first = 0;
  int lattice_row = 0, column = 0;  // of the row's first particle in the rag
  std::int64_t id = 0;              // of the row's first particle
  bool near = false;                // some particle of the row is in the list of pairs
};

struct alignas(32) ParticlePosition {
  double x = 0, y = 0, z = 0, unused = 0;
};
struct alignas(64) ParticleMotion {
  double vx = 0, vy = 0, vz = 0, unused = 0, wx = 0, wy = 0, wz = 0, unused_w = 0;
};
struct alignas(64) ParticleLoad {
  double fx = 0, fy = 0, fz = 0, unused = 0, tx = 0, ty = 0, tz = 0, unused_t = 0;
};

class ContactParticles {
 public:
  explicit ContactParticles(const std::vector<Rag>& rags) : rags_(&rags) {}

  /// True if the tiles are those of the last assign (same tiles, same pieces of cloth, same ownership).
  bool holds(std::span<Tile* const> owned, std::span<const Tile* const> ghosts) const;
  void assign(std::span<Tile* const> owned, std::span<const Tile* const> ghosts);

  /// Remember positions: moved() counts from here. Fills position and present of all particles.
  void mark_positions();
  /// True if an existing particle is further than `distance` (m) from where mark_positions saw it.
  bool moved(double distance) const;
  /// True if a bond mask of an owned tile changed since mark_positions (only rags that can break are looked at).
  bool bonds_changed() const;

  /// Gather positions of rows that are near others / velocities and clear loads of the same / add the loads to the owned tiles.
  void gather_positions();
  void gather_motion();
  void scatter_loads() const;

  int size() const { return static_cast<int>(position.size()); }
  int rag_of(int p) const { return rows[row_of[p]].tile->rag; }
  bool owned(int p) const { return rows[row_of[p]].owned != nullptr; }
  int place(int p) const { return rows[row_of[p]].place + p - rows[row_of[p]].first; }
  std::int64_t id(int p) const { return rows[row_of[p]].id + p - rows[row_of[p]].first; }
  /// True if p < q are neighbours on the lattice of one rag with a whole bond between them.
  bool bonded(int p, int q) const;

  std::vector<ParticleRow> rows;           // sorted by id
  std::vector<int> row_of;                 // [n]
  std::vector<ParticlePosition> position;  // [n] m; of near rows, or of all right after mark_positions
  std::vector<ParticleMotion> motion;      // [n] m/s, rad/s; of near rows
  std::vector<ParticleLoad> load;          // [n] N, N m; of near rows
  std::vector<char> present;               // [n] exists with a finite position
  std::int64_t n_not_finite = 0;           // existing particles without

 private:
  struct Piece {  // what a tile was at assign
    const Tile* tile;
    int rag, column, row, nx, ny;
    bool owned;
    double bonds;  // sum of the bond masks at mark_positions
    bool operator==(const Piece&) const = default;
  };
  double bond_count(const Piece& piece) const;

  const std::vector<Rag>* rags_;
  std::vector<Piece> pieces_;
  std::vector<double> marked_x_, marked_y_, marked_z_;  // [n] m
};

}  // namespace snag
