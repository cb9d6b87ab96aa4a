#pragma once
// What the operators need of one face beside the arrays of the mesh, computed where it is used: less memory to read, and right on a moving
// mesh.
//
//   over-relaxed split of the face vector:   S = c d + T,   c = S.S / (S.d)         d: way between the centres
//   the line of centres meets the face at x_i = x_P + (1 - w) d; the face centre lies off it by s = x_f - x_i (skewness)
//
//   S.grad(phi)_f ~ c (phi_N - phi_P) + T.(w grad_P + (1-w) grad_N),      phi_f ~ w phi_P + (1-w) phi_N + s.(w grad_P + (1-w) grad_N)
//
// Both are exact for linear fields on any mesh.
#include "mesh/mesh.hpp"

namespace snag {

/// c, m.
inline double conductance(const Vec3& S, const Vec3& d) { return norm_squared(S) / dot(S, d); }

/// s, m.
inline Vec3 skewness(const Mesh& mesh, int f) {
  return mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]] - (1 - mesh.weight[f]) * mesh.delta[f];
}

/// Way from a boundary cell's centre to the face centre, without its part along the normal n: where a zero normal gradient leads to.
inline Vec3 along_face(const Vec3& d, const Vec3& n) { return d - dot(d, n) * n; }

inline Vec3 blend(double w, const Vec3& a, const Vec3& b) { return w * a + (1 - w) * b; }
inline Mat3 blend(double w, const Mat3& a, const Mat3& b) { return {blend(w, a[0], b[0]), blend(w, a[1], b[1]), blend(w, a[2], b[2])}; }
inline Vec3 transposed_product(const Mat3& m, const Vec3& v) { return v.x * m[0] + v.y * m[1] + v.z * m[2]; }

}  // namespace snag
