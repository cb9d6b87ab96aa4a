#pragma once
// The pressure at faces where fluid enters from rest, with a given total pressure:
//
//   p = p_0 - h,   h = 1/2 rho u_n^2 where fluid enters, 0 where it leaves,   u_n = flux/|S|
//
// Fluid that entered at p_0 would bring its kinetic energy for nothing: eddies that leave through an outlet then feed on what they draw
// back. h comes from the fluxes of the steps before, as M, its mean over the patch, and q', what a face has beyond the mean.
//
// The mean at the end of the step n+1 is predicted from m(h) at the ends of the steps n and n-1. The predicted change is taken in part
// where the step is long for the water column behind the patch (solver/boundaries/water_column.hpp):
//
//   M^(n+1) = M^n + (m^n + (m^n - m^(n-1)) dt/dt_n - M^n)/(1 + c) >= 0,       c = dt u G/A,   u = sqrt(2 max(m^n, m^(n-1))/rho)
//
// M^1 = m^0. Second order in the step. Linear analysis against a column of length A/G: stable for any c; without the 1 + c, for
// u dt < 4/3 A/G. An EnteringHead without a column takes M^(n+1) = m^n: first order, stable for u dt < 4 A/G (2 A/G in a first step).
//
// Taken whole, h' = h - m(h) swings from cell to cell where fluid crosses more than a cell in a step, so that each step takes a share of
// its change:
//
//   q' <- q' + (h' - q')/(1 + C),   p = p_0 - M - q'       C = dt |u_n| / (d.n),   d: way from the cell's centre to the face
//
// The error is of the order of C dt and gone in a steady flow. Linear analysis of a face against its cell (inertance rho |d|): stable for
// any C. Measured on tetrahedra: steady to round-off at a Courant number of 5; at 12 the flow of single faces swings by a tenth and more
// after a hundred steps.
#include <optional>

#include "solver/fields/flow.hpp"

namespace snag {

class EnteringHead {
 public:
  EnteringHead() = default;
  /// With a column of this conductance G, m.
  explicit EnteringHead(double conductance) : conductance_(conductance) {}

  /// For the step from flow.time to `time` (s), when flow.flux_old is the flux at its begin and flow.flux that of one step before;
  /// `total_before`: p_0 of the step before, Pa. None before the first step, when no flux is known. Collective.
  void begin_step(const Flow& flow, const Patch& patch, double time, double total_before);
  /// M + q' at a face of the patch, Pa.
  double at(const Flow& flow, int face) const;

 private:
  double before(const Flow& flow, int face) const;
  std::optional<double> conductance_;
  double dt_ = 0, total_before_ = 0;
  double mean_ = 0, mean_before_ = 0, mean_of_last_ = 0;  // M; M of the step before; m(h) of the last flux, Pa
};

}  // namespace snag
