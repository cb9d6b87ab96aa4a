#pragma once
// How a sheet of cloth lies when it is put into the run: keys of [[rag]] and [[disc]].
#include <numbers>
#include <string>

#include "base/choice.hpp"
#include "base/vec3.hpp"

namespace snag {

struct PosePlan {
  enum class Kind { flat, folded, confined, hopper };
  Choice<Kind> kind{Kind::flat, {"flat", "folded", "confined", "hopper"}};
  int folds_lengthwise = 0;                       // folded: folds across the rows, which shorten the length
  int folds_crosswise = 0;                        // folded: folds along the rows, which shorten the width
  double confine_radius = 0;                      // confined, hopper: of the pipe, m
  double confine_length = 0;                      // confined: of the pipe between two plane ends, m; 0: no ends
  Vec3 confine_axis{0, 0, 1};                     // direction of the pipe; into it from a hopper
  double hopper_angle = 0.25 * std::numbers::pi;  // of the hopper's side to its axis, rad
  int seed = 1;                                   // of the waves that the sheet begins with
  std::string where;                              // the table of the case file, for messages

  /// Whether the pose comes from a run of the particles alone (crumpled.hpp).
  bool crumpled() const { return kind == Kind::confined || kind == Kind::hopper; }
};

}  // namespace snag
