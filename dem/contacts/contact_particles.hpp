#pragma once
// The particles that one rank sees for contacts: those of its own tiles and of ghost tiles, numbered in the order of their global ids.
// The order makes sums over contacts independent of the ranks: a list of pairs sorted by these numbers is sorted by ids.
//
// Rows of tiles are gathered into records (one particle = one cache line or two), because contacts reach for partners in no order that
// tiles know.
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "dem/contacts/surface_contact.hpp"
#include "dem/particles/integrator.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

/// A row of a tile: particles `first` .. first + count of the local numbering, `place` .. place + count of the tile's fields.
struct ParticleRow {
  const Tile* tile = nullptr;
  Tile* owned = nullptr;  // the same tile, or null for a ghost
  int place = 0, count = 0, first = 0;
  int lattice_row = 0, column = 0;  // of the row's first particle in the rag
  std::int64_t id = 0;              // of the row's first particle
  bool near = false;                // some particle of the row is in the list of pairs
  bool at_wall = false;             // some particle of the row is in the list of walls
};

struct alignas(32) ParticlePosition {
  double x = 0, y = 0, z = 0, unused = 0;
};
struct alignas(64) ParticleMotion {
  double vx = 0, vy = 0, vz = 0, unused = 0, wx = 0, wy = 0, wz = 0, unused_w = 0;
};
struct alignas(64) ParticleLoad {
  double fx = 0, fy = 0, fz = 0, unused = 0, tx = 0, ty = 0, tz = 0, unused_t = 0;
  void add(const Vec3& force, const Vec3& torque) {
    fx += force.x, fy += force.y, fz += force.z;
    tx += torque.x, ty += torque.y, tz += torque.z;
  }
};

class ContactParticles {
 public:
  explicit ContactParticles(const std::vector<Rag>& rags) : rags_(&rags) {}

  /// True if the tiles are those of the last assign (same tiles, same pieces of cloth, same ownership).
  bool holds(std::span<Tile* const> owned, std::span<const Tile* const> ghosts) const;
  void assign(std::span<Tile* const> owned, std::span<const Tile* const> ghosts);

  /// Remember positions: what follows counts from here. Fills position and present of all particles.
  void mark_positions();
  /// True if no two particles have come nearer to each other than by 2 `distance` (m) since mark_positions; false if that is not sure. What
  /// counts is the motion beside a common rigid one, which the marks are made to follow: a rag that is carried along keeps its list.
  /// `moved`: how far the particles of the owned tiles have moved since the last call, m; null if that is not known. It saves a look at all
  /// of them while even the sum of such bounds is small.
  bool keeps_distances(double distance, const Box* moved);
  /// Upper bound of how far a particle is from where it was at the last reset_path, m; as the last keeps_distances saw it.
  double path() const { return path_ + largest_offset_; }
  void reset_path() { path_ = largest_offset_; }
  /// True if bonds of an owned tile broke since mark_positions.
  bool bonds_changed() const;

  /// Gather positions, surfaces and velocities of rows that are near others.
  void gather();
  /// Clear the loads of rows that are near others or walls / add them to the owned tile that was given to assign as number i.
  void clear_loads();
  void add_loads(std::size_t i) const;

  int size() const { return static_cast<int>(position.size()); }
  int rag_of(int p) const { return rows[row_of[p]].tile->rag; }
  bool owned(int p) const { return is_owned[p]; }
  int place(int p) const { return rows[row_of[p]].place + p - rows[row_of[p]].first; }
  std::int64_t id(int p) const { return rows[row_of[p]].id + p - rows[row_of[p]].first; }
  /// True if p < q are neighbours on the lattice of one rag with a whole bond between them.
  bool bonded(int p, int q) const;
  /// True if two particles are of one rag and so near on its lattice that the surface which either carries holds the other: those touch as
  /// spheres, when the cloth is sheared or creased enough.
  bool near_on_lattice(int p, int q) const;

  std::vector<ParticleRow> rows;           // sorted by id
  std::vector<int> row_of;                 // [n]
  std::vector<ParticlePosition> position;  // [n] m; of near rows, or of all right after mark_positions
  std::vector<ParticleSurface> surface;    // [n] of near rows
  std::vector<ParticleMotion> motion;      // [n] m/s, rad/s; of near rows
  std::vector<ParticleLoad> load;          // [n] N, N m; of rows near others or walls
  std::vector<char> is_owned;              // [n]
  std::vector<char> present;               // [n] exists with a finite position
  std::int64_t n_not_finite = 0;           // existing particles without

 private:
  struct Piece {  // what a tile was at assign
    const Tile* tile;
    int rag, column, row, nx, ny;
    bool owned;
    int n_breaks;  // at mark_positions
  };
  /// From the marks to the present positions, m, of the particles of owned or of ghost tiles.
  Box offsets(bool of_owned) const;
  bool are_within(double distance, const Box& offsets);
  bool follow_marks();

  const std::vector<Rag>* rags_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<int>> rows_of_;               // [owned tiles] of `rows`
  std::vector<double> marked_x_, marked_y_, marked_z_;  // [n] m
  double path_ = 0, largest_offset_ = 0;                // m
  Box owned_offsets_;                                   // bounds, at the last keeps_distances
};

}  // namespace snag
