#pragma once
// The gap on withheld operating points beyond what noise makes, and how far it shrinks:
//
//   G = max(0, mean over the rows of (E^2 - u_noise^2)/u_D^2),   shrinkage = 1 - G_after/G_before
#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "diagnosis/data/verdict.hpp"

namespace snag {

/// What one hypothesis leaves at the withheld points, by point: E over u_D by row, and how it moves with what is uncertain.
struct WithheldError {
  std::vector<Eigen::VectorXd> error;        // (model - data)/u_D, inputs fitted
  std::vector<Eigen::MatrixXd> covariance;   // of it when nothing is missing
  std::vector<Eigen::MatrixXd> noise;        // its factor
  std::vector<Eigen::MatrixXd> projection;   // what the fit of the inputs leaves of an error
  std::vector<Eigen::MatrixXd> by_strength;  // (d model)/u_D per posterior standard deviation of a strength, inputs fitted again
  Eigen::MatrixXd strength_factor;           // of their posterior correlation
};

/// G over all points, in units of u_D^2 per row.
double excess_gap(const WithheldError& error);
/// What noise alone makes of the mean square, in the same units.
double noise_floor(const WithheldError& error);

/// G that noise alone exceeds in one of twenty experiments.
double excess_of_noise(const WithheldError& error, std::uint64_t seed);

/// With its 95 % interval by a nested bootstrap: points with replacement, and within each what the fit leaves open and another realisation
/// of the noise, the same before and after. NaN where the gap before is not beyond what noise makes: nothing is there that could shrink.
Shrinkage shrinkage(const WithheldError& before, const WithheldError& after, std::uint64_t seed);

}  // namespace snag
