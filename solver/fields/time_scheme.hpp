#pragma once
// Differences in time.

namespace snag {

/// du/dt ~ (now u^(n+1) + old u^n + older u^(n-1)) / dt. Second order for any ratio of the steps; exact for parabolas in t.
struct TimeScheme {
  double dt = 0, now = 1, old = -1, older = 0;
  double ratio = 0;  // dt / dt_old; 0 in the first step, which has no history: u^(n+1) is then guessed as u^n
  /// a: what has the means m_old and m over the last step and this one is (1 + a) m - a m_old at the end of this one, to second order. 0 in
  /// the first step, whose Euler scheme takes the mean.
  double extrapolation() const { return ratio / (1 + ratio); }
};
TimeScheme bdf(double dt, double dt_old);

/// The second difference (u^(n+1) - u^n) - r (u^n - u^(n-1)), zero for what changes evenly in time.
template <class T>
inline T second_difference(const TimeScheme& time, const T& now, const T& old, const T& older) {
  return now - (1 + time.ratio) * old + time.ratio * older;
}

}  // namespace snag
