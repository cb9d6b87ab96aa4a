#pragma once
// Plan view of a pump with n equal vanes: what is known of it before any solid is made.
//
//   vane centre line   r = r1 exp(c s),  at the angle -s,  0 <= s <= wrap,  c = ln((r2 - t2/2)/r1)/wrap: constant angle beta = atan c
//   vane k = 0 .. n-1  the same, turned by 2 pi k/n; as a union of discs of diameter t(s) about its centre line x(s)
//   passage            min over s, s' of |x(s) - R x(s')| - t(s)/2 - t(s')/2,   R: turn by 2 pi/n to the vane ahead
//                      (one vane faces itself one turn later: only places half a turn apart, |s - s'| > pi, count)
//   if not given       wrap = 300 deg / n^0.6,  t1 = 5 mm / n^(1/3),  t2 = 8 mm / n^(1/3): passages and blockage stay usual
//   slope of the spiral casing  tan alpha = f Q / (2 pi b3 K),   K = g H / (eta omega): constant moment of velocity, f = volute_factor
//   spiral wall        r = r_P exp((theta - theta_P) tan alpha), theta_P <= theta <= 2 pi + alpha: its end runs along +y
//   tongue             nose circle of radius rho about C, at the radius r_t + rho and the tongue's angle; tangent to the spiral in P:
//                      theta_P = theta_C + asin(rho sin(alpha)/|C|),  r_P = |C| cos(theta_C - theta_P) - rho cos(alpha)
//
//   r1, r2 radii of the vanes' leading edge and of the impeller, t1, t2 thickness there, b2, b3 widths of impeller and casing,
//   Q, H, omega, eta design flow, head, speed and hydraulic efficiency, r_t radius of the tongue.
// The impeller turns counter-clockwise (+z); the origin is on the axis at the hub. Source: usual one-dimensional design, e.g.
// Gülich, Centrifugal Pumps, chapters 3 and 7.
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/parameter.hpp"
#include "base/vec3.hpp"

namespace snag::generate {

/// Dimensions of the hydraulics in SI units; angles in radians.
struct PumpDimensions {
  // impeller
  int vanes = 1;
  double impeller_diameter = 0.200, impeller_width = 0.080;
  double leading_edge_radius = 0.037;
  std::optional<double> wrap_angle, leading_edge_thickness, trailing_edge_thickness;
  double rotor_angle = 0.12217304763960307;
  // casing
  double side_gap = 0.010, tongue_gap = 0.10, tongue_angle = 0.4537856055185257, tongue_radius = 0.004;
  double sliding_fraction = 0.45;
  double design_flow = 0.0268, design_head = 3.3, design_speed = 125.66370614359172, hydraulic_efficiency = 0.72;
  double volute_factor = 0.85;
  // inlet and outlet
  double inlet_diameter = 0.100, eye_length = 0.006;
  std::optional<double> inlet_length;
  double outlet_straight_length = 0.060, outlet_loft_length = 0.110, outlet_diameter = 0.080;
  std::optional<double> outlet_length;

  std::vector<Parameter> parameters();

  double pitch() const { return 2 * std::numbers::pi / vanes; }  // angle from a vane to the next
  double wrap() const { return wrap_angle.value_or(5.235987755982989 / std::pow(vanes, 0.6)); }
  double leading_thickness() const { return leading_edge_thickness.value_or(0.005 / std::cbrt(vanes)); }
  double trailing_thickness() const { return trailing_edge_thickness.value_or(0.008 / std::cbrt(vanes)); }
  double impeller_radius() const { return impeller_diameter / 2; }
  double tongue_tip_radius() const { return impeller_radius() * (1 + tongue_gap); }
  double sliding_radius() const { return impeller_radius() + sliding_fraction * (tongue_tip_radius() - impeller_radius()); }
  double eye_height() const { return impeller_width + eye_length; }  // z of the plane between eye and inlet pipe
  double casing_width() const { return impeller_width + 2 * side_gap; }
};

/// The outline of the first vane: two sides from the leading edge to the trailing edge and the round noses' centres and tips; z = 0.
struct VanePlan {
  std::vector<Vec3> front, back;  // m; front: side that pushes, in the sense of rotation
  Vec3 leading_centre, leading_tip, trailing_centre, trailing_tip;
  double area = 0;  // m2, exact for the offset curves
};
VanePlan vane_plan(const PumpDimensions& pump);
/// Width of the passage between two vanes where it is narrowest in plan view, m; negative where vanes overlap, infinite for one vane
/// of less than half a turn.
double narrowest_passage(const PumpDimensions& pump);

/// The casing's outline in its middle plane.
struct VolutePlan {
  double slope_angle = 0;                    // alpha, rad
  std::vector<Vec3> spiral;                  // m, from P to the outer outlet wall
  Vec3 nose_centre, nose_bottom, nose_side;  // arc P -> bottom -> side; the inner outlet wall starts at the side and runs along +y
  double throat = 0;                         // m, between the outlet's walls
  double outlet_start = 0;                   // y of the end of the straight, rectangular part, m
};
/// Throws Error(usage) where the parameters leave no room for vane, tongue or throat.
VolutePlan volute_plan(const PumpDimensions& pump);

}  // namespace snag::generate
