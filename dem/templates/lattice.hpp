#pragma once
// The lattice of one piece of cloth: which places exist, where they stand at birth, and how it is cut into tiles.
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"
#include "dem/templates/pose_plan.hpp"

namespace snag {

struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};
/// v turned by the unit quaternion q.
Vec3 rotate(const Quaternion& q, const Vec3& v);
/// Rotation by q, then by p.
Quaternion product(const Quaternion& p, const Quaternion& q);
/// Rotation by |angle| rad about `angle`.
Quaternion rotation_by(const Vec3& angle);
/// Rotation that takes x, y, z to `lengthwise`, `crosswise` (made perpendicular to it), and their cross product. Throws Error(usage) if
/// they are parallel or zero.
Quaternion rotation_to(const Vec3& lengthwise, const Vec3& crosswise);

/// Position and orientation of one particle at birth.
struct ParticlePose {
  Vec3 position;
  Quaternion orientation;
};

/// Release of a piece at a patch of the mesh: its `centre` is found there before the run begins.
struct ReleasePlan {
  std::string patch;  // empty: centre is as given
  double depth = 0;   // of the centre below the patch, into the water, m
  double spread = 0;  // 0: at the middle of the patch; 1: anywhere on it
  int seed = 1, index = 0;
};

struct RagPiece {
  Rag rag;                           // n_columns, n_rows, mask_radius set; first_particle, n_particles, n_bonds are set by the RagSystem
  Vec3 centre;                       // of the lattice, m
  Quaternion orientation;            // of the lattice frame
  Vec3 velocity, spin;               // of the whole piece, about its centre; m/s, rad/s
  double insert_time = 0;            // before it the piece is not in the run, s
  bool match_flow_velocity = false;  // begins with the mean velocity of the water at its particles, added to `velocity`
  PosePlan plan;                     // how `poses` are made (dem/poses/)
  ReleasePlan release;
  std::vector<ParticlePose> poses;  // [n_rows * n_columns] places about `centre`, instead of the flat lattice, if not empty

  bool exists(int column, int row) const { return rag.exists(column, row); }
  ParticlePose pose(int column, int row) const;
};

/// How a lattice is cut: tile t of `columns` x `rows` (row by row) begins at lattice column column_start[t % columns].
struct TileGrid {
  int columns = 1, rows = 1;
  std::vector<int> column_start, row_start;  // [columns + 1], [rows + 1]
  int first_tile = 0;                        // number of the piece's first tile among all pieces

  int n_tiles() const { return columns * rows; }
};
/// Sides of at most max_tile_columns x max_tile_rows, nearly equal, chosen so that rows fill their vectors of 8.
TileGrid tile_grid(int n_columns, int n_rows);

/// Tile `t` (within the piece) with mask, bonds (ring included) and poses (ring included).
Tile make_tile(const RagPiece& piece, int rag_index, const TileGrid& grid, int t);

/// Particles and bonds of a piece that exist, by its mask and its cuts.
std::int64_t count_particles(const RagPiece& piece);
std::int64_t count_bonds(const RagPiece& piece);

/// Id of the particle at place (i, j) of a tile.
inline std::int64_t particle_id(const Rag& rag, const Tile& tile, int i, int j) {
  return rag.first_particle + static_cast<std::int64_t>(tile.row + j) * rag.n_columns + tile.column + i;
}

}  // namespace snag
