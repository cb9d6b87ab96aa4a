#include "diagnosis/data/sample_series.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {

Instant sum_of(const SampleSeries& series, const std::map<int, Sample>& there) {
  Instant all;
  for (const auto& [replicate, sample] : there) all.n += sample.n, all.mean += sample.n * sample.value;
  all.mean /= all.n;
  for (const auto& [replicate, sample] : there) {
    const double sd = sample.sd > 0 ? sample.sd : series.noise_u();
    all.square += (sample.n - 1) * sd * sd + sample.n * (sample.value - all.mean) * (sample.value - all.mean);
    all.scatter_is_known = all.scatter_is_known && (sample.n == 1 || sample.sd > 0);
  }
  return all;
}

// Variances of one repeat, bin by bin, with the degrees of freedom that each is known with.
struct BinVariances {
  Eigen::VectorXd variance, degrees;

  struct Mean {
    double variance = 0;
    double degrees = 0, of_best_bin = 0;  // degrees of freedom of the bins together, and of that which has most
  };

  bool is_known(Eigen::Index bin) const { return degrees[bin] > 0 && 2 * degrees[bin] >= degrees.maxCoeff(); }

  // Mean over the five bins around this one, of those that have at least half as many degrees of freedom as the best bin. Where fewer than
  // three of them have, as where most repeats have ended, it is over the nearest three that have.
  Mean around(Eigen::Index bin) const {
    constexpr int fewest = 3;
    const Eigen::Index n = variance.size();
    for (Eigen::Index reach = 2;; ++reach) {
      const Eigen::Index begin = std::max<Eigen::Index>(0, bin - reach), end = std::min(n, bin + reach + 1);
      Mean mean;
      int known = 0;
      for (Eigen::Index i = begin; i < end; ++i) {
        if (!is_known(i)) continue;
        ++known, mean.variance += degrees[i] * variance[i], mean.degrees += degrees[i];
        mean.of_best_bin = std::max(mean.of_best_bin, degrees[i]);
      }
      if (known < fewest && end - begin < n) continue;
      if (known > 0) mean.variance /= mean.degrees;
      return mean;
    }
  }
};

// The replicates in the bins, [bins] x [replicates].
struct Presence {
  Eigen::MatrixXd deviation;  // mean over a bin of a replicate's deviation from the mean of all; NaN where it has no sample
  Eigen::MatrixXd share;      // of the samples of the bin
};

Presence presence(const SampleSeries& series, const std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(rows), std::ssize(series.replicates)), count = sum;
  for (std::size_t bin = 0; bin < rows.size(); ++bin)
    for (std::size_t k = 0; k < times[bin].size(); ++k)
      for (const auto& [replicate, sample] : series.samples.at(times[bin][k])) {
        sum(static_cast<Eigen::Index>(bin), replicate) += sample.value - rows[bin].means[k];
        count(static_cast<Eigen::Index>(bin), replicate) += 1;
      }
  return {sum.cwiseQuotient(count), count.rowwise().sum().cwiseInverse().asDiagonal() * count};
}

Eigen::MatrixXd noise_of_bins(const SampleSeries& series, const std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
  const int n = static_cast<int>(rows.size());
  Eigen::MatrixXd C(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) C(i, j) = C(j, i) = noise_between(series, rows[i], times[i], rows[j], times[j]);
  return C;
}

// Of means of several repeats the variances at each time are known, but not how they are correlated. Noise/n, and where the repeats
// scatter more, that excess/n, is taken as independent from time to time.
Eigen::MatrixXd covariance_of_means(const SampleSeries& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
  const auto n = std::ssize(rows);
  const double stated = series.noise_u() * series.noise_u();
  BinVariances scatter{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd share = Eigen::VectorXd::Zero(n);  // of the variance of one repeat that the mean over the bin has
  double square = 0;
  std::vector<double> instants;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto bin = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < times[bin].size(); ++k) {
      const Instant& at = series.instants.at(times[bin][k]);
      share[i] += rows[bin].weights[k] * rows[bin].weights[k] / at.n;
      if (at.n < 2 || !at.scatter_is_known) continue;
      scatter.variance[i] += at.square, scatter.degrees[i] += at.n - 1;
      instants.push_back(times[bin][k]);
    }
    square += scatter.variance[i];
    if (scatter.degrees[i] > 0) scatter.variance[i] /= scatter.degrees[i];
  }
  const double degrees = scatter.degrees.sum();
  const bool as_stated =
      stated > 0 && (degrees == 0 || square / (stated * degrees) < 1 + 3.1 * std::sqrt(2 / (degrees * series.independent_share(instants))));
  Eigen::MatrixXd C = noise_of_bins(series, rows, times);
  for (Eigen::Index i = 0; i < n && !as_stated; ++i) {
    const BinVariances::Mean mean = scatter.around(i);
    C(i, i) += share[i] * std::max(0.0, mean.variance * (stated > 0 ? 1 : factor_of_few(mean.degrees)) - stated);
    rows[static_cast<std::size_t>(i)].u = std::sqrt(C(i, i));
  }
  return C;
}

// After the last bin in which it is known, the root of the excess grows on along the line through the bins where it is known: repeats
// that go at different speeds part at a rate.
void grow_on(Eigen::VectorXd& excess, const BinVariances& beyond_noise, const std::vector<Row>& rows) {
  const Eigen::Index n = excess.size();
  const auto time = [&](Eigen::Index i) { return rows[static_cast<std::size_t>(i)].begin; };
  const auto root = [&](Eigen::Index i) { return std::sqrt(std::max(0.0, beyond_noise.variance[i])); };
  double known = 0, mean_time = 0, mean_root = 0, both = 0, own = 0;
  Eigen::Index last = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (beyond_noise.is_known(i)) ++known, mean_time += time(i), mean_root += root(i), last = i;
  mean_time /= known, mean_root /= known;
  for (Eigen::Index i = 0; i < n; ++i)
    if (beyond_noise.is_known(i))
      both += (time(i) - mean_time) * (root(i) - mean_root), own += (time(i) - mean_time) * (time(i) - mean_time);
  const double rate = own > 0 ? both / own : 0;
  for (Eigen::Index i = last + 1; i < n && rate > 0; ++i)
    excess[i] = std::max(excess[i], std::pow(mean_root + rate * (time(i) - mean_time), 2));
}

struct Product {
  double mean = 0, degrees = 0;
};

// Mean over the replicates of the product of deviations in two bins.
Product product(const Eigen::MatrixXd& D, int i, int j) {
  double sum = 0;
  int n = 0;
  for (int r = 0; r < D.cols(); ++r)
    if (std::isfinite(D(i, r)) && std::isfinite(D(j, r))) sum += D(i, r) * D(j, r), ++n;
  return n > 1 ? Product{sum / (n - 1), n - 1.0} : Product{};
}

// Noise/n and, where replicates scatter more than their noise, that excess: its variance from bin to bin, correlated as
// exp(-|t - t'|/tau). Both are divided by the number of replicates in the bins.
Eigen::MatrixXd covariance_of_repeats(const SampleSeries& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
  const int n = static_cast<int>(rows.size()), R = static_cast<int>(series.replicates.size());
  Eigen::MatrixXd C = noise_of_bins(series, rows, times);
  if (R < 2) return C;
  const auto [deviation, share] = presence(series, rows, times);
  const Eigen::MatrixXd together = share * share.transpose();  // 1/n of what n replicates have in both bins
  BinVariances scatter{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  double ratio = 0;
  const bool stated = series.observable->noise_u > 0;
  for (int i = 0; i < n; ++i) {
    const Product own = product(deviation, i, i);
    const double noise = C(i, i) / together(i, i);  // of one replicate
    scatter.variance[i] = own.mean, scatter.degrees[i] = own.degrees;
    ratio += stated ? own.degrees * own.mean / noise : 0;
  }
  if (scatter.degrees.sum() == 0) return C;
  ratio /= scatter.degrees.sum();
  BinVariances beyond_noise = scatter;
  beyond_noise.variance -= C.diagonal().cwiseQuotient(together.diagonal());
  const double next_bin = n > 1 ? C(0, 1) / std::sqrt(C(0, 0) * C(1, 1)) : 0;  // as many bins are independent as so correlated ones tell
  const double independent = std::max(1.0, n * (1 - next_bin * next_bin) / (1 + next_bin * next_bin));
  if (stated && ratio < 1 + 3.1 * std::sqrt(2.0 * n / (scatter.degrees.sum() * independent))) return C;
  Eigen::VectorXd excess(n);
  for (int i = 0; i < n; ++i) excess[i] = std::max(0.0, beyond_noise.around(i).variance);
  grow_on(excess, beyond_noise, rows);
  for (int i = 0; i < n && !stated; ++i) excess[i] *= factor_of_few(beyond_noise.around(i).of_best_bin);
  double next = 0, own = 0;  // sums over neighbours that have two replicates or more
  for (int i = 0; i + 1 < n; ++i)
    if (const Product both = product(deviation, i, i + 1); both.degrees > 0) next += both.mean, own += excess[i];
  const double step = n > 1 ? (rows.back().begin - rows.front().begin) / (n - 1) : 1;
  const double correlation = n > 1 ? std::clamp(next / std::max(own, 1e-300), 0.03, 0.999) : 0.03;
  const double tau = -step / std::log(correlation);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      C(i, j) += std::sqrt(excess[i] * excess[j]) * std::exp(-std::abs(rows[i].begin - rows[j].begin) / tau) * together(i, j);
    rows[i].u = std::sqrt(std::max(C(i, i), 1e-300));
  }
  return C;
}

}  // namespace

void SampleSeries::sum_up() {
  for (const auto& [time, there] : samples) instants[time] = sum_of(*this, there);
}

double SampleSeries::independent_share(const std::vector<double>& times) const {
  double correlated = 0;
  for (const double a : times)
    for (const double b : times) correlated += std::pow(noise->correlation(a - b), 2);
  return static_cast<double>(times.size()) / correlated;
}

double factor_of_few(double degrees) { return degrees > 3 ? degrees / (degrees - 2) : 3; }

// Of the repeats at two times the fewer are among the more.
double noise_between(const SampleSeries& series, const Row& a, const std::vector<double>& times_a, const Row& b,
                     const std::vector<double>& times_b) {
  double sum = 0;
  for (std::size_t i = 0; i < times_a.size(); ++i)
    for (std::size_t j = 0; j < times_b.size(); ++j) {
      const double correlation = series.noise->correlation(times_a[i] - times_b[j]);
      if (correlation == 0) continue;
      sum += a.weights[i] * b.weights[j] * correlation / std::max(series.instants.at(times_a[i]).n, series.instants.at(times_b[j]).n);
    }
  return a.noise_u * b.noise_u * sum;
}

Eigen::MatrixXd covariance_of_bins(const SampleSeries& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
  return series.has_means ? covariance_of_means(series, rows, times) : covariance_of_repeats(series, rows, times);
}

}  // namespace snag
