#pragma once
// [virtual_camera]: where the virtual camera of a case stands, and where a piece counts as gone in a flow without openings.
#include <string>

#include "base/parameter.hpp"
#include "observe/silhouette.hpp"

namespace snag {

struct ObserveSettings {
  Vec3 right{1, 0, 0}, up{0, 1, 0};
  Vec3 exit_point, exit_normal;     // m; normal zero: no exit
  Vec3 window_lower, window_upper;  // m; equal: no window

  Section section();
  /// Unit vectors at right angles; throws Error(usage) if the two directions are parallel or zero.
  View view() const;
  bool has_exit() const { return norm(exit_normal) > 0; }
  /// Distance beyond the exit plane, m.
  double beyond_exit(const Vec3& centre) const { return dot(centre - exit_point, unit(exit_normal)); }
  bool has_window() const { return norm(window_upper - window_lower) > 0; }
  bool in_window(const Vec3& centre) const;
};

}  // namespace snag
