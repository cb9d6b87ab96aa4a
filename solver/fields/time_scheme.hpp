#pragma once
// Differences in time.

namespace snag {

/// du/dt ~ (now u^(n+1) + old u^n + older u^(n-1)) / dt. Second order for any ratio of the steps; exact for parabolas in t.
struct TimeScheme {
  double dt = 0, now = 1, old = -1, older = 0;
  double ratio = 0;  // dt / dt_old; 0 in the first step, which has no history: u^(n+1) is then guessed as u^n
};
TimeScheme bdf(double dt, double dt_old);

/// The second difference (u^(n+1) - u^n) - r (u^n - u^(n-1)), zero for what changes evenly in time.
template <class T>
inline T second_difference(const TimeScheme& time, const T& now, const T& old, const T& older) {
  return now - (1 + time.ratio) * old + time.ratio * older;
}

}  // namespace snag
