#include "solver/boundaries/time_course.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

void TimeCourse::add_keys(Section& section, const std::string& value) {
  auto& keys = section.parameters;
  keys.push_back(
      {"ramp", &ramp, "s", 0, infinity, Basis::assumed, "Time in which the " + value + " rises from zero, linearly from t = 0."});
  keys.push_back({"times", &times, "s", 0, infinity, Basis::assumed, "Times of a table instead of a ramp, increasing; with factors."});
  keys.push_back({"factors", &factors, "1", -infinity, infinity, Basis::assumed,
                  "Factor on the " + value + " at each of the times, linear between them and constant outside."});
}

void TimeCourse::check(const std::string& where) const {
  if (times.size() != factors.size())
    throw Error(ExitCode::usage, where + ": times has " + std::to_string(times.size()) + " values and factors " +
                                     std::to_string(factors.size()) + "; give a factor for each time");
  if (ramp > 0 && !times.empty()) throw Error(ExitCode::usage, where + ": ramp and times are both given; keep one of them");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      throw Error(ExitCode::usage,
                  where + ": times must increase, but " + number_text(times[i]) + " s follows " + number_text(times[i - 1]) + " s");
}

double TimeCourse::at(double time) const {
  if (times.empty()) return ramp > 0 ? std::clamp(time / ramp, 0.0, 1.0) : 1;
  const std::size_t after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (after == 0) return factors.front();
  if (after == times.size()) return factors.back();
  const double share = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return (1 - share) * factors[after - 1] + share * factors[after];
}

}  // namespace snag
