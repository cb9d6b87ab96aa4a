#pragma once
// Cell limiters: a psi in [0, 1] for which u_P + psi G (x_f - x_P) stays within [u_min, u_max] of the cell and its face neighbours.
//
//   a = change to the face, G (x_f - x_P);   b = u_max - u_P where a > 0, u_min - u_P where a < 0;   psi: a function of a and b
//
// The minimum over faces, for each component of u by itself: one that hardly varies does not limit the others.
#include <algorithm>

#include "solver/convection/limiter.hpp"
#include "solver/fields/face.hpp"

namespace snag {

/// The loop over the faces of the cells, compiled for one function. `Law` has
///   static double factor(double a, double b, double e2)
/// psi of one face and component, a not 0; what lies above 1 counts as 1. e2: threshold() times the volume of the cell, m2/s2.
template <class Law>
class CellLimiter : public Limiter {
 public:
  void limit(const Mesh& mesh, std::span<const Vec3> u, std::span<const Mat3> G, double reference_speed,
             std::vector<Vec3>& psi) const final {
    const double per_volume = threshold(mesh, reference_speed);
    for (int c = 0; c < mesh.n_cells; ++c) {
      Range range{u[c], u[c]};
      const int first = mesh.cell_face_start[c], last = mesh.cell_face_start[c + 1];
      for (int k = first; k < last; ++k) {
        const int f = mesh.cell_face[k];
        if (f >= mesh.n_interior) continue;
        const Vec3& other = u[mesh.owner[f] == c ? mesh.neighbour[f] : mesh.owner[f]];
        range.include(f < mesh.first_facet ? other : u[c] + say(mesh, f, c) * (other - u[c]));
      }
      const Vec3 above = range.highest - u[c], below = range.lowest - u[c];
      Vec3 smallest{1, 1, 1};
      for (int k = first; k < last; ++k) {
        const int f = mesh.cell_face[k];
        if (f >= mesh.n_interior) continue;
        Vec3 way = mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]];
        if (mesh.owner[f] != c) way -= mesh.delta[f];
        Vec3 psi_f = factors(G[c] * way, above, below, per_volume * mesh.cell_volume[c]);
        if (f >= mesh.first_facet) psi_f = Vec3{1, 1, 1} - say(mesh, f, c) * (Vec3{1, 1, 1} - psi_f);
        smallest = least(smallest, psi_f);
      }
      psi[c] = smallest;
    }
    mesh.halo.exchange(psi);
  }

 protected:
  /// Square of the variation that a limiter leaves alone, over the volume of a cell, m2/s2 over m3. Collective.
  virtual double threshold(const Mesh&, double /*reference_speed*/) const { return 0; }

 private:
  struct Range {
    Vec3 lowest, highest;
    void include(const Vec3& u) {
      lowest = least(lowest, u);
      highest = {std::max(highest.x, u.x), std::max(highest.y, u.y), std::max(highest.z, u.z)};
    }
  };

  static Vec3 least(const Vec3& a, const Vec3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }

  /// Factor of each component.
  static Vec3 factors(const Vec3& a, const Vec3& above, const Vec3& below, double e2) {
    Vec3 psi{1, 1, 1};
    for (int i = 0; i < 3; ++i) {
      const double b = a[i] > 0 ? above[i] : below[i];
      if (a[i] != 0) psi[i] = std::min(1.0, Law::factor(a[i], b, e2));
    }
    return psi;
  }

  /// Weight of a facet in cell c: 1 from a quarter of the cell's face on, 0 when it is a sliver that comes or goes.
  static double say(const Mesh& mesh, int f, int c) { return std::min(1.0, 4 * share_of_face(mesh, f, mesh.owner[f] == c)); }
};

}  // namespace snag
