#pragma once
// How good a mesh is, in the words of checkMesh; `snag mesh --info` prints it and ends with code 3 on a bad one.
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct MeshQuality {
  std::int64_t n_cells = 0, n_interior = 0, n_boundary = 0;
  std::int64_t n_regions = 0;             // that share no face; rotor and stator are two: reported, not judged
  double volume = 0;                      // m3
  double min_volume = 0, max_volume = 0;  // m3
  double max_non_orthogonality_deg = 0, mean_non_orthogonality_deg = 0;
  double max_skewness = 0;                   // way from where the line of centres meets the face to the face centre, over that line
  std::int64_t n_skew_cells = 0;             // with a skew face (mesh/skewness.hpp)
  double skew_volume = 0;                    // m3, of these cells
  std::int64_t n_corner_cells = 0;           // with few neighbours (mesh/skewness.hpp)
  double corner_volume = 0;                  // m3, of these cells
  std::int64_t n_meeting_pyramids = 0;       // that share two triangles or more with other pyramids, as where their tips meet
  double closure = 0;                        // max over cells of |sum S| / sum |S|
  double min_quality = 0, mean_quality = 0;  // tetrahedra: 3 r_in / R_circ; others: min over corners of the scaled Jacobian
  double min_spacing = 0;                    // m, smallest distance between two cell centres across a face
  std::vector<std::string> failures;         // one sentence each: what, where, rule, remedy; empty for a usable mesh
};

/// Of one cell: its shape, and the worst of its interior faces.
struct CellQuality {
  double quality = 1, non_orthogonality_deg = 0, skewness = 0;
};
/// An owned cell. Local.
CellQuality quality_of_cell(const Mesh& mesh, int cell);

/// Collective; the same result on every rank.
MeshQuality quality(const Mesh& mesh);
/// The table a user reads, with patches and zones. Collective.
std::string quality_table(const Mesh& mesh, const MeshQuality& q);

}  // namespace snag
