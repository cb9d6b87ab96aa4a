#pragma once
// What a test rig reads off a pump: flow, head, torque, power, efficiency.
//
//   head          H = (p_out - p_in)/(rho g) + (Q_out^2/A_out^2 - Q_in^2/A_in^2)/(2 g)     p: means over the areas of the flanges
//   total head    the same from means of p + rho u^2/2 over the flux
//   torque        M = axis . sum (x - x_0) x F of the fluid on the walls of the impeller, by pressure and by friction
//   power         shaft: -M omega;   hydraulic: rho g Q_out H;   efficiency: hydraulic over shaft
//
// Pressure is that of the flow: without the weight of the water, so that heights of the flanges do not count; with 2/3 rho k of a
// turbulence model. Torque is that of the named walls only: no friction of the disc in the gap behind it, no seals, no bearings.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/shaft.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

struct PumpSettings {
  std::string inlet = "inlet", outlet = "outlet";
  std::vector<std::string> walls{"impeller_walls"};
  std::optional<double> inlet_diameter, outlet_diameter;  // m
  double gravity = 9.81;                                  // m/s2

  /// The table [pump]; its records point into this object.
  Section section();
};

/// One instant; SI units.
struct PumpReading {
  double flow_in = 0, flow_out = 0;                   // into the inlet, out of the outlet, m3/s
  double head = 0, head_total = 0;                    // m
  double torque_pressure = 0, torque_friction = 0;    // of the fluid on the walls about the axis, N m: negative where the rotor drives
  double shaft_power = 0, hydraulic_power = 0;        // W
  double torque_contacts = 0, shaft_power_total = 0;  // of rags on the walls, N m; with them, W: for the caller to set
  double torque() const { return torque_pressure + torque_friction; }
  double efficiency() const { return efficiency_of(hydraulic_power, shaft_power); }
  /// Zero where the shaft gives no power.
  static double efficiency_of(double hydraulic, double shaft) { return shaft > 0 ? hydraulic / shaft : 0; }
};

/// What of [pump] is probably not meant: walls that stand, where a zone turns, and diameters far from those of the patches. Collective, the
/// same on every rank.
std::vector<std::string> pump_warnings(const Flow& flow, const PumpSettings& settings);

class PumpMonitor {
 public:
  /// Throws Error(usage) for an unknown patch, and for one that is inlet and outlet. Collective.
  PumpMonitor(const Flow& flow, const PumpSettings& settings);
  /// Of the flow as it is. Collective, the same on every rank.
  PumpReading read(const Flow& flow, const Shaft& shaft) const;

 private:
  int inlet_, outlet_;
  std::vector<int> walls_;
  double inlet_area_, outlet_area_, gravity_;
};

}  // namespace snag
