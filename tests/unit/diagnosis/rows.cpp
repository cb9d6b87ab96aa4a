// Rows of the data against runs: covariances of mixed units, biases, times that no run shows, data that are all censored.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnosis/fit.hpp"
#include "diagnosis/response.hpp"

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

}  // namespace
}  // namespace snag
