#pragma once
// What the operators need of one face beside the arrays of the mesh, computed where it is used: less memory to read, and right on a moving
// mesh.
//
//   over-relaxed split of the face vector:   S = c d + T,   c = S.S / (S.d)         d: way between the centres
//   the line of centres meets the face at x_i = x_P + (1 - w) d; the face centre lies off it by s = x_f - x_i (skewness)
//
//   S.grad(phi)_f ~ c (phi_N - phi_P) + T.(w grad_P + (1-w) grad_N),      phi_f ~ w phi_P + (1-w) phi_N + s.(w grad_P + (1-w) grad_N)
//
// Both are exact for linear fields. Across a skew face (|s| > 0.6 |d|, mesh/skewness.hpp) velocity is not corrected for s and of first
// order. The reason: with L the compact Laplacian of the pressure, D divergence, I interpolation, G gradient, R = L^-1 D I G and
// Q = L^-1 D s.grad G, a correction of the pressure multiplies its error by R at large steps and by 1 - R - Q at small ones. On prisms
// round an axis in 28 sectors (|s|/|d| = 1.07) and on tetrahedra of pumps R reached 1.26, in single cells, and those ran away with any
// order of convection. Without the correction, and with the pressure of solver/operators/gradient.hpp, R is 1.2 to 1.4 on such prisms in
// 24 to 72 sectors; solver/continuity.hpp says what holds it.
//
// Where the velocity is corrected for s, the gradient is the mean of the neighbours of each cell (solver/fields/mean_gradient.hpp), not
// its own. A pressure correction multiplies what it cannot see in the velocities by 1 - R - Q, step after step. With the cells' own
// gradients R + Q has roots down to -0.2 on ordinary tetrahedra, |s|/|d| = 0.2 in half of the faces, and in small steps, where convection
// hardly smooths, velocities differed from cell to cell: convection in a pump took half of the shaft's power, which the pressure had put
// in. Without Q no root is negative, but the flux is of first order. With the neighbours' mean none is below -0.03, and on the mesh of the
// test (verification.solver.projections) none below zero.
//
// Convection may take
//
//   limited linear:   phi_f - phi_C = clamp(2 r, 0, 1) (1 - w_C) (phi_D - phi_C),   r = 2 (grad phi_C . d)/(phi_D - phi_C) - 1
//
// of second order where phi is smooth (r near 1), total variation diminishing in one dimension.
#include <algorithm>
#include <array>
#include <span>

#include "mesh/geometry.hpp"
#include "mesh/skewness.hpp"
#include "solver/fields/mean_gradient.hpp"

namespace snag {

/// c, m.
inline double conductance(const Vec3& S, const Vec3& d) { return norm_squared(S) / dot(S, d); }

/// Way from a boundary cell's centre to the face centre, without its part along the normal n: where a zero normal gradient leads to.
inline Vec3 along_face(const Vec3& d, const Vec3& n) { return d - dot(d, n) * n; }

/// a with each component times that of b.
inline Vec3 scaled(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 blend(double w, const Vec3& a, const Vec3& b) { return w * a + (1 - w) * b; }
inline Mat3 blend(double w, const Mat3& a, const Mat3& b) { return {blend(w, a[0], b[0]), blend(w, a[1], b[1]), blend(w, a[2], b[2])}; }
inline Vec3 transposed_product(const Mat3& m, const Vec3& v) { return v.x * m[0] + v.y * m[1] + v.z * m[2]; }

/// Of the face of the owner's or the neighbour's cell, how much an interior face is: a facet is a part of it, 1 otherwise.
inline double share_of_face(const Mesh& mesh, int f, bool of_owner) {
  return f < mesh.first_facet ? 1 : mesh.facet_share[static_cast<std::size_t>(f - mesh.first_facet)][of_owner ? 0 : 1];
}

/// act(neighbour, share) for the interior faces of an owned cell; returns the sum of their shares.
template <class Act>
[[gnu::always_inline]] inline double for_each_neighbour(const Mesh& mesh, int cell, const Act& act) {
  double sum = 0;
  for (const int f : row(mesh.cell_face_start, mesh.cell_face, cell)) {
    if (f >= mesh.n_interior) continue;
    const double share = share_of_face(mesh, f, mesh.owner[f] == cell);
    act(mesh.owner[f] + mesh.neighbour[f] - cell, share);
    sum += share;
  }
  return sum;
}

/// What gradients add to [u]_f.S of an interior face for its skewness, m3/s.
[[gnu::always_inline]] inline double skewness_flux(const Mesh& mesh, int f, const MeanGradient& gradient) {
  return is_skew(mesh, f, skewness(mesh, f)) ? 0 : gradient.flux(mesh, f, counted_skewness(mesh, f));
}

/// [u]_f.S of an interior face, m3/s, from the velocity on the line of centres, w u_P + (1-w) u_N, and gradients.
[[gnu::always_inline]] inline double interpolated_flux(const Mesh& mesh, int f, const Vec3& u_on_line, const MeanGradient& gradient) {
  return dot(u_on_line, mesh.face_vector[f]) + skewness_flux(mesh, f, gradient);
}

/// [u]_b.S of a boundary face, m3/s, from velocity and gradient of its cell, with no gradient along the normal.
inline double leaving_flux(const Mesh& mesh, int f, const Vec3& u, const Mat3& gradient) {
  const Vec3& S = mesh.face_vector[f];
  return dot(u + gradient * along_face(mesh.delta[f], unit(S)), S);
}

/// phi_f - phi_C by the limited linear scheme: `change` phi_D - phi_C, `slope` grad phi_C . d from C to D, `weight` 1 - w_C. Without jumps,
/// so that a compiler puts several faces side by side.
inline double limited_linear(double change, double slope, double weight) {
  const double r = 2 * slope / change - 1;
  return change == 0 ? 0 : std::min(std::max(2 * r, 0.0), 1.0) * weight * change;
}

/// The cell upwind of an interior face, and how much of d lies between the owner's centre and its own: 0 or 1. Found in a table, because
/// the sign of the flux F from the owner is as good as random, and half of the jumps would be guessed wrongly.
struct Upwind {
  int cell;
  double way;
};
inline Upwind upwind(const Mesh& mesh, int f, double F) {
  const std::array<int, 2> cells{mesh.neighbour[f], mesh.owner[f]};
  constexpr std::array<double, 2> ways{1, 0};
  const std::size_t forward = F > 0;
  return {cells[forward], ways[forward]};
}

}  // namespace snag
