// Requirement: what series of one condition differ by beyond their scatter is a deviation of each series.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/data/between_series.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

/// Two groups of two points; the first of each has the same case.
Experiment two_groups() {
  Experiment e;
  e.observables = {{.id = "y", .unit = "m", .calibration_group = ""}, {.id = "area", .unit = "m2", .calibration_group = ""}};
  for (const char* id : {"A", "B", "C", "D"})
    e.points.push_back(
        {.id = id, .case_file = "rag.toml", .set = {id[0] == 'A' || id[0] == 'C' ? "flow=1" : id}, .group = id[0] < 'C' ? "slow" : "fast"});
  return e;
}

PointSummary summary(int point, double y, double u_y, double area, double u_area) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PointSummary s;
  s.point = point, s.n_gaussian = 2;
  s.rows.push_back({.kind = Row::Kind::scalar, .observable = 0, .begin = nan, .end = nan, .value = y, .u = u_y});
  s.rows.push_back({.kind = Row::Kind::scalar, .observable = 1, .begin = nan, .end = nan, .value = area, .u = u_area});
  return s;
}

/// Of a pair tau^2 = D^2/2 - (u_a^2 + u_b^2)/2, each point of a group has its deviation; an observable that agrees has none.
TEST(BetweenSeries, OfOnePair) {
  Experiment e = two_groups();
  const std::vector<PointSummary> s{summary(0, -4e-3, 1e-3, 0.012, 1e-3), summary(1, 0, 1e-3, 0.012, 1e-3),
                                    summary(2, 8e-3, 2e-3, 0.0125, 1e-3), summary(3, 0, 1e-3, 0.02, 1e-3)};
  const auto terms = between_series(e, s);
  ASSERT_EQ(terms.size(), 2u);
  for (const BetweenSeries& term : terms) {
    EXPECT_EQ(term.observable, 0);
    EXPECT_NEAR(term.u * term.u, (144e-6 - 5e-6) / 2, 1e-12);
  }
  EXPECT_EQ(terms[0].name, "series:y@fast");
  EXPECT_EQ(terms[0].points, (std::vector<int>{2, 3}));
  EXPECT_EQ(terms[1].name, "series:y@slow");
  EXPECT_EQ(terms[1].points, (std::vector<int>{0, 1}));
  e.points[2].withheld = true;  // what is withheld teaches nothing
  EXPECT_TRUE(between_series(e, s).empty());
  e.points[2].withheld = false, e.points[2].group = "slow";  // nor do points of one series
  EXPECT_TRUE(between_series(e, s).empty());
}

/// Of many series the mean of tau^2 is right, with unequal scatter, too; of series that agree the median is nothing.
TEST(BetweenSeries, IsTheVarianceOfSeries) {
  for (const double tau : {0.0, 3.0}) {
    NormalNumbers random(17);
    double mean = 0;
    int n_none = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      Experiment e = two_groups();
      std::vector<PointSummary> s;
      for (int p = 0; p < 4; ++p) {
        const double u = 1 + 0.5 * p;
        e.points[static_cast<std::size_t>(p)].set = {"flow=1"},
        e.points[static_cast<std::size_t>(p)].group = std::string(1, static_cast<char>('a' + p));
        s.push_back(summary(p, tau * random() + u * random(), u, 1, 1));
      }
      const auto terms = between_series(e, s);
      if (!terms.empty()) mean += terms[0].u * terms[0].u / n;
      n_none += terms.empty();
    }
    std::printf("tau %g: mean of tau^2 %.3g, none in %d of %d\n", tau, mean, n_none, n);
    if (tau > 0)
      EXPECT_NEAR(mean, tau * tau, 0.1 * tau * tau);
    else
      EXPECT_GT(n_none, n / 2);
  }
}

}  // namespace
}  // namespace snag
