#pragma once
// Directions of the cloth at a particle, from its bonded neighbours: along the row, and from row to row. Zero where there is none.
#include "coupling/fluid_force.hpp"

namespace snag {

class LatticeDirections {
 public:
  explicit LatticeDirections(const Particles& particles)
      : x_(particles.position),
        along_(particles.tile.bond_x.data()),
        across_(particles.tile.bond_y.data()),
        stride_(particles.tile.stride) {}
  /// Sum of the whole bonds at place k along the row, m, in the sense of growing columns.
  Vec3 along(int k) const { return sum(along_, k, 1); }
  Vec3 across(int k) const { return sum(across_, k, stride_); }
  /// Whole bonds of a particle: 0 to 4.
  double count(int k) const { return along_[k] + along_[k - 1] + across_[k] + across_[k - stride_]; }

 private:
  Vec3 sum(const double* bond, int k, int step) const {
    const double before = bond[k - step], after = bond[k];
    return {after * (x_.x[k + step] - x_.x[k]) + before * (x_.x[k] - x_.x[k - step]),
            after * (x_.y[k + step] - x_.y[k]) + before * (x_.y[k] - x_.y[k - step]),
            after * (x_.z[k + step] - x_.z[k]) + before * (x_.z[k] - x_.z[k - step])};
  }
  VectorArray x_;
  const double *along_, *across_;
  int stride_;
};

/// v over its length; zero for the zero vector, without a branch.
inline Vec3 direction(const Vec3& v) {
  const double square = norm_squared(v);
  return v * (1 / std::sqrt(square + (square > 0 ? 0 : 1)));
}

}  // namespace snag
