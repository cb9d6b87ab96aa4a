#pragma once
// Particles live in lattice tiles: a piece of cloth (sheet, disc, fibre, single sphere) is a masked rectangular lattice, cut into tiles of
// at most max_tile_columns x max_tile_rows particles. A tile is stored with a ring of one particle around it (copies of its neighbours),
// field by field, row by row, so that bonds are implicit neighbours k -> k + 1 (along the row, "x") and k -> k + stride (between rows,
// "y"), and every loop runs over contiguous rows and vectorises.
//
// A bond between two tiles is computed by both, from the same numbers in the same order: so forces need no way back, and results do not
// depend on the ranks.
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

inline constexpr int max_tile_columns = 158, max_tile_rows = 14;
inline constexpr int max_stride = (max_tile_columns + 2 + 7) / 8 * 8;  // doubles in a row, ring included

/// Memory that starts at a cache line: a vector load that crosses two lines costs double.
template <class T>
struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  bool operator==(const CacheAligned&) const = default;
};
using AlignedDoubles = std::vector<double, CacheAligned<double>>;

/// Value of Tile::free of a particle that a hold keeps in place, but not from turning.
inline constexpr double pinned = 0.25;

struct Tile {
  enum Field : int {
    x,
    y,
    z,  // position, m
    vx,
    vy,
    vz,  // velocity, m/s
    qw,
    qx,
    qy,
    qz,  // orientation: turns the lattice frame at birth into the present one (unit quaternion)
    wx,
    wy,
    wz,  // angular velocity in the fixed frame, rad/s
    fx,
    fy,
    fz,  // force of this sub-step, N
    tx,
    ty,
    tz,  // torque, N m
    n_fields
  };
  static constexpr int n_state = 13;  // x .. wz: what is sent to others and stored

  int rag = 0;                 // index into the list of rags
  int column = 0, row = 0;     // lattice index of the tile's first particle
  int nx = 0, ny = 0;          // particles in the tile, without ring
  int stride = 0;              // doubles in a row of a field, a multiple of 8, >= nx + 2
  AlignedDoubles values;       // [n_fields][ny + 2][stride], fields staggered against cache-set conflicts
  std::size_t field_size = 0;  // doubles from one field to the next

  AlignedDoubles exists;  // [(ny + 2) * stride] 1 or 0: the mask of the piece, ring included
  AlignedDoubles free;    // [(ny + 2) * stride] 1: obeys forces and torques; `pinned`: torques alone, keeps its velocity; 0: keeps velocity
                          // and rotation (clamped, or absent)
  // [(ny + 2) * stride] 1 where the bond k - k+1, k - k+stride is whole, 0 where there is none or it broke
  AlignedDoubles bond_x, bond_y;
  int n_breaks = 0;  // grows whenever a bond mark is taken away: lists that know of bonds are out of date
  // [n][(ny + 2) * stride] numbers that an external force stores for each particle: moved and stored with it; empty if none
  AlignedDoubles particle_state;
  // [3][(ny + 2) * stride] by which a hold in motion changes the velocity of each particle in this sub-step, m/s; empty if none does
  AlignedDoubles held_change;

  /// Sizes the arrays for nx x ny particles: everything zero, unit quaternions, nothing exists.
  void allocate(int tile_nx, int tile_ny);
  double* field(int f) { return values.data() + f * field_size; }
  const double* field(int f) const { return values.data() + f * field_size; }
  /// Place of the particle in column i, row j of the tile; -1 and nx, ny are the ring.
  int index(int i, int j) const { return (j + 1) * stride + i + 1; }
  Vec3 vector(int first_field, int k) const { return {field(first_field)[k], field(first_field + 1)[k], field(first_field + 2)[k]}; }
  void set_vector(int first_field, int k, const Vec3& v) {
    field(first_field)[k] = v.x, field(first_field + 1)[k] = v.y, field(first_field + 2)[k] = v.z;
  }
};

}  // namespace snag
