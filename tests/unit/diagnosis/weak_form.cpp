// What paths say of accelerations without a derivative of noise.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/localisation/weak_form.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

std::vector<double> times_of(int n, double uneven) {
  NormalNumbers random(4);
  std::vector<double> times;
  for (int i = 0; i < n; ++i) times.push_back(0.05 * (i + uneven * (random.uniform() - 0.5)));
  return times;
}

/// Requirement: offsets and drifts give nothing, a constant acceleration gives itself, at even and at uneven times.
TEST(WeakForm, IsExactForParabolas) {
  for (const double uneven : {0.0, 0.6}) {
    const auto times = times_of(20, uneven);
    const Eigen::MatrixXd W = test_functions(times);
    ASSERT_GT(W.rows(), 5);
    Eigen::VectorXd line(20), parabola(20);
    for (int i = 0; i < 20; ++i) line[i] = 3 - 7 * times[i], parabola[i] = 0.5 * 1.7 * times[i] * times[i] + line[i];
    for (Eigen::Index j = 0; j < W.rows(); ++j) {
      EXPECT_NEAR(W.row(j).dot(line), 0, 1e-9);
      EXPECT_NEAR(W.row(j).dot(parabola), 1.7, 1e-9);
    }
  }
}

/// Requirement: the acceleration that it tells is the mean about the time of its test function: second order in the width of the function.
TEST(WeakForm, ConvergesToTheAcceleration) {
  const auto error = [](int n) {
    std::vector<double> times;
    for (int i = 0; i < n; ++i) times.push_back(2.0 * i / (n - 1));
    Eigen::VectorXd x(n);
    for (int i = 0; i < n; ++i) x[i] = std::sin(3 * times[i]);
    const Eigen::MatrixXd W = test_functions(times);  // three samples to either side up to 23 samples
    double largest = 0;
    for (Eigen::Index j = 0; j < W.rows(); ++j) {
      Eigen::Index first = 0, last = n - 1;
      while (W(j, first) == 0) ++first;
      while (W(j, last) == 0) --last;
      const double centre = 0.5 * (times[first] + times[last]);
      largest = std::max(largest, std::abs(W.row(j).dot(x) + 9 * std::sin(3 * centre)));
    }
    return largest;
  };
  const double coarse = error(11), fine = error(21);
  EXPECT_LT(fine, 0.6);  // of 9
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
}

TEST(WeakForm, NeedsSevenSamples) {
  EXPECT_EQ(test_functions(times_of(6, 0)).rows(), 0);
  EXPECT_EQ(test_functions(times_of(7, 0)).rows(), 1);
}

}  // namespace
}  // namespace snag
