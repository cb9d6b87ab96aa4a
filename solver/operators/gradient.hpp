#pragma once
// Gradients of cell fields: least squares over the faces (exact for linear fields), and the Gauss form that conserves momentum.
//
//   least squares:   minimise sum_f (g.e_f - D_f)^2,   e_f = d/|d|,   D_f = (phi_N - phi_P)/|d|
//                    g = M^-1 sum_f D_f e_f,   M = sum_f e_f e_f
//                    a facet counts with its share of the face that it is a part of: a sliver that comes or goes changes nothing
//   Gauss:           V g = sum_f phi_f S,   phi_f with skewness correction by least squares: sums of V g telescope to the boundary
//   across a skew face and at a wall that the cell lies aslant over (mesh/skewness.hpp), phi_f is instead what brings V g.S, with the sums
//   over the other faces, to that of the least-squares gradients g':
//                    interior: phi_f += 1/2 ((V g' - V g)_P - (V g' - V g)_N).S/|S|^2,   boundary: phi_f += a (V g' - V g)_P.S/|S|^2
//                    a is 1 over the sum of |n.n_k| over all such faces k of the cell, this one among them: 1 if it has no other
//                    phi_f stays one value a face, so that the sums telescope, and the gradient is exact for linear fields
//
// A cell with few neighbours (a tetrahedron with two faces on walls where the value is unknown) leaves directions open: eigenvalues of M
// near zero. In these directions it takes the mean gradient of its neighbours, so that linear fields stay exact. First order on any mesh,
// second on regular ones.
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// What is known at the faces of a patch.
enum class Side {
  value,   // phi at the face centre
  slope,   // of a scalar: d phi/dn is given; of a vector: it is zero
  mirror,  // of a vector u: u.n is that of the given value and the tangential part has d/dn = 0; not for scalars
  none     // nothing: the face does not enter
};

/// xx, xy, ... of a symmetric tensor.
struct SymmetricTensor {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

/// What least squares on a mesh have in common whatever is known at its boundary: M of the interior faces.
class CellMoments {
 public:
  explicit CellMoments(const Mesh& mesh);
  /// Again after the mesh has turned. Local.
  void update();

  struct OpenCell {
    int cell;
    Mat3 open;  // projection onto the directions that the faces leave open
  };
  /// M^-1, or its pseudo-inverse if a direction is open, which then is appended to `open`.
  static SymmetricTensor inverse(const SymmetricTensor& M, int cell, std::vector<OpenCell>& open);

  /// M^-1 of cells inside, the unit tensor of those with a boundary face; [n_cells].
  const std::vector<SymmetricTensor>& inverse() const { return inverse_; }
  const std::vector<OpenCell>& open() const { return open_; }
  /// Owned cells with a boundary face, ascending; M of the interior faces of each; and the place in this list of the cell of each boundary
  /// face, [n_faces - n_interior].
  const std::vector<int>& boundary_cells() const { return boundary_cells_; }
  const std::vector<SymmetricTensor>& boundary_moments() const { return boundary_moments_; }
  const std::vector<int>& place_of_boundary_face() const { return place_of_boundary_face_; }

 private:
  /// `place` in boundary_cells_, -1 for a cell inside.
  void set(int cell, int place);

  const Mesh& mesh_;
  std::vector<int> turning_;  // owned cells whose M changes with the angle, ascending
  std::vector<int> boundary_cells_, place_of_boundary_face_;
  std::vector<SymmetricTensor> inverse_, boundary_moments_;
  std::vector<OpenCell> open_;
};

class LeastSquares {
 public:
  /// `sides`: one for each patch. The moments stay with the caller. Collective.
  LeastSquares(const Mesh& mesh, const CellMoments& moments, std::vector<Side> sides);
  /// Again after the mesh has moved, and the moments. Collective.
  void update();

  /// Gradient of a scalar that is given by its changes, [n_faces]: from owner to neighbour, from the cell to the face where the boundary
  /// knows the value, and its normal slope where that is known. Collective.
  void gradient_of_changes(std::span<const double> change, std::vector<Vec3>& g) const;
  /// Gradient of a scalar; `phi` [n_all_cells], `boundary` values at boundary faces (read where known), `g` [n_all_cells], ghosts filled.
  /// Collective.
  void gradient(std::span<const double> phi, std::span<const double> boundary, std::vector<Vec3>& g) const;
  /// Gradient G_ij = du_i/dx_j of a vector; the same.
  void gradient(std::span<const Vec3> u, std::span<const Vec3> boundary, std::vector<Mat3>& g) const;
  Side side(std::size_t patch) const { return sides_[patch]; }
  /// Skew faces (mesh/skewness.hpp), ascending, and whether any rank has some.
  const std::vector<int>& skew_faces() const { return skew_faces_; }
  bool skew_anywhere() const { return skew_anywhere_; }
  /// A boundary face without a given value over which its cell lies aslant; `share`: the factor a above.
  struct AslantFace {
    int face;
    double share;
  };
  /// By ascending cell.
  const std::vector<AslantFace>& aslant_faces() const { return aslant_faces_; }

 private:
  template <class Act>
  void for_each_difference(const Act& act) const;
  template <class Value, class Gradient>
  void add_interior(std::span<const Value> phi, std::vector<Gradient>& g) const;
  template <class Value, class Gradient, class OfCell>
  void finish(const OfCell& phi, std::span<const Value> boundary, std::vector<Gradient>& g) const;
  template <class Gradient>
  void fill_open(std::vector<Gradient>& g) const;
  void share_among_aslant_faces();

  const Mesh& mesh_;
  std::vector<Side> sides_;
  const CellMoments& moments_;
  std::vector<SymmetricTensor> boundary_inverse_;  // M^-1 of the boundary cells, pseudo-inverse for open cells
  std::vector<CellMoments::OpenCell> open_;
  std::vector<int> skew_faces_;
  std::vector<AslantFace> aslant_faces_;
  bool open_anywhere_ = false, skew_anywhere_ = false;
};

/// Values of a scalar at the boundary faces from what is given there (value or slope, by side) and its gradient.
void fill_boundary(const Mesh& mesh, const LeastSquares& squares, std::span<const double> phi, std::span<const Vec3> g,
                   std::span<const double> given, std::span<double> values);

/// Gauss gradient from least-squares gradients `slope` and boundary values, which change at aslant faces; `slope`, `g` [n_all_cells],
/// ghosts filled. `facets`, where it is given: the values at the facets, [n_interior - first_facet]. Collective.
void gauss_gradient(const Mesh& mesh, const LeastSquares& squares, std::span<const double> phi, std::span<double> boundary,
                    std::span<const Vec3> slope, std::vector<Vec3>& g, std::span<double> facets = {});

/// The same of a scalar that is given by its changes (LeastSquares::gradient_of_changes()), which need not be those of one scalar: each
/// cell counts from its own value; `boundary`, [n_faces - n_interior], is to work in. Collective.
void gauss_gradient_of_changes(const Mesh& mesh, const LeastSquares& squares, std::span<const double> change, std::span<double> boundary,
                               std::span<const Vec3> slope, std::vector<Vec3>& g);

/// Owned cells with a skew face, or aslant over a boundary face: cells whose Gauss gradient contains values from least squares. Ascending.
/// Local.
std::vector<int> closed_cells(const Mesh& mesh, const LeastSquares& squares);

/// Mean of g over the neighbours of an owned cell, a facet counts with its share; g of the cell itself where it has none. `g`
/// [n_all_cells], ghosts filled. Exact for linear fields. Local.
Vec3 mean_of_neighbours(const Mesh& mesh, int cell, const std::vector<Vec3>& g);

/// Mean of G over an owned cell and its neighbours, a facet counts with its share; `G` [n_all_cells], ghosts filled. Local. In tetrahedra
/// an error of the velocity that alternates from cell to cell changes this mean less than G.
Mat3 mean_with_neighbours(const Mesh& mesh, int cell, const std::vector<Mat3>& G);

}  // namespace snag
