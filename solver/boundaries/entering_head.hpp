#pragma once
// The pressure at faces where fluid enters from rest, with a given total pressure:
//
//   p = p_0 - h,   h = 1/2 rho u_n^2 where fluid enters, 0 where it leaves,   u_n = flux/|S|
//
// Fluid that entered at p_0 would bring its kinetic energy for nothing: eddies that leave through an outlet then feed on what they draw
// back. h comes from the flux of the step before. Taken whole it swings from cell to cell where fluid crosses more than a cell in a step.
// So its mean over the patch, m(h), is taken whole, and of what a face has beyond the mean, h' = h - m(h), each step takes a share of the
// change:
//
//   q' <- q' + (h' - q')/(1 + C),   p = p_0 - m(h) - q'       C = dt |u_n| / (d.n),   d: way from the cell's centre to the face
//
// The error is of the order of C dt and gone in a steady flow. Linear analysis of a face against its cell (inertance rho |d|): stable for
// any C; of the mean against the column of length L: stable for |u_n| dt < 4 L in steps of second order (2 L in a first step). Measured on
// tetrahedra: steady to round-off at a Courant number of 5; at 12 the flow of single faces swings by a tenth and more after a hundred
// steps.
#include "solver/fields/flow.hpp"

namespace snag {

class EnteringHead {
 public:
  /// For the step from flow.time to `time` (s), when flow.flux_old is the flux at its begin; `total_before`: p_0 of the step before, Pa.
  /// None before the first step, when no flux is known. Collective.
  void begin_step(const Flow& flow, const Patch& patch, double time, double total_before);
  /// m(h) + q' at a face of the patch, Pa.
  double at(const Flow& flow, int face) const;

 private:
  double before(const Flow& flow, int face) const;
  double dt_ = 0, total_before_ = 0, mean_ = 0, mean_before_ = 0;  // m(h), m(q)
};

}  // namespace snag
