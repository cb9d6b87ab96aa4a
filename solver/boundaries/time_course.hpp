#pragma once
// How the value of a condition comes on in time: a factor on what the case gives.
//
//   ramp = T:              min(t/T, 1)
//   times t_i, factors:    linear between the times, constant before the first and after the last
#include <string>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

struct TimeCourse {
  double ramp = 0;                     // T, s
  std::vector<double> times, factors;  // t_i, s; 1

  /// Adds its keys to those of a condition; they point into this object. `value`: what they act on, for the manual.
  void add_keys(Section& section, const std::string& value);
  /// Throws Error(usage) if the keys contradict each other; `where` for the message.
  void check(const std::string& where) const;
  /// Times between which the factor is linear, s.
  std::vector<double> knots() const { return ramp > 0 ? std::vector<double>{ramp} : times; }
  /// Factor at a time, 1 without any key.
  double at(double time) const;
  /// Mean rate of the factor between two times, 1/s; 0 between one time and itself.
  double rate(double begin, double end) const { return end > begin ? (at(end) - at(begin)) / (end - begin) : 0; }
};

}  // namespace snag
