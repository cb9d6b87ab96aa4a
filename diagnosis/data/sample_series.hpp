#pragma once
// The samples of an observable at a point as means over bins of time, and the covariance that noise and the scatter of the repeats give
// these means.
#include <Eigen/Dense>
#include <map>
#include <vector>

#include "diagnosis/data/noise.hpp"
#include "diagnosis/data/summary.hpp"

namespace snag {

/// A sample of a path, or the mean of several (transformed).
struct Sample {
  double value = 0, sd = 0;  // sd: between them; 0: not given, noise_u is used
  int n = 1;
};

/// What all repeats at one time have together.
struct Instant {
  int n = 0;                    // repeats
  double mean = 0, square = 0;  // sum of their squared deviations from it
  bool scatter_is_known = true;
};

/// The samples of one observable at one point, by time and replicate.
struct SampleSeries {
  const Observable* observable;
  const NoiseModel* noise;
  int observable_index = 0;
  std::map<int, int> replicates;                    // name -> 0 ..
  std::map<double, std::map<int, Sample>> samples;  // time -> replicate -> sample
  bool has_means = false;                           // some rows stand for several repeats: how long a deviation lasts is not known

  std::map<double, Instant> instants;

  double noise_u() const { return noise->factor * observable->noise_u; }

  /// To be called after the last sample was added.
  void sum_up();

  /// Of n samples of correlated noise the variance is as uncertain as that of n times this share independent samples, n/sum over i, j of
  /// r_ij^2, r their correlation: the variance of a sum of squares of Gaussian numbers is 2 sum r_ij^2.
  double independent_share(const std::vector<double>& times) const;
};

/// By what a variance from this many degrees of freedom is multiplied so that a normal law with it is as wide as Student's.
double factor_of_few(double degrees);

/// Covariance that the noise makes between the means a and b of two bins with these times.
double noise_between(const SampleSeries& series, const Row& a, const std::vector<double>& times_a, const Row& b,
                     const std::vector<double>& times_b);

/// Covariance between the rows, one a bin with these times: noise, and where the repeats scatter more, that excess. Sets `u` of the rows
/// that have an excess.
Eigen::MatrixXd covariance_of_bins(const SampleSeries& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times);

}  // namespace snag
