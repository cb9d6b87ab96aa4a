// Repeats of paths: given as mean, standard deviation and number, and such that end at different times.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "diagnosis/data/noise.hpp"
#include "diagnosis/data/outliers.hpp"
#include "diagnosis/data/summary.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr int n_times = 20, n_repeats = 10;
constexpr double u = 0.01, step = 0.1;

/// Has a slot at each time of a sample.
class Timed final : public TestSimulator {
 public:
  Timed() {
    for (int k = 0; k < n_times; ++k) slots_.push_back({.observable = 0, .time = step * k});
  }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override { return std::vector<double>(n_times, 0); }
};

PointSummary summary_of(const Experiment& experiment) { return summarize(experiment, Timed(), false).front(); }

/// Ten repeats of independent scatter 0.01 a time, as a publication prints them.
Experiment published(const std::string& observable, std::uint64_t seed) {
  const auto folder = std::filesystem::temp_directory_path() / ("snag-means-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ostringstream csv;
  csv.precision(12);
  csv << "point,replicate,t_s,observable,value,n,sd\n";
  NormalNumbers random(seed);
  for (int k = 0; k < n_times; ++k) {
    double sum = 0, square = 0;
    for (int r = 0; r < n_repeats; ++r) {
      const double value = 1 + std::sin(step * k) + u * random();
      sum += value, square += value * value;
    }
    csv << "A,1," << step * k << ",x," << sum / n_repeats << "," << n_repeats << ","
        << std::sqrt((square - sum * sum / n_repeats) / (n_repeats - 1)) << "\n";
  }
  std::ofstream(folder / "data.csv") << csv.str();
  std::ofstream(folder / "DIAGNOSIS.toml") << "[experiment]\ndata = \"data.csv\"\n[[observable]]\nid = \"x\"\nunit = \"m\"\n"
                                           << observable << "\n[[point]]\nid = \"A\"\ncase = \"a.toml\"\n";
  Experiment experiment = read_experiment(folder / "DIAGNOSIS.toml");
  std::filesystem::remove_all(folder);
  return experiment;
}

/// Requirement: of means of several repeats the variance at each time is sd^2/n, independent from time to time; they are no paths of
/// repeats, whose noise lasts or among which one is an outlier.
TEST(RepeatsOfPaths, MeansAreIndependentFromTimeToTime) {
  for (const char* stated : {"noise_u = 0.01", "noise_u = 0.003", "noise_u = 0"}) {
    const Experiment experiment = published(stated, 11);
    EXPECT_EQ(noise_of_repeats(experiment).front().nats, 0) << stated;
    EXPECT_TRUE(find_outliers(experiment).front().samples.empty()) << stated;
    const PointSummary summary = summary_of(experiment);
    ASSERT_EQ(summary.n_gaussian, n_times);
    const Eigen::VectorXd own = summary.covariance.diagonal();
    EXPECT_EQ((summary.covariance - Eigen::MatrixXd(own.asDiagonal())).norm(), 0) << stated;
    EXPECT_NEAR(own.mean(), u * u / n_repeats, 0.2 * u * u / n_repeats) << stated;
    EXPECT_GT(own.minCoeff(), 0.5 * u * u / n_repeats) << stated;
    EXPECT_EQ(summary.rows.front().n_replicates, n_repeats);
  }
}

/// Requirement: the mean and the standard deviation of a lognormal quantity are those of its logarithm by its moments.
TEST(RepeatsOfPaths, MeansOfALognormalQuantity) {
  const Experiment experiment = published("kind = \"lognormal\"", 12);
  const PointSummary summary = summary_of(experiment);
  const Datum& first = experiment.data.front();
  const double variance = std::log1p(std::pow(first.sd / first.value, 2));
  EXPECT_NEAR(summary.rows.front().value, std::log(first.value) - 0.5 * variance, 1e-12);
  EXPECT_NEAR(summary.rows.back().u, u / (1 + std::sin(step * (n_times - 1))) / std::sqrt(n_repeats), 0.001);
}

/// `n` repeats of noise and an offset from zero, of standard deviation 1 or, where it grows, t; from sample `end` on only the last
/// `n_at_the_end` repeats have samples.
Experiment of_offsets(int n, int n_at_the_end, int end, double noise_u, std::uint64_t seed, bool grows = false) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = noise_u, .calibration_group = ""}};
  experiment.points.push_back({.id = "A", .case_file = {}});
  NormalNumbers random(seed);
  for (int r = 0; r < n; ++r) {
    const double offset = random();
    for (int k = 0; k < (r >= n - n_at_the_end ? n_times : end); ++k)
      experiment.data.push_back({.replicate = r, .time = step * k, .value = offset * (grows ? step * k : 1) + u * random()});
  }
  return experiment;
}

/// Requirement: where repeats end early, the offsets of those that remain are divided by their number; the variance of one offset is that
/// of the time when all were there.
TEST(RepeatsOfPaths, ThoseThatEndEarly) {
  constexpr int n = 6, n_seeds = 100;
  for (const int left : {1, 2})
    for (const double noise_u : {u, 0.0}) {
      double first = 0, last = 0;
      for (int seed = 0; seed < n_seeds; ++seed) {
        const PointSummary summary = summary_of(of_offsets(n, left, n_times / 2, noise_u, 100 + static_cast<std::uint64_t>(seed)));
        first += summary.covariance(0, 0) / n_seeds, last += summary.covariance(n_times - 1, n_times - 1) / n_seeds;
        EXPECT_GT(summary.covariance.llt().matrixLLT().diagonal().minCoeff(), 0);
        EXPECT_EQ(summary.rows.back().n_replicates, left);
      }
      const double factor = noise_u > 0 ? 1 : 5.0 / 3;  // without noise_u of few degrees of freedom
      std::printf("%d of %d repeats go on, noise_u %g: variance of their mean %.2f, of all %.2f\n", left, n, noise_u, last, first);
      EXPECT_NEAR(first, factor / n, 0.3 * factor / n);
      EXPECT_NEAR(last, factor / left, 0.3 * factor / left);
    }
}

/// Requirement: scatter that grows in time is extrapolated to the times at which one repeat is left.
TEST(RepeatsOfPaths, ScatterGrowsOn) {
  constexpr int n_seeds = 100;
  const double end = step * (n_times - 1);
  double last = 0;
  for (int seed = 0; seed < n_seeds; ++seed)
    last +=
        summary_of(of_offsets(6, 1, n_times / 2, u, 300 + static_cast<std::uint64_t>(seed), true)).covariance(n_times - 1, n_times - 1) /
        n_seeds;
  std::printf("variance of the last repeat %.2f of %.2f\n", last, end * end);
  EXPECT_NEAR(last, end * end, 0.3 * end * end);
}

}  // namespace
}  // namespace snag
