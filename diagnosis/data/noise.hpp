#pragma once
// Noise of the samples of an observable, learnt from its repeats: by what factor it is larger than noise_u says, and how long it lasts.
//
//   e(t) ~ N(0, (F u)^2),   correlation exp(-|t - t'|/tau)
//
// F, tau: one pair for all operating points of training. The differences between R repeats at the same times are R - 1 independent series
// of such a process, whose likelihood needs no model of the experiment. Priors: log F uniform from ln 1e-4 to ln 10; tau = 0 with
// probability 1/2, else log tau uniform from half a sampling step to the duration. What is stated (F = 1, tau = 0) stands unless the
// repeats speak for another noise by 6 nats; a factor below 1 is not used. Scatter that grows or decays along the path, or that is ten
// times as large as stated, is no noise of an instrument: it is left to summary.hpp. Rows that are means of several repeats are not used:
// they do not contain how long the deviation of one repeat lasts.
#include <vector>

#include "diagnosis/data/experiment.hpp"

namespace snag {

struct NoiseModel {
  double factor = 1;            // F, over noise_u
  double correlation_time = 0;  // tau, s; 0: samples are independent
  double nats = 0;              // by which the repeats speak for it; 0: as stated
  double scatter = 0;           // standard deviation of the repeats over noise_u, if ten or more: not noise of an instrument; else 0
  double correlation(double apart) const;
};

/// By observable.
std::vector<NoiseModel> noise_of_repeats(const Experiment& experiment);

}  // namespace snag
