#pragma once
// Mean of an observable over the time that a piece is in the window of the camera.
#include <cmath>
#include <limits>
#include <numbers>

namespace snag {

class WindowMean {
 public:
  /// `period`: of an angle, rad, which is averaged on the circle of its period, for an axis has no head; 0: the value is no angle.
  void add(double value, double period) {
    turn_ = period == 0 ? 0 : 2 * std::numbers::pi / period;
    cosine_ += turn_ == 0 ? value : std::cos(turn_ * value), sine_ += std::sin(turn_ * value);
    ++n_;
  }
  /// NaN if nothing was added.
  double value() const {
    if (n_ == 0) return std::numeric_limits<double>::quiet_NaN();
    return turn_ == 0 ? cosine_ / n_ : std::atan2(sine_, cosine_) / turn_;
  }

 private:
  double turn_ = 0, cosine_ = 0, sine_ = 0;  // of numbers that are no angles: cosine_ is their sum
  int n_ = 0;
};

}  // namespace snag
