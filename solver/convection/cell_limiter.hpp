#pragma once
// Cell limiters: a psi in [0, 1] for which u_P + psi G (x_f - x_P) stays within [u_min, u_max] of the cell (velocity_range.hpp).
//
//   a = change to the face, G (x_f - x_P);   b = u_max - u_P where a > 0, u_min - u_P where a < 0;   psi: a function of a and b
//
// The minimum over faces, for each component of u by itself: one that hardly varies does not limit the others.
#include "solver/convection/limiter.hpp"

namespace snag {

/// From the centre of cell c to that of its face f. Across a period it needs the other cell, which takes half the time of a limiter.
inline Vec3 way_to_face(const Mesh& mesh, bool has_periods, int c, int f) {
  if (!has_periods) return mesh.face_centre[f] - mesh.cell_centre[c];
  const int P = mesh.owner[f];
  return mesh.face_centre[f] - mesh.cell_centre[P] - static_cast<double>(P != c) * mesh.delta[f];
}

/// The loop over the faces of the cells, compiled for one function. `Law` has
///   static FourValues factor(const FourValues& a, const FourValues& b, double e2)
/// psi of one face, for each component; what lies above 1 counts as 1, and so does what it gives where a is 0. e2: threshold() times the
/// volume of the cell, m2/s2. Without branches, as far as they are not nearly always alike: the sign of a is as good as random, and so is
/// which cell owns a face; half of the jumps would be guessed wrongly.
template <class Law>
class CellLimiter : public Limiter {
 public:
  void limit(const LimiterInputs& inputs, std::vector<Vec3>& psi) const final {
    const double per_volume = threshold(inputs.mesh, inputs.reference_speed);
    if (inputs.has_periods)
      limit_cells<true>(inputs, per_volume, psi);
    else
      limit_cells<false>(inputs, per_volume, psi);
    inputs.mesh.halo.exchange(psi);
  }

 protected:
  /// Square of the variation that a limiter leaves alone, over the volume of a cell, m2/s2 over m3. Collective.
  virtual double threshold(const Mesh&, double /*reference_speed*/) const { return 0; }

 private:
  template <bool has_periods>
  static void limit_cells(const LimiterInputs& inputs, double per_volume, std::vector<Vec3>& psi) {
    const Mesh& mesh = inputs.mesh;
    const std::span<const Mat3> G = inputs.G;
    const FourValues one{1, 1, 1, 1};
    for (int c = 0; c < mesh.n_cells; ++c) {
      const FourRange range = range_of_cell(mesh, c, inputs.u, inputs.ranges);
      const FourValues here = four(inputs.u[c]), above = range.highest - here, below = range.lowest - here;
      const FourValues along_x{G[c][0].x, G[c][1].x, G[c][2].x, 0}, along_y{G[c][0].y, G[c][1].y, G[c][2].y, 0},
          along_z{G[c][0].z, G[c][1].z, G[c][2].z, 0};
      const double e2 = per_volume * mesh.cell_volume[c];
      FourValues smallest = one;
      for (int k = mesh.cell_face_start[c]; k < mesh.cell_face_start[c + 1]; ++k) {
        const int f = mesh.cell_face[k];
        if (f >= mesh.n_interior) continue;
        const Vec3 way = way_to_face(mesh, has_periods, c, f);
        const FourValues a = way.x * along_x + way.y * along_y + way.z * along_z, b = a > 0 ? above : below;
        FourValues psi_f = a != 0 ? least(one, Law::factor(a, b, e2)) : one;
        if (f >= mesh.first_facet) psi_f = 1 - weight_in_cell(mesh, f, c) * (1 - psi_f);
        smallest = least(smallest, psi_f);
      }
      psi[c] = {smallest[0], smallest[1], smallest[2]};
    }
  }
};

}  // namespace snag
