// Rows of the data against runs: covariances of mixed units, biases, times that no run shows, data that are all censored.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnosis/fitting/fit.hpp"
#include "diagnosis/fitting/response.hpp"
#include "diagnosis/localisation/gap_cells.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

/// Requirement: a row's variance is not touched by what is measured beside it in another unit.
TEST(Rows, CovarianceKeepsUnitsApart) {
  PointSummary point;
  point.n_gaussian = 2;
  for (int observable : {0, 1}) point.rows.push_back({.kind = Row::Kind::scalar, .observable = observable});
  point.covariance = Eigen::Vector2d(1e-8, 1e8).asDiagonal();  // u of 1e-4 m and of 1e4 Pa
  Response response;
  response.value = response.scatter = Eigen::Vector2d::Zero();
  const Eigen::MatrixXd C = model_covariance(point, response, Eigen::Vector2d::Zero(), {});
  EXPECT_NEAR(C(0, 0) / 1e-8, 1, 1e-6);
  EXPECT_NEAR(C(1, 1) / 1e8, 1, 1e-6);
}

/// Requirement: where repeats end early, the scatter of random runs over the number of repeats gives a covariance all the same.
TEST(Rows, CovarianceOfRepeatsThatEndEarly) {
  PointSummary point;
  point.n_gaussian = 2;
  for (const double time : {0.0, 0.1}) {
    Row row{.kind = Row::Kind::path, .observable = 0};
    row.begin = row.end = time, row.n_replicates = time > 0 ? 1 : 6;
    point.rows.push_back(row);
  }
  point.covariance = Eigen::Matrix2d::Zero();
  Response response;
  response.value = Eigen::Vector2d::Zero(), response.scatter = Eigen::Vector2d::Ones();
  response.paths = Eigen::MatrixXd(2, 8);
  for (int run = 0; run < 8; ++run) response.paths.col(run).setConstant(run - 3.5);  // what a run has, it has at both times
  const Eigen::MatrixXd C = model_covariance(point, response, Eigen::Vector2d::Zero(), {});
  EXPECT_GT(C.determinant(), 0);
}

/// Answers every slot with one number, or with none.
class Constant final : public TestSimulator {
 public:
  explicit Constant(double value, const std::vector<Nuisance>& known = {}) : value_(value) { nuisances_ = known, slots_ = {{}}; }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override { return {value_}; }
  double value_;
};

/// Answers with another normal number of this scatter for each seed.
class Scattered final : public TestSimulator {
 public:
  Scattered(double mean, double scatter) : mean_(mean), scatter_(scatter) { slots_ = {{}}; }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    const double share = static_cast<double>(request.seed % 8) + 0.5;
    return {mean_ + scatter_ * normal_quantile(share / 8)};
  }
  double mean_, scatter_;
};

Experiment of_one_row(const Observable& observable, const std::vector<Datum>& data) {
  Experiment experiment;
  experiment.observables = {observable}, experiment.data = data;
  experiment.points.push_back({.id = "A", .case_file = {}});
  return experiment;
}

std::vector<GapCell> cells_of(Responses& responses) {
  Fitter fitter(responses);
  return gap_cells(responses, fitter, FittedGap(responses, fitter.fit({}, Eigen::VectorXd())));
}

/// Requirement: a cell tells that repeats scatter otherwise than runs, and only then, though their means agree.
TEST(Rows, ScatterOfRepeatsIsCompared) {
  std::vector<Datum> data;
  for (int r = 0; r < 40; ++r) data.push_back({.replicate = r, .value = 2 + normal_quantile((r + 0.5) / 40)});
  Experiment experiment = of_one_row({.id = "area", .unit = "m2", .calibration_group = ""}, data);
  experiment.max_runs = 3000;
  const auto cell_of = [&](double scatter) {
    Scattered simulator(2, scatter);
    Responses responses(experiment, simulator);
    return cells_of(responses).front();
  };
  const GapCell alike = cell_of(1), other = cell_of(12);
  EXPECT_GT(alike.p, 0.1);
  EXPECT_FALSE(alike.significant);
  EXPECT_EQ(other.test, CellTest::energy_distance);
  EXPECT_LT(other.p, 0.01);
  EXPECT_TRUE(other.significant);
}

/// Answers the slots of a path with its measured places, as far as the runs go.
class Straight final : public TestSimulator {
 public:
  explicit Straight(int n, double end = std::numeric_limits<double>::infinity()) : end_(end) {
    for (int i = 0; i < n; ++i) slots_.push_back({.observable = 0, .time = 0.1 * i});
  }
  double run_end(int) const override { return end_; }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override {
    std::vector<double> path;
    for (const Slot& slot : slots_) path.push_back(slot.time <= end_ ? slot.time : std::numeric_limits<double>::quiet_NaN());
    return path;
  }
  double end_;
};

/// Requirement: rows that are left out because the runs end before them are told with their number and the remedy.
TEST(Rows, ThoseAfterTheEndOfARunAreTold) {
  std::vector<Datum> data;
  for (int i = 0; i < 10; ++i) data.push_back({.time = 0.1 * i, .value = 0.1 * i});
  const Experiment experiment = of_one_row({.id = "x", .unit = "m", .noise_u = 0.01, .calibration_group = ""}, data);
  Straight early(10, 0.65), whole(10, 1);
  const Responses some(experiment, early), all(experiment, whole);
  ASSERT_EQ(some.notes().size(), 1);
  EXPECT_EQ(some.notes().front(),
            "x at point A: 3 of 10 rows, from 0.7 s on, are not compared, for the runs have no number there; they end at 0.65 s: raise "
            "[time] end_s of the case.");
  EXPECT_EQ(some.points().front().rows.size(), 7);
  EXPECT_TRUE(all.notes().empty());
}

/// Requirement: a number that the runs do not have is named.
TEST(Rows, NumbersThatNoRunHasAreNamed) {
  for (const bool lognormal : {false, true}) {
    const Observable time{.id = "retention_time",
                          .unit = "s",
                          .kind = lognormal ? Observable::Kind::lognormal : Observable::Kind::gaussian,
                          .noise_u = 0.1,
                          .calibration_group = ""};
    const Experiment experiment = of_one_row(time, {{.value = 3}});
    Constant never(std::numeric_limits<double>::quiet_NaN());
    const Responses responses(experiment, never);
    EXPECT_EQ(responses.points().front().rows.size(), lognormal ? 1 : 0);
    ASSERT_EQ(responses.notes().size(), lognormal ? 0 : 1);
    for (const std::string& note : responses.notes())
      EXPECT_EQ(note.find("retention_time at point A is not compared, for the runs have no such number."), 0) << note;
  }
}

/// Requirement: the cells of a path change where it comes into another region, and each is in the region where it was measured.
TEST(Rows, CellsAreToldApartByRegion) {
  constexpr int n = 20;
  std::vector<Datum> data;
  for (int i = 0; i < n; ++i) data.push_back({.time = 0.1 * i, .value = 0.1 * i + (i >= 10 && i < 15 ? 1e-2 : 0)});
  Experiment experiment = of_one_row({.id = "x", .unit = "m", .noise_u = 1e-3, .calibration_group = ""}, data);
  experiment.regions = {{.id = "pipe", .upper = {0.95, 1, 1}}, {.id = "eye", .upper = {1.45, 1, 1}}};
  Straight simulator(n);
  Responses responses(experiment, simulator);
  for (const GapCell& cell : cells_of(responses)) {
    const double middle = 0.5 * (cell.window[0] + cell.window[1]);
    EXPECT_EQ(cell.region, middle < 0.95 ? "pipe" : middle < 1.45 ? "eye" : "elsewhere") << middle;
    EXPECT_LE(cell.window[1], cell.region == "pipe" ? 0.95 : cell.region == "eye" ? 1.45 : 2);
    EXPECT_EQ(cell.significant, cell.region == "eye") << middle;
  }
}

/// Requirement: a gap that changes sign within a cell, so that its mean shows nothing, is found, and only then.
TEST(Rows, GapThatChangesSignIsFound) {
  constexpr int n = 20;
  for (const double size : {0.0, 5e-3}) {
    std::vector<Datum> data;
    for (int i = 0; i < n; ++i) data.push_back({.time = 0.1 * i, .value = 0.1 * i + (i >= 5 && i < 10 ? size * (i % 2 ? 1 : -1) : 0)});
    const Experiment experiment = of_one_row({.id = "x", .unit = "m", .noise_u = 1e-3, .calibration_group = ""}, data);
    Straight simulator(n);
    Responses responses(experiment, simulator);
    for (const GapCell& cell : cells_of(responses)) {
      const bool is_there = size > 0 && cell.window[0] < 0.95 && cell.window[1] > 0.45;
      EXPECT_LT(std::abs(cell.z), 3);
      EXPECT_EQ(cell.significant, is_there) << cell.window[0];
      EXPECT_EQ(cell.test, is_there ? CellTest::fitted : CellTest::z);
      EXPECT_EQ(std::abs(cell.score) > 3, is_there);
    }
  }
}

/// Requirement: a bias that the simulator applies is free once, with a calibration group or without.
TEST(Rows, BiasIsCountedOnce) {
  const Experiment experiment =
      of_one_row({.id = "x", .unit = "m", .noise_u = 1e-4, .bias_u = 1e-3, .calibration_group = ""}, {{.value = 0.5}});
  Constant simulator(0.4);
  EXPECT_EQ(Responses(experiment, simulator).nuisances().size(), 1u);
  Constant biased(0.4, {{"bias of x", 1, {0}}});
  const Responses responses(experiment, biased);
  ASSERT_EQ(responses.nuisances().size(), 1u);
  EXPECT_TRUE(responses.nuisances()[0].of_data);
}

Row of_times(const std::vector<double>& seconds, bool censored) {
  Row row;
  row.kind = Row::Kind::time, row.n_replicates = static_cast<int>(seconds.size());
  for (const double t : seconds) row.values.push_back(std::log(t)), row.censored.push_back(censored);
  row.value = std::log(seconds.front()), row.sigma = 0.3;
  row.u = censored ? std::numeric_limits<double>::infinity() : 0.3 / std::sqrt(row.n_replicates);
  return row;
}

/// Requirement: 50 of 50 censored at the model's median are as unlikely as 50 heads; a model far later fits them.
TEST(Rows, AllCensored) {
  const Row row = of_times(std::vector<double>(50, 60.0), true);
  EXPECT_NEAR(deviance_residual(row, std::log(60), 1, 0), std::sqrt(2 * 50 * std::log(2.0)), 1e-9);
  EXPECT_NEAR(deviance_residual(row, std::log(600), 1, 0), 0, 1e-5);
}

/// Requirement: runs that end before the event fit tests that did so, contradict known times, and leave the row in.
TEST(Rows, NoRunCameToTheEvent) {
  const Observable exit{.id = "retention_time", .unit = "s", .kind = Observable::Kind::lognormal, .noise_u = 0.05, .calibration_group = ""};
  for (const bool censored : {false, true}) {
    std::vector<Datum> data;
    for (int r = 0; r < 50; ++r)
      data.push_back({.replicate = r, .value = censored ? 60.0 : 0.239 * (1 + 0.002 * (r - 25)), .censored = censored});
    const Experiment experiment = of_one_row(exit, data);
    Constant never(std::numeric_limits<double>::quiet_NaN());
    Responses responses(experiment, never);
    ASSERT_EQ(responses.points()[0].rows.size(), 1u);
    const auto answer = responses.run(responses.base(), {0});
    EXPECT_TRUE(answer[0].later[0]);
    const Eigen::VectorXd r = residual(responses.points()[0], answer[0], Eigen::LLT<Eigen::MatrixXd>());
    if (censored)
      EXPECT_EQ(r[0], 0);
    else
      EXPECT_LT(r[0], -3);  // even if the runs lasted no longer than the longest test
  }
}

/// Requirement: a likelihood of a model-dependent variance has its normaliser.
TEST(Rows, VarianceOfScatteredRuns) {
  const Row row = of_times(std::vector<double>(9, 1.0), false);  // variance of the mean 0.01
  EXPECT_DOUBLE_EQ(variance_ratio(row, 0, 3, 0.09), 4);
  EXPECT_NEAR(deviance_residual(row, 0.1, 3, 0.09), -0.1 / 0.2, 1e-9);
}

/// Requirement: the scatter of few replicates that does come from the noise is rarely far off: of 2000 variances with 8 degrees of freedom
/// as many are beyond 2 and 3 standard normal deviations as of a normal variable, on either side.
TEST(Rows, ScatterOfFewReplicates) {
  constexpr int degrees = 8, n = 2000;
  Row row;
  row.kind = Row::Kind::spread, row.n_replicates = 3, row.sigma = degrees, row.noise_u = 0.7;
  NormalNumbers random(3);
  int low = 0, high = 0, far = 0;
  for (int k = 0; k < n; ++k) {
    double square = 0;
    for (int i = 0; i < degrees; ++i) square += std::pow(row.noise_u * random(), 2);
    row.value = std::log(square / degrees);
    const double z = deviance_residual(row, 0, 1, 0);
    low += z<-2, high += z> 2, far += std::abs(z) > 3.5;
  }
  EXPECT_NEAR(low, 0.0228 * n, 22);  // 3 standard deviations of that number are 20
  EXPECT_NEAR(high, 0.0228 * n, 22);
  EXPECT_LE(far, 4);
}

}  // namespace
}  // namespace snag
