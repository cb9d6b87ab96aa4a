#pragma once
// How far a face lies off the line between the centres of its cells: the line meets the plane of the face at
//
//   x_i = x_P + (1 - w) d,      s = x_f - x_i      (a vector in the face)
//
// Along curved layers s = kappa d^2/4, with the curvature kappa of the layer, may be many times the thickness of its cells: the line misses
// the face, and meets others, or a wall. There a field is the same along the layer, and its value at x_i, w phi_P + (1-w) phi_N, that at
// x_f, but for the curvature of the field itself; s times the gradient across the layer has nothing to do with it. So of s counts the share
//
//   clamp(2 - |s|/e, 0, 1)      e: from x_f to the farthest node of the face along s
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// |s|/|d| above which an interior face is skew: the schemes do not correct for s there (solver/fields/face.hpp).
constexpr double skew_from = 0.6;

/// s of an interior face, m.
inline Vec3 skewness(const Mesh& mesh, int f) {
  return mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]] - (1 - mesh.weight[f]) * mesh.delta[f];
}

/// The part of it for which a velocity on the line of centres is corrected: s times its share.
inline Vec3 counted_skewness(const Mesh& mesh, int f) { return (f < mesh.first_facet ? mesh.skew_share[f] : 1) * skewness(mesh, f); }

/// A facet of a sliding interface is a part of two whole faces: its skewness is not that of its cells, and weighs less.
inline bool is_skew(const Mesh& mesh, int f, const Vec3& s) {
  return f < mesh.first_facet && norm_squared(s) > skew_from * skew_from * norm_squared(mesh.delta[f]);
}

/// A cell lies more than 50 degrees aslant over a boundary face: the way between their centres, along the face, over the part across it.
inline bool is_aslant(const Mesh& mesh, int f) {
  const Vec3 &d = mesh.delta[f], n = unit(mesh.face_vector[f]);
  const double across = dot(d, n);
  return norm_squared(d - across * n) > 1.42 * across * across;
}

/// The share of s of an interior face that counts, from its nodes.
double skew_share(const Mesh& mesh, int f);

/// Skew faces of this rank, ascending, and its owned cells with one of them, ascending. Local.
std::vector<int> skew_faces(const Mesh& mesh);
std::vector<int> skew_cells(const Mesh& mesh);
/// Owned corner cells, ascending: two or more faces on the boundary and at most two to other cells (all facets of a sliding interface count
/// as one), for example tetrahedra at the edge of a vane. Their gradient depends mainly on boundary values. Local.
std::vector<int> corner_cells(const Mesh& mesh);

}  // namespace snag
