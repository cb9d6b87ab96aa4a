#include "observe/volute_view.hpp"

#include <utility>

#include "base/error.hpp"

namespace snag {

Section VoluteView::section() {
  const auto required = [](const char* key, ParameterTarget target, const char* unit, double minimum, const char* meaning) {
    Parameter parameter{.key = key, .target = target, .unit = unit, .minimum = minimum, .meaning = meaning};
    parameter.required = true;
    return parameter;
  };
  return {
      "pump_in_picture",
      "Position of the pump in the picture of a camera that looks along the shaft; it is needed for the residence time of rags over the "
      "volute angle. Points are column and row in pixels from the upper left corner. The casing fills the picture up to the outlet; the "
      "largest blob is the rag, one at a time.",
      {required("axis", &axis, "1", -infinity, "Point of the shaft in the picture."),
       required("tongue", &tongue, "1", -infinity, "Point of the nose of the tongue in the picture; the volute angle is zero there."),
       required("outlet", &outlet, "1", -infinity, "Middle of the outlet in the picture; cloth beyond it has left."),
       required("outlet_direction", &outlet_direction, "1", -infinity,
                "Direction out of the casing: components to the right and up in the picture, of any length."),
       required("outlet_radius", &outlet_radius, "m", 1e-6, "Half the width of the outlet."),
       required("tongue_reach", &tongue_reach, "m", 0, "Distance from the tongue; cloth within it counts as contact with the tongue."),
       required("impeller_radius", &impeller_radius, "m", 1e-6, "Outer radius of the impeller."),
       setting("seen_from", &seen_from, "Side on which the camera stands.", {"inlet", "motor"}),
       setting("impeller_turns", &impeller_turns, "Sense of rotation of the impeller in the picture.", {"counter_clockwise", "clockwise"})},
      false,
      "volute"};
}

void check_volute_view(const VoluteView& view, const std::string& where) {
  const std::pair<const std::vector<double>*, const char*> points[]{{&view.axis, "axis must be column and row"},
                                                                    {&view.tongue, "tongue must be column and row"},
                                                                    {&view.outlet, "outlet must be column and row"},
                                                                    {&view.outlet_direction, "outlet_direction must be right and up"}};
  for (const auto& [point, rule] : points)
    if (point->size() != 2)
      throw Error(ExitCode::usage, where + ": " + rule + ", has " + std::to_string(point->size()) + " numbers; give two");
}

}  // namespace snag
