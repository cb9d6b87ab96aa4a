#include "mesh/generate/pump_plan.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.hpp"

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double gravity = 9.81;  // m/s2
constexpr int vane_points = 25;
constexpr int passage_points = 401;  // along a vane, to find the narrowest passage: a point each 0.2 % of its length
constexpr int spiral_points = 61;

Vec3 polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle), 0}; }

void require(bool rule, const std::string& message) {
  if (!rule) throw Error(ExitCode::usage, "[pump]: " + message);
}

double trailing_edge_radius(const PumpDimensions& pump) { return pump.impeller_radius() - pump.trailing_thickness() / 2; }

/// The vane about the place s of its centre line; the vane is turned by `turn` about the axis.
struct VaneDisc {
  Vec3 centre;
  double radius;  // half the vane's thickness, m
};

VaneDisc vane_disc(const PumpDimensions& pump, double s, double turn = 0) {
  const double r1 = pump.leading_edge_radius, r2 = trailing_edge_radius(pump);
  const double t1 = pump.leading_thickness(), t2 = pump.trailing_thickness();
  const double r = r1 * std::exp(std::log(r2 / r1) / pump.wrap() * s);
  // The length of a logarithmic spiral is proportional to r - r1: thickness linear along the vane is linear in r.
  return {polar(r, turn - s), 0.5 * (t1 + (t2 - t1) * (r - r1) / (r2 - r1))};
}

}  // namespace

std::vector<Parameter> PumpDimensions::parameters() {
  using enum Basis;
  return {
      {"vanes", &vanes, "1", 1, 7, assumed, "Number of vanes, equal and evenly spaced."},
      {"impeller_diameter", &impeller_diameter, "m", 0.02, 2, assumed, "Outer diameter d2 of the impeller."},
      {"impeller_width", &impeller_width, "m", 0.005, 1, measured, "Width b2 between hub and shroud; the free passage of the pump."},
      {"leading_edge_radius", &leading_edge_radius, "m", 0.002, 1, assumed, "Radius of the centres of the leading edges."},
      {"wrap_angle", &wrap_angle, "rad", 0.5, 8, assumed, "Angle that a vane spans about the axis; 300 deg / vanes^0.6 if absent."},
      {"leading_edge_thickness", &leading_edge_thickness, "m", 5e-4, 0.1, assumed,
       "Thickness of a vane at its leading edge; 5 mm / vanes^(1/3) if absent."},
      {"trailing_edge_thickness", &trailing_edge_thickness, "m", 5e-4, 0.1, assumed,
       "Thickness at the trailing edge, linear between; 8 mm / vanes^(1/3) if absent."},
      {"rotor_angle", &rotor_angle, "rad", -7, 7, assumed,
       "Angle at which the rotor is meshed; not 0, so that the two sides never match by chance."},
      {"side_gap", &side_gap, "m", 0, 0.2, assumed, "Axial gap between impeller and casing on each side."},
      {"tongue_gap", &tongue_gap, "1", 0.02, 0.5, assumed, "Gap between impeller and tongue over the impeller's radius."},
      {"tongue_angle", &tongue_angle, "rad", 0.1, 1.2, assumed, "Position of the tongue about the axis, from +x."},
      {"tongue_radius", &tongue_radius, "m", 5e-4, 0.1, assumed, "Nose radius of the tongue."},
      {"sliding_fraction", &sliding_fraction, "1", 0.15, 0.9, assumed,
       "Position of the sliding interface within the tongue gap, from the impeller."},
      {"design_flow", &design_flow, "m3/s", 1e-5, 10, measured, "Flow that the spiral casing is laid out for."},
      {"design_head", &design_head, "m", 0.1, 200, measured, "Head at the design flow."},
      {"design_speed", &design_speed, "rad/s", 1, 1000, measured, "Speed of rotation at the design flow."},
      {"hydraulic_efficiency", &hydraulic_efficiency, "1", 0.3, 1, assumed, "Hydraulic efficiency at the design flow."},
      {"volute_factor", &volute_factor, "1", 0.3, 2, assumed, "Opening of the spiral over that of constant moment of velocity."},
      {"inlet_diameter", &inlet_diameter, "m", 0.01, 2, measured, "Diameter of inlet pipe and eye."},
      {"eye_length", &eye_length, "m", 5e-4, 0.2, assumed, "Length of the eye that turns with the impeller."},
      {"inlet_length", &inlet_length, "m", 1e-3, 20, measured,
       "Length of the inlet pipe; 3 diameters, or 0.3 diameters from a tank, if absent."},
      {"outlet_straight_length", &outlet_straight_length, "m", 1e-3, 5, assumed,
       "Length of the rectangular channel that starts at the tongue."},
      {"outlet_loft_length", &outlet_loft_length, "m", 1e-3, 5, assumed, "Transition from the rectangle to the outlet pipe."},
      {"outlet_diameter", &outlet_diameter, "m", 0.01, 2, measured, "Diameter of the outlet pipe."},
      {"outlet_length", &outlet_length, "m", 1e-3, 40, measured, "Length of the outlet pipe; 8 diameters if absent."},
  };
}

VanePlan vane_plan(const PumpDimensions& pump) {
  const double r1 = pump.leading_edge_radius, r2 = trailing_edge_radius(pump), wrap = pump.wrap();
  const double t1 = pump.leading_thickness(), t2 = pump.trailing_thickness();
  require(r1 < r2,
          fmt::format("leading_edge_radius ({:g} m), must be below the radius of the trailing edge ({:g} m); take a smaller one", r1, r2));
  const double c = std::log(r2 / r1) / wrap, beta = std::atan(c);
  VanePlan plan;
  for (int k = 0; k < vane_points; ++k) {
    const double s = wrap * k / (vane_points - 1);
    const auto [centre, half] = vane_disc(pump, s);
    const Vec3 along = polar(std::sin(beta), -s) + polar(std::cos(beta), -s - pi / 2);
    const Vec3 normal{-along.y, along.x, 0};  // to the left of the way outwards: towards larger radii and with the rotation
    plan.front.push_back(centre + half * normal);
    plan.back.push_back(centre - half * normal);
    if (k == 0) plan.leading_centre = centre, plan.leading_tip = centre - half * along;
    if (k == vane_points - 1) plan.trailing_centre = centre, plan.trailing_tip = centre + half * along;
  }
  plan.area = (r2 - r1) / std::sin(beta) * (t1 + t2) / 2 + pi / 8 * (t1 * t1 + t2 * t2);
  return plan;
}

double narrowest_passage(const PumpDimensions& pump) {
  std::vector<std::pair<double, VaneDisc>> vane, ahead;
  const double step = pump.wrap() / (passage_points - 1);
  for (int k = 0; k < passage_points; ++k) {
    vane.emplace_back(k * step, vane_disc(pump, k * step));
    ahead.emplace_back(k * step, vane_disc(pump, k * step, pump.pitch()));
  }
  double narrowest = infinity;
  for (const auto& [s, disc] : vane)
    for (const auto& [s_ahead, other] : ahead)
      if (pump.vanes > 1 || std::abs(s - s_ahead) > pi)
        narrowest = std::min(narrowest, norm(disc.centre - other.centre) - disc.radius - other.radius);
  return narrowest;
}

VolutePlan volute_plan(const PumpDimensions& pump) {
  const double K = gravity * pump.design_head / (pump.hydraulic_efficiency * pump.design_speed);
  const double slope = pump.volute_factor * pump.design_flow / (2 * pi * pump.casing_width() * K), alpha = std::atan(slope);
  const double rho = pump.tongue_radius, C = pump.tongue_tip_radius() + rho;
  const double theta_P = pump.tongue_angle + std::asin(rho * std::sin(alpha) / C);
  const double r_P = C * std::cos(pump.tongue_angle - theta_P) - rho * std::cos(alpha);
  VolutePlan plan;
  plan.slope_angle = alpha;
  const double theta_end = 2 * pi + alpha;
  for (int k = 0; k < spiral_points; ++k) {
    const double theta = theta_P + (theta_end - theta_P) * k / (spiral_points - 1);
    plan.spiral.push_back(polar(r_P * std::exp(slope * (theta - theta_P)), theta));
  }
  plan.nose_centre = polar(C, pump.tongue_angle);
  // Middle of the arc from P, at the angle theta_P - alpha + pi of the circle, to the outlet's side at 2 pi.
  plan.nose_bottom = plan.nose_centre + polar(rho, 0.5 * (theta_P - alpha + pi + 2 * pi));
  plan.nose_side = plan.nose_centre + Vec3{rho, 0, 0};
  plan.throat = plan.spiral.back().x - plan.nose_side.x;
  plan.outlet_start = plan.nose_side.y + pump.outlet_straight_length;
  require(plan.throat > 2 * rho,
          fmt::format("throat of the casing ({:g} m), must exceed the tongue's thickness ({:g} m); enlarge design_flow or volute_factor",
                      plan.throat, 2 * rho));
  require(
      pump.sliding_radius() < 0.99 * pump.tongue_tip_radius() && pump.sliding_radius() > 1.02 * pump.inlet_diameter / 2,
      fmt::format("sliding radius ({:g} m), must lie between the eye ({:g} m) and the tongue ({:g} m); change inlet_diameter or tongue_gap",
                  pump.sliding_radius(), pump.inlet_diameter / 2, pump.tongue_tip_radius()));
  require(pump.leading_edge_radius + pump.leading_thickness() < pump.impeller_radius(),
          "leading_edge_radius, must lie inside the impeller");
  return plan;
}

}  // namespace snag::generate
