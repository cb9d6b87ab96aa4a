#include "diagnosis/data/between_series.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace snag {

namespace {

/// One mean of points that should be alike: of an observable, of a scalar or at the same times.
struct Same {
  std::vector<std::string> set;
  std::string case_file;
  int observable = 0;
  double begin = 0, end = 0;
  friend bool operator<(const Same& a, const Same& b) {
    return std::tie(a.set, a.case_file, a.observable, a.begin, a.end) < std::tie(b.set, b.case_file, b.observable, b.begin, b.end);
  }
};

struct Means {
  std::map<std::string, int> groups;  // how often each is there
  double n = 0, W = 0, W2 = 0, Wy = 0, Wyy = 0;
};

}  // namespace

std::vector<BetweenSeries> between_series(const Experiment& experiment, const std::vector<PointSummary>& summaries) {
  std::map<Same, Means> alike;
  std::map<std::string, std::vector<int>> groups;
  for (const PointSummary& summary : summaries) {
    const OperatingPoint& point = experiment.points[static_cast<std::size_t>(summary.point)];
    if (point.group.empty()) continue;
    groups[point.group].push_back(summary.point);
    if (point.withheld) continue;
    for (int i = 0; i < summary.n_gaussian; ++i) {
      const Row& row = summary.rows[static_cast<std::size_t>(i)];
      if (experiment.observables[static_cast<std::size_t>(row.observable)].kind != Observable::Kind::gaussian || !(row.u > 0)) continue;
      const double never = -1;  // a scalar has no time
      Means& means = alike[{point.set, point.case_file.string(), row.observable, std::isnan(row.begin) ? never : row.begin,
                            std::isnan(row.end) ? never : row.end}];
      const double w = 1 / (row.u * row.u);
      ++means.groups[point.group];
      means.n += 1, means.W += w, means.W2 += w * w, means.Wy += w * row.value, means.Wyy += w * row.value * row.value;
    }
  }
  std::map<int, std::pair<double, double>> sums;  // by observable: sum (Q - (k - 1)), sum (W - sum w^2/W)
  for (const auto& [same, means] : alike) {
    if (means.groups.size() < 2) continue;
    auto& [excess, weight] = sums[same.observable];
    excess += means.Wyy - means.Wy * means.Wy / means.W - (means.n - 1), weight += means.W - means.W2 / means.W;
  }
  std::vector<BetweenSeries> terms;
  for (const auto& [observable, sum] : sums) {
    if (!(sum.first > 0)) continue;
    const double tau = std::sqrt(sum.first / sum.second);
    for (const auto& [group, points] : groups)
      terms.push_back({"series:" + experiment.observables[static_cast<std::size_t>(observable)].id + "@" + group, observable, points, tau});
  }
  return terms;
}

}  // namespace snag
