#pragma once
// Production of turbulence where streamlines curve or the flow turns: factor f on P of k and on alpha S^2 of omega. Smirnov and Menter
// (2009), J. Turbomach. 131, 041010, after Spalart and Shur (1997), Aerosp. Sci. Technol. 1, 297-302:
//
//   f = max(0, min(1.25, (1 + c_r1) 2 r*/(1 + r*) (1 - c_r3 atan(c_r2 r~)) - c_r1)),   r* = S/W
//   r~ = 2 W_ik S_jk (DS_ij/Dt) / (W D^3),   S^2 = 2 S_ij S_ij,   W^2 = 2 W_ij W_ij,   D^2 = max(S^2, 0.09 omega^2)
//   S_ij = (du_i/dx_j + du_j/dx_i)/2,   W_ij = (du_i/dx_j - du_j/dx_i)/2,   c_r1 = 1, c_r2 = 2, c_r3 = 1
//
// All in the frame at rest, where the rate of rotation of the frame, which the paper has in W and in the bracket, is zero:
//
//   DS/Dt = (S - S^n)/dt of the cell + (u - u_cell) . grad S,   u_cell: of a cell in a zone that slides
//   zone that stands in the turning frame:   DS/Dt = (S - S^n)/dt + (u - Omega x r) . grad S + T S - S T,   T v = Omega x v
//
// f is 1 in a plane shear flow, below where the angular momentum grows outwards (convex wall), above where it falls (concave wall). First
// order in dt, second in the cells on regular meshes; the second derivatives of the velocity are noisy where cells differ much in size.
#include <optional>
#include <vector>

#include "solver/fields/flow.hpp"
#include "solver/operators/gradient.hpp"

namespace snag {

class Curvature {
 public:
  double c_r1 = 1, c_r2 = 2, c_r3 = 1;

  /// Collective, as are all functions below.
  void prepare(const Mesh& mesh, const CellMoments& moments);
  void mesh_turned() { slope_->update(); }
  /// At the begin of a step, with the velocity gradient of its start.
  void begin_step(const Flow& flow);
  /// f of the owned cells, for omega (1/s, [n_cells] at least) at the end of the step of length dt.
  void find(const Flow& flow, double dt, std::span<const double> omega, std::vector<double>& factor);

 private:
  /// S of all cells: xx, yy, zz and yz, xz, xy.
  struct Strain {
    std::vector<Vec3> diagonal, off;
    void find(const std::vector<Mat3>& gradient);
  };

  std::optional<LeastSquares> slope_;
  std::vector<Vec3> nothing_;  // no values at the boundary
  Strain before_, now_;
  std::vector<Mat3> slope_of_diagonal_, slope_of_off_;
};

}  // namespace snag
