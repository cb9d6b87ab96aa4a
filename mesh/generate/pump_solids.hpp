#pragma once
// The solids of the pump in the current gmsh model (OpenCASCADE); each function adds volumes and returns their tags. Metres.
#include <string>
#include <vector>

#include "mesh/generate/pump_plan.hpp"

namespace snag::generate {

/// Water inside the impeller with its eye, turned to rotor_angle: sliding cylinder and eye's end disc are its interface.
std::vector<int> rotor_solid(const PumpDimensions& pump);
/// Spiral casing, rectangular outlet, transition and outlet pipe; the space of the rotor is cut out last.
std::vector<int> casing_solid(const PumpDimensions& pump);
/// Straight inlet pipe from the eye's end.
std::vector<int> inlet_pipe_solid(const PumpDimensions& pump, double length);

/// A tank around the inlet: the pump's cover is one wall, a plate stands before the opening, the water surface is at +y.
struct SuctionTank {
  double length = 1.0, width = 0.56, depth = 0.58;     // along the axis, across, from floor to surface, m
  double axis_height = 0.25;                           // of the pump's axis above the floor, m
  double plate_distance = 0.125;                       // from the eye's end to the plate, m
  double plate_width = 0.40, plate_thickness = 0.010;  // a square plate about the axis, m
  double cover_thickness = 0.010;                      // of the casing's cover, m
  double bell_radius = 0.015, lip_thickness = 0.005;   // rounding of the mouth; wall of a mouth that protrudes, m

  std::vector<Parameter> parameters();
  double cover(const PumpDimensions& pump) const { return pump.impeller_width + pump.side_gap + cover_thickness; }  // z of the tank's wall
  double plate(const PumpDimensions& pump) const { return pump.eye_height() + plate_distance; }                     // z of the plate's face
};
/// Tank, mouth and short pipe to the eye's end as one solid. Throws Error(usage) where mouth, plate and tank do not fit.
std::vector<int> tank_solid(const PumpDimensions& pump, const SuctionTank& tank, double inlet_length);

}  // namespace snag::generate
