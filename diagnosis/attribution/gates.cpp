#include "diagnosis/attribution/gates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "observe/observables.hpp"

namespace snag {

namespace {

/// The way of the pieces along an axis.
struct Way {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double moved = 0;  // sum over the paths of last less first

  void add(const std::vector<double>& path) {
    for (const double x : path) low = std::min(low, x), high = std::max(high, x);
    if (!path.empty()) moved += path.back() - path.front();
  }
  double range() const { return high > low ? high - low : 0; }
};

}  // namespace

Gate GateFamily::at(double place) const {
  Gate gate;
  if (axis < 0)
    gate.from = place;
  else
    (is_upwards ? gate.lower : gate.upper).at(static_cast<std::size_t>(axis)) = place;
  return gate;
}

std::vector<GateFamily> gate_families(const Responses& model, const std::vector<Response>& base) {
  double duration = 0;
  std::array<Way, 3> ways;
  for (std::size_t p = 0; p < base.size(); ++p) {
    const PointSummary& point = model.points()[static_cast<std::size_t>(model.training()[p])];
    duration = std::max(duration, point.duration);
    std::array<std::vector<double>, 3> paths;
    for (std::size_t i = 0; i < point.rows.size(); ++i) {
      const Row& row = point.rows[i];
      const ObservableRecord* record = row.kind == Row::Kind::path
                                           ? find_observable(model.experiment().observables[static_cast<std::size_t>(row.observable)].id)
                                           : nullptr;
      if (record && record->is_position())
        paths.at(static_cast<std::size_t>(record->axis)).push_back(base[p].value[static_cast<Eigen::Index>(i)]);
    }
    for (std::size_t axis = 0; axis < ways.size(); ++axis) ways.at(axis).add(paths.at(axis));
  }
  std::vector<GateFamily> families;
  if (duration > 0) families.push_back({.axis = -1, .is_upwards = true, .low = 0, .high = duration});
  double longest = 0;
  for (const Way& way : ways) longest = std::max(longest, way.range());
  constexpr double short_way = 0.3;  // of the longest
  for (std::size_t axis = 0; axis < ways.size(); ++axis) {
    const Way& way = ways.at(axis);
    if (way.range() > short_way * longest)
      families.push_back({.axis = static_cast<int>(axis), .is_upwards = way.moved > 0, .low = way.low, .high = way.high});
  }
  return families;
}

}  // namespace snag
