#pragma once
// Where a pump with a transparent casing is in a camera's picture: shaft, tongue, outlet, as points that are read off a picture.
#include <string>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

/// The table [pump_in_picture] of a camera file. Points are column and row in pixels from the upper left corner.
struct VoluteView {
  std::vector<double> axis, tongue, outlet;                         // column, row
  std::vector<double> outlet_direction;                             // to the right, up
  double outlet_radius = 0, tongue_reach = 0, impeller_radius = 0;  // m
  std::string seen_from = "inlet", impeller_turns = "counter_clockwise";

  Section section();
};

/// Throws Error(usage) naming `where` on what cannot be a view of a pump.
void check_volute_view(const VoluteView& view, const std::string& where);

}  // namespace snag
