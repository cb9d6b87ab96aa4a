#pragma once
// Lognormal times, some of them censored from the right: tests that ended before the event.
#include <vector>

namespace snag {

struct LogTimes {
  double mean = 0, sigma = 0;  // of the logarithm
  double u_mean = 0;           // infinite when every time is censored
};

/// Maximum likelihood; sigma at least `minimum_sigma`, and where fewer than two times are known 0.5 (a factor 1.6) if that is larger.
LogTimes fit_log_times(const std::vector<double>& log_times, const std::vector<bool>& censored, double minimum_sigma);
double log_likelihood_of_times(const std::vector<double>& log_times, const std::vector<bool>& censored, double mean, double sigma);

}  // namespace snag
