#pragma once
// The measurement that would separate two hypotheses best: Hunter and Reiner's T, the squared difference of their predictions over the
// covariance of more replicates and of the inputs,
//
//   T(n) = d . (C_noise/n + C_common)^-1 d,   C_common: inputs, biases and error of the step, which no repeat makes smaller.
//
// Where no effect explains the data: where to look.
#include <string>

#include "diagnosis/attribution/attribution.hpp"

namespace snag {

/// What two hypotheses predict of the rows of a point, before the noise of a measurement.
struct Predictions {
  Eigen::VectorXd difference, numerical_error;
  std::vector<Eigen::VectorXd> by_input{};  // changes by one standard uncertainty of each input
  Eigen::VectorXd chance{};                 // variance that the seeds of the runs give the difference; empty: none
};

/// T of more repeats.
struct Separation {
  double T = 0;
  std::string observable, point;
  double time = 0;  // s, where the predictions differ most; NaN for a scalar
};

/// Of the Gaussian observable that separates them best, at a point of training.
Separation best_separation(const Responses& model, std::size_t training_point, const Predictions& predictions, int n_repeats = 1);
/// T of one more repeat where it tells most.
double best_repeat(const Responses& model, const Fit& a, const Fit& b);
/// The likeliest fit beside this one; -1 if there is none.
int rival_of(const Attribution& attribution, int fit);

/// In a sentence: which observable at which point and when, and how many replicates; empty where there is nothing to separate.
std::string next_experiment(const Responses& model, const Attribution& attribution, bool unexplained);

}  // namespace snag
