#include "simulation/setup/observe_settings.hpp"

#include "base/error.hpp"

namespace snag {

Section ObserveSettings::section() {
  const auto vector = [](const char* key, Vec3* target, const char* unit, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = unit, .meaning = meaning};
  };
  return {
      "virtual_camera",
      "What a diagnosis measures on a run: the camera's picture, a window in which it looks, and a plane behind which a piece has left.",
      {vector("right", &right, "1", "Direction to the right in the picture, any length."),
       vector("up", &up, "1", "Direction up in the picture; its part along `right` is taken off. The camera looks along up x right."),
       vector("exit_point", &exit_point, "m", "A point of the exit plane."),
       vector("exit_normal", &exit_normal, "1",
              "Direction out of the exit plane; a piece has left once its centre is beyond. Not given: there is no exit."),
       vector("window_lower", &window_lower, "m",
              "Lower corner of the window: numbers that are asked without a time are means over the time that the centre is in it."),
       vector("window_upper", &window_upper, "m", "Upper corner of the window. Not given: there is no window.")},
      false,
      "observe"};
}

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
