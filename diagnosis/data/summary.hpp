#pragma once
// What of the data is compared with runs: per operating point a vector of rows. A row is
//   path       mean over the replicates and a bin of time of a quantity that varies smoothly (angles wrap, lognormal ones are logarithms);
//   scalar     mean over the replicates of a scalar;
//   time       median of a lognormal scalar, some of whose values may be censored;
//   count      sum of counts;     event      number of events;
//   spread     logarithm of the variance between replicates in a part of the time, where effects are random.
// The noise of paths is as stated, or as the repeats show it (noise.hpp). Path, scalar rows are Gaussian together, with the covariance
// `covariance`; the others have a likelihood of their own, whose signed deviance residual stands for them.
#include <Eigen/Dense>
#include <vector>

#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

struct Row {
  enum class Kind { path, scalar, time, count, event, spread };
  Kind kind = Kind::path;
  int observable = 0;
  double begin = 0, end = 0;      // s; NaN for scalars of a replicate
  std::vector<int> slots{};       // of the simulator's answer
  std::vector<double> weights{};  // of the slots, sum 1
  std::vector<double> means{};    // over the replicates, by slot (path); wrapped around the first replicate
  std::vector<double> values{};   // by replicate (scalar, time, count, event); logarithms for time
  std::vector<bool> censored{};   // by replicate (time)
  double value = 0;               // the row's number: mean, log-median, mean count, fraction, log-variance
  double u = 0;                   // its standard uncertainty from noise and scatter
  double noise_u = 0;             // of one sample (spread: standard deviation that the noise alone gives)
  double sigma = 0;               // of one replicate's logarithm (time); overdispersion (count)
  int n_replicates = 0;           // of a path the mean number at its times, of a spread the largest number at one time, else of values
};

/// True for the rows that are Gaussian together.
inline bool is_gaussian(const Row& row) { return row.kind == Row::Kind::path || row.kind == Row::Kind::scalar; }

struct PointSummary {
  int point = 0;
  std::vector<Row> rows;  // Gaussian ones first
  int n_gaussian = 0;
  Eigen::MatrixXd covariance;  // of the Gaussian rows: noise and scatter between replicates over their number
  double duration = 0;         // s, of the measured paths
};

/// Period of an angle: an axis (orientation) comes back after half a turn.
double angle_period(const Observable& observable);
/// The difference nearest to zero.
double wrapped(double difference, double period);

/// Rows of the points of the experiment, at most `max_bins` of time a series. `spread`: with rows of the spread where there are three
/// replicates and a noise_u. Throws Error(usage) where the simulator has no slot for a datum.
std::vector<PointSummary> summarize(const Experiment& experiment, const Simulator& simulator, bool spread, int max_bins = 20);

/// Signed deviance residual of a row with a likelihood of its own, for the model's mean (rate, probability, log-median, variance over
/// seeds) from n_runs runs that scatter with this variance.
double deviance_residual(const Row& row, double model, int n_runs, double scatter);
/// Variance of the row under this model over that of the data alone (time, spread; the others: 1). The likelihood of the row is
/// exp(-residual^2/2) over the square root of it.
double variance_ratio(const Row& row, double model, int n_runs, double scatter);

}  // namespace snag
