#include "simulation/setup/observe_settings.hpp"

#include "base/case_tables.hpp"
#include "base/error.hpp"

namespace snag {

Section ObserveSettings::section() {
  const auto vector = [](const char* key, Vec3* target, const char* unit, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = unit, .meaning = meaning};
  };
  return {
      "virtual_camera",
      "What a diagnosis measures in a run: the directions of the picture, a window, and a plane behind which a piece has left.",
      {vector("right", &right, "1", "Direction to the right in the picture, a vector of any length."),
       vector("up", &up, "1", "Direction up in the picture; its component along `right` is removed. The camera looks along up x right."),
       vector("exit_point", &exit_point, "m", "A point on the exit plane."),
       vector("exit_normal", &exit_normal, "1",
              "Normal of the exit plane in the direction of the exit; a piece has left as soon as its centre is beyond the plane. By "
              "default there is no exit."),
       vector("window_lower", &window_lower, "m",
              "Lower corner of the window; an observable without a time is the mean over the time that the centre is in the window."),
       vector("window_upper", &window_upper, "m", "Upper corner of the window; by default there is no window.")},
      false,
      "observe"};
}
const bool virtual_camera_table = add_case_table<ObserveSettings>(260);

bool ObserveSettings::in_window(const Vec3& p) const {
  for (int i = 0; i < 3; ++i)
    if (!(p[i] >= window_lower[i] && p[i] <= window_upper[i])) return false;
  return true;
}

View ObserveSettings::view() const {
  const Vec3 x = unit(right), y = unit(up - dot(up, x) * x);
  if (norm(x) == 0 || norm(y) == 0)
    throw Error(ExitCode::usage, "[virtual_camera] right and up are parallel or zero, must span the picture; give other directions");
  return {x, y};
}

}  // namespace snag
