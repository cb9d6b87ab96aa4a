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
      "Where the pump is in the picture of a camera that looks along its shaft: with it the stay of rags over the angle of the volute is "
      "counted in pictures. Points are column and row in pixels from the upper left corner. The casing fills the picture up to the "
      "outlet; there is one rag at a time, the largest blob.",
      {required("axis", &axis, "1", -infinity, "Where the shaft is seen."),
       required("tongue", &tongue, "1", -infinity, "Where the nose of the tongue is seen: there the angle is zero."),
       required("outlet", &outlet, "1", -infinity, "Middle of the outlet: what is beyond it is out."),
       required("outlet_direction", &outlet_direction, "1", -infinity,
                "Out of the casing: to the right and up in the picture, any length."),
       required("outlet_radius", &outlet_radius, "m", 1e-6, "Half the width of the outlet."),
       required("tongue_reach", &tongue_reach, "m", 0, "Cloth that is seen nearer than this to the tongue touches it."),
       required("impeller_radius", &impeller_radius, "m", 1e-6, "Outer radius of the impeller."),
       setting("seen_from", &seen_from, "Side on which the camera stands.", {"inlet", "motor"}),
       setting("impeller_turns", &impeller_turns, "As it is seen in the picture.", {"counter_clockwise", "clockwise"})},
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
