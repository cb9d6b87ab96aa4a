#pragma once
// Sparse matrix of a transport equation on the cells: one row an owned cell, one off-diagonal entry a face; and its solution.
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// Off-diagonal entries in compressed rows. The diagonal is kept by each equation: one number a cell, or three where components differ.
/// Rows have an even number of entries, so that those of tetrahedra inside and at walls are alike long, and those of cells at a sliding
/// interface end with room for facets that come and go: what is not in use is zero, on the diagonal.
class CellMatrix {
 public:
  explicit CellMatrix(const Mesh& mesh);
  /// Again after the facets of the mesh have changed; the values are lost. Local.
  void update(const Mesh& mesh);

  /// sum_j a_ij x_j. Value: double or Vec3.
  template <class Value>
  [[gnu::always_inline]] Value product(int i, const Value* x) const {
    Value even{}, odd{};
    for (int k = row_start[i], end = row_start[i + 1]; k < end; k += 2) {
      even += value[k] * x[column[k]];
      odd += value[k + 1] * x[column[k + 1]];
    }
    return even + odd;
  }

  std::vector<int> row_start, column;                   // [n_cells + 1], [n_entries]; columns are local cells, ghosts too
  std::vector<double> value;                            // [n_entries + 1]: the last takes what faces would add to rows of other ranks
  std::vector<int> place_of_owner, place_of_neighbour;  // [n_interior] entry (owner, neighbour) and (neighbour, owner)

 private:
  struct FacetRow {
    int row, first_facet;  // cell, and where the entries of its facets begin
  };
  void build(const Mesh& mesh);
  bool place_facets(const Mesh& mesh);
  std::vector<FacetRow> facet_rows_;
};

/// A row whose components depend on each other: what its 3 x 3 block has off the diagonal.
struct CoupledRow {
  int cell = 0;
  Vec3 off;  // yz, xz, xy
};

struct SweepReport {
  double initial = 0, final = 0;  // residuals over the norm of the right-hand side
  int sweeps = 0;
  bool converged = true;
};

/// Solve (diagonal + matrix) x = b, x [n_all_cells] holding the first guess: Gauss-Seidel, forward and backward in turn, ghosts exchanged
/// before each sweep, residual tested in each sweep; where sweeps stall, as they do in thin layers at large steps, BiCGStab between
/// sweeps. The residual is that of each row when it is visited. `tolerance` is relative to |b|. `positive`: the solution is, and no value
/// becomes zero or negative. `coupled`: by rising cell; only of Vec3. `sweeps` of the report counts an iteration of BiCGStab as six. Value:
/// double or Vec3. Collective.
template <class Value>
SweepReport solve_rows(const Mesh& mesh, const CellMatrix& matrix, std::span<const Value> diagonal, std::span<const Value> b,
                       std::vector<Value>& x, double tolerance, int max_sweeps, bool positive = false,
                       std::span<const CoupledRow> coupled = {});

}  // namespace snag
