// Cell limiters: the largest psi in [0, 1] for which u_P + psi G (x_f - x_P) stays within [u_min, u_max] of the cell and its face
// neighbours.
//
//   a = change to the face, G (x_f - x_P);   b = u_max - u_P where a > 0, u_min - u_P where a < 0
//   Barth and Jespersen (1989):   psi = min(1, b/a)
//   Venkatakrishnan (1995):       psi = ((b^2 + e^2) + 2 a b) / (b^2 + 2 a^2 + a b + e^2),    e^2 = K^3 (V/V_total) U^2
//
// The minimum over faces, for each component of u by itself: one that hardly varies does not limit the others. e is Venkatakrishnan's
// threshold (K h)^3 made dimensionless with the volume of the domain and the speed U: a smooth extremum, where |b| ~ h^2 u'', is limited by
// O(h^2) only and the scheme stays second order.
#include "solver/operators/limiter.hpp"

#include <algorithm>

#include "parallel/sum.hpp"
#include "solver/fields/face.hpp"

namespace snag {

namespace {

constexpr double smooth_cells = 5;  // K: Venkatakrishnan's recommended size of the threshold

struct Range {
  Vec3 lowest, highest;
  void include(const Vec3& u) {
    lowest = {std::min(lowest.x, u.x), std::min(lowest.y, u.y), std::min(lowest.z, u.z)};
    highest = {std::max(highest.x, u.x), std::max(highest.y, u.y), std::max(highest.z, u.z)};
  }
};

inline double barth_jespersen(double a, double b, double) { return std::abs(a) <= std::abs(b) ? 1 : b / a; }
inline double venkatakrishnan(double a, double b, double e2) { return (b * b + e2 + 2 * a * b) / (b * b + 2 * a * a + a * b + e2); }

/// Factor of each component.
template <double (*law)(double, double, double)>
Vec3 factors(const Vec3& a, const Vec3& above, const Vec3& below, double e2) {
  Vec3 psi{1, 1, 1};
  for (int i = 0; i < 3; ++i) {
    const double b = a[i] > 0 ? above[i] : below[i];
    if (a[i] != 0) psi[i] = std::min(1.0, law(a[i], b, e2));
  }
  return psi;
}

inline Vec3 least(const Vec3& a, const Vec3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }

/// What a facet has to say in cell c: all from a quarter of the cell's face on, nothing when it is a sliver that comes or goes.
double say(const Mesh& mesh, int f, int c) { return std::min(1.0, 4 * share_of_face(mesh, f, mesh.owner[f] == c)); }

template <double (*law)(double, double, double)>
void limit(const Mesh& mesh, std::span<const Vec3> u, std::span<const Mat3> G, double threshold, std::vector<Vec3>& psi) {
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
      Vec3 psi_f = factors<law>(G[c] * way, above, below, threshold * mesh.cell_volume[c]);
      if (f >= mesh.first_facet) psi_f = Vec3{1, 1, 1} - say(mesh, f, c) * (Vec3{1, 1, 1} - psi_f);
      smallest = least(smallest, psi_f);
    }
    psi[c] = smallest;
  }
}

}  // namespace

void limit_gradient(const Mesh& mesh, Limiter limiter, std::span<const Vec3> u, std::span<const Mat3> G, double reference_speed,
                    std::vector<Vec3>& psi) {
  if (limiter == Limiter::none) return std::fill(psi.begin(), psi.end(), Vec3{1, 1, 1});
  if (limiter == Limiter::barth_jespersen) {
    limit<barth_jespersen>(mesh, u, G, 0, psi);
  } else {
    double volume = 0;
    for (int c = 0; c < mesh.n_cells; ++c) volume += mesh.cell_volume[c];
    const double threshold = smooth_cells * smooth_cells * smooth_cells * reference_speed * reference_speed / sum(mesh.comm, volume);
    limit<venkatakrishnan>(mesh, u, G, threshold, psi);
  }
  mesh.halo.exchange(psi);
}

}  // namespace snag
