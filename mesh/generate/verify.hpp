#pragma once
// Checks a finished mesh from its cells alone, and the table that a user reads.
//
// Watertight means: every face that belongs to one cell only lies in exactly one named surface and every named face belongs to one
// cell; no face has more than two cells; every edge of a volume's boundary has two boundary faces; the area vectors of every volume's
// boundary sum to zero; no node is outside the cells; different volumes share no node.
#include <map>
#include <string>
#include <vector>

#include "mesh/generate/geometry.hpp"

namespace snag::generate {

struct MeshReport {
  struct Volume {
    std::string name;
    std::map<std::string, std::int64_t> cells;  // by shape
    int n_components = 0;
    double volume = 0, exact_volume = 0;  // m3
    double closure = 0;                   // |sum of area vectors| / sum of areas
  };
  struct Surface {
    std::string name;
    std::int64_t n_faces = 0;
    double area = 0;  // m2
  };
  std::vector<Volume> volumes;
  std::vector<Surface> surfaces;
  std::int64_t n_cells = 0, n_nodes = 0;
  double min_quality = 0, mean_quality = 0;  // tetrahedra: signed inverse condition number; others: scaled Jacobian, worst corner
  double quality_limit = 0;                  // the least quality that a cell may have
  std::int64_t n_poor = 0;                   // cells below it
  std::vector<std::string> failures;         // one sentence each; empty: the mesh may be used
};

/// Examine the mesh of the current gmsh model.
MeshReport verified(const Expectation& expectation);
std::string table(const MeshReport& report);

}  // namespace snag::generate
