#include "diagnosis/data/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/data/noise.hpp"
#include "diagnosis/data/repeats_of_row.hpp"
#include "diagnosis/statistics/lifetimes.hpp"
#include "diagnosis/statistics/statistics.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

using Kind = Observable::Kind;

double transformed(const Observable& observable, double value) { return observable.kind == Kind::lognormal ? std::log(value) : value; }

// A sample of a path, or the mean of several (transformed).
struct Sample {
  double value = 0, sd = 0;  // sd: between them; 0: not given, noise_u is used
  int n = 1;
};

// What all repeats at one time have together.
struct Instant {
  int n = 0;                    // repeats
  double mean = 0, square = 0;  // sum of their squared deviations from it
  bool scatter_is_known = true;
};

// The samples of one observable at one point, by time and replicate.
struct Series {
  const Observable* observable;
  const NoiseModel* noise;
  int observable_index = 0;
  std::map<int, int> replicates;                    // name -> 0 ..
  std::map<double, std::map<int, Sample>> samples;  // time -> replicate -> sample
  bool has_means = false;                           // some rows stand for several repeats: how long a deviation lasts is not known

  std::map<double, Instant> instants;

  double noise_u() const { return noise->factor * observable->noise_u; }

  // To be called after the last sample was added.
  void sum_up() {
    for (const auto& [time, there] : samples) instants[time] = sum_of(there);
  }

  Instant sum_of(const std::map<int, Sample>& there) const {
    Instant all;
    for (const auto& [replicate, sample] : there) all.n += sample.n, all.mean += sample.n * sample.value;
    all.mean /= all.n;
    for (const auto& [replicate, sample] : there) {
      const double sd = sample.sd > 0 ? sample.sd : noise_u();
      all.square += (sample.n - 1) * sd * sd + sample.n * (sample.value - all.mean) * (sample.value - all.mean);
      all.scatter_is_known = all.scatter_is_known && (sample.n == 1 || sample.sd > 0);
    }
    return all;
  }

  // Of n samples of correlated noise the variance is as uncertain as that of n times this share independent samples, n/sum over i, j of
  // r_ij^2, r their correlation: the variance of a sum of squares of Gaussian numbers is 2 sum r_ij^2.
  double independent_share(const std::vector<double>& times) const {
    double correlated = 0;
    for (const double a : times)
      for (const double b : times) correlated += std::pow(noise->correlation(a - b), 2);
    return static_cast<double>(times.size()) / correlated;
  }
};

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

// By what a variance from this many degrees of freedom is multiplied so that a normal law with it is as wide as Student's.
double factor_of_few(double degrees) { return degrees > 3 ? degrees / (degrees - 2) : 3; }

class PointSummarizer {
 public:
  PointSummarizer(const Experiment& experiment, const std::vector<NoiseModel>& noise, const Simulator& simulator, int point, bool spread,
                  int max_bins)
      : experiment_(experiment), noise_(noise), spread_(spread), max_bins_(max_bins) {
    result_.point = point;
    const auto& slots = simulator.slots(point);
    for (std::size_t s = 0; s < slots.size(); ++s) slots_.emplace(key(slots[s].observable, slots[s].time), static_cast<int>(s));
  }

  PointSummary summarize(std::span<const Datum> data) {
    for (std::size_t begin = 0; begin < data.size();) {
      std::size_t end = begin;
      while (end < data.size() && data[end].observable == data[begin].observable) ++end;
      add_observable(data.subspan(begin, end - begin));
      begin = end;
    }
    const auto gaussian_first = [](const Row& a, const Row& b) { return is_gaussian(a) && !is_gaussian(b); };
    std::stable_sort(result_.rows.begin(), result_.rows.end(), gaussian_first);
    for (const Row& row : result_.rows) result_.n_gaussian += is_gaussian(row);
    result_.covariance = Eigen::MatrixXd::Zero(result_.n_gaussian, result_.n_gaussian);
    int at = 0;
    for (const Eigen::MatrixXd& block : blocks_) {
      result_.covariance.block(at, at, block.rows(), block.cols()) = block;
      at += static_cast<int>(block.rows());
    }
    return std::move(result_);
  }

 private:
  // Times are compared to a nanosecond.
  static std::pair<int, long long> key(int observable, double time) {
    return {observable, std::isnan(time) ? std::numeric_limits<long long>::min() : std::llround(time * 1e9)};
  }

  int slot(int observable, double time) const {
    const auto found = slots_.find(key(observable, time));
    if (found == slots_.end())
      throw Error(ExitCode::usage, "point \"" + experiment_.points[result_.point].id + "\": no run can provide " +
                                       experiment_.observables[observable].id +
                                       (std::isnan(time) ? "" : " at t = " + number_text(time) + " s") +
                                       "; remove it from the data, or extend the run of the case");
    return found->second;
  }

  void add_observable(std::span<const Datum> data) {
    const Observable& observable = experiment_.observables[data[0].observable];
    if (!std::isnan(data[0].time))
      add_series(data, observable);
    else
      add_scalar(data, observable);
  }

  void add_scalar(std::span<const Datum> data, const Observable& observable) {
    Row row;
    row.observable = data[0].observable;
    row.begin = row.end = std::numeric_limits<double>::quiet_NaN();
    row.slots = {slot(row.observable, row.begin)};
    row.weights = {1};
    const double period = angle_period(observable);
    for (const Datum& d : data) {
      double value = transformed(observable, d.value);
      if (observable.kind == Kind::angle && !row.values.empty()) value = row.values[0] + wrapped(value - row.values[0], period);
      row.values.push_back(value);
      row.censored.push_back(d.censored);
    }
    const int n = row.n_replicates = static_cast<int>(data.size());
    double mean = 0, square = 0;
    for (const double v : row.values) mean += v / n;
    for (const double v : row.values) square += (v - mean) * (v - mean);
    const double variance = n > 1 ? square / (n - 1) : 0;
    row.value = mean, row.noise_u = observable.noise_u;
    switch (observable.kind) {
      case Kind::count:
        row.kind = Row::Kind::count;
        row.sigma = n > 2 && mean > 0 ? std::max(1.0, variance / mean) : 1;
        row.u = std::sqrt(std::max(mean, 0.5) * row.sigma / n);
        break;
      case Kind::event:
        row.kind = Row::Kind::event;
        row.u = std::sqrt((mean * n + 0.5) * (n - mean * n + 0.5) / (n + 1.0)) / (n + 1);
        break;
      case Kind::lognormal: {
        row.kind = Row::Kind::time;
        const LogTimes fitted = fit_log_times(row.values, row.censored, observable.noise_u);
        row.value = fitted.mean, row.sigma = fitted.sigma, row.u = fitted.u_mean;
        break;
      }
      default:
        row.kind = Row::Kind::scalar;
        row.u = std::sqrt(variance_of_scatter(variance, n, observable.noise_u) / n);
        row.means = {mean}, blocks_.push_back(Eigen::MatrixXd::Constant(1, 1, row.u * row.u));
    }
    if (row.kind == Row::Kind::scalar) row.sigma = row.u * std::sqrt(n);
    result_.rows.push_back(std::move(row));
  }

  // Variance of one replicate: the stated noise unless the replicates scatter more; without a stated noise with room for few replicates.
  static double variance_of_scatter(double sample, int n, double noise_u) {
    const double stated = noise_u * noise_u;
    if (stated == 0) return sample * factor_of_few(n - 1);
    return n > 1 && chi_squared_tail((n - 1) * sample / stated, n - 1) < 0.01 ? sample : stated;
  }

  void add_series(std::span<const Datum> data, const Observable& observable) {
    Series series{&observable, &noise_[static_cast<std::size_t>(data[0].observable)], data[0].observable, {}, {}, false, {}};
    const double period = angle_period(observable);
    for (const Datum& d : data) {
      const int replicate = series.replicates.emplace(d.replicate, static_cast<int>(series.replicates.size())).first->second;
      auto& at = series.samples[d.time];
      MeanAndSd sample{.mean = d.value, .sd = d.sd};
      if (observable.kind == Kind::lognormal) sample = of_logarithm(sample);
      if (observable.kind == Kind::angle && !at.empty())
        sample.mean = at.begin()->second.value + wrapped(d.value - at.begin()->second.value, period);
      at[replicate] = {.value = sample.mean, .sd = sample.sd, .n = d.n};
      series.has_means = series.has_means || d.n > 1;
    }
    series.sum_up();
    const int n_times = static_cast<int>(series.samples.size()), n_bins = std::min(max_bins_, n_times);
    std::vector<std::vector<double>> times(n_bins);
    int k = 0;
    for (const auto& [time, at] : series.samples) times[static_cast<long long>(k++) * n_bins / n_times].push_back(time);
    std::vector<Row> rows;
    for (const auto& bin : times) rows.push_back(path_row(series, bin));
    result_.duration = std::max(result_.duration, series.samples.rbegin()->first - std::min(0.0, series.samples.begin()->first));
    blocks_.push_back(series.has_means ? covariance_of_means(series, rows, times) : series_covariance(series, rows, times));
    if (spread_ && observable.noise_u > 0) add_spread(series, times);
    for (Row& row : rows) result_.rows.push_back(std::move(row));
  }

  Row path_row(const Series& series, const std::vector<double>& times) const {
    Row row;
    row.observable = series.observable_index;
    row.begin = times.front(), row.end = times.back();
    row.noise_u = series.noise_u();
    double samples = 0;
    for (const double time : times) samples += series.instants.at(time).n;
    row.n_replicates = std::max(1, static_cast<int>(std::lround(samples / static_cast<double>(times.size()))));
    for (const double time : times) {
      const Instant& at = series.instants.at(time);
      row.slots.push_back(slot(row.observable, time));
      row.weights.push_back(at.n / samples);
      row.means.push_back(at.mean);
      row.value += row.weights.back() * at.mean;
    }
    row.u = std::sqrt(noise_between(series, row, times, row, times));
    return row;
  }

  // Covariance that the noise makes between the means of two bins. Of the repeats at two times the fewer are among the more.
  static double noise_between(const Series& series, const Row& a, const std::vector<double>& times_a, const Row& b,
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

  // The replicates in the bins, [bins] x [replicates].
  struct Presence {
    Eigen::MatrixXd deviation;  // mean over a bin of a replicate's deviation from the mean of all; NaN where it has no sample
    Eigen::MatrixXd share;      // of the samples of the bin
  };

  static Presence presence(const Series& series, const std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(rows), std::ssize(series.replicates)), count = sum;
    for (std::size_t bin = 0; bin < rows.size(); ++bin)
      for (std::size_t k = 0; k < times[bin].size(); ++k)
        for (const auto& [replicate, sample] : series.samples.at(times[bin][k])) {
          sum(static_cast<Eigen::Index>(bin), replicate) += sample.value - rows[bin].means[k];
          count(static_cast<Eigen::Index>(bin), replicate) += 1;
        }
    return {sum.cwiseQuotient(count), count.rowwise().sum().cwiseInverse().asDiagonal() * count};
  }

  // Of means of several repeats the variances at each time are known, but not how they are correlated. Noise/n, and where the repeats
  // scatter more, that excess/n, is taken as independent from time to time.
  static Eigen::MatrixXd covariance_of_means(const Series& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
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
    const bool as_stated = stated > 0 && (degrees == 0 || square / (stated * degrees) <
                                                              1 + 3.1 * std::sqrt(2 / (degrees * series.independent_share(instants))));
    Eigen::MatrixXd C = noise_of_bins(series, rows, times);
    for (Eigen::Index i = 0; i < n && !as_stated; ++i) {
      const BinVariances::Mean mean = scatter.around(i);
      C(i, i) += share[i] * std::max(0.0, mean.variance * (stated > 0 ? 1 : factor_of_few(mean.degrees)) - stated);
      rows[static_cast<std::size_t>(i)].u = std::sqrt(C(i, i));
    }
    return C;
  }

  static Eigen::MatrixXd noise_of_bins(const Series& series, const std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
    const int n = static_cast<int>(rows.size());
    Eigen::MatrixXd C(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) C(i, j) = C(j, i) = noise_between(series, rows[i], times[i], rows[j], times[j]);
    return C;
  }

  // Noise/n and, where replicates scatter more than their noise, that excess: its variance from bin to bin, correlated as
  // exp(-|t - t'|/tau). Both are divided by the number of replicates in the bins.
  static Eigen::MatrixXd series_covariance(const Series& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
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

  // After the last bin in which it is known, the root of the excess grows on along the line through the bins where it is known: repeats
  // that go at different speeds part at a rate.
  static void grow_on(Eigen::VectorXd& excess, const BinVariances& beyond_noise, const std::vector<Row>& rows) {
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
  static Product product(const Eigen::MatrixXd& D, int i, int j) {
    double sum = 0;
    int n = 0;
    for (int r = 0; r < D.cols(); ++r)
      if (std::isfinite(D(i, r)) && std::isfinite(D(j, r))) sum += D(i, r) * D(j, r), ++n;
    return n > 1 ? Product{sum / (n - 1), n - 1.0} : Product{};
  }

  // Variance between three replicates or more, in three parts of the time, where the noise alone has a known one.
  void add_spread(const Series& series, const std::vector<std::vector<double>>& times) {
    const int parts = std::min<int>(3, static_cast<int>(times.size()));
    for (int part = 0; part < parts; ++part) {
      Row row;
      row.kind = Row::Kind::spread;
      row.observable = series.observable_index;
      row.noise_u = series.noise_u();
      double square = 0, degrees = 0;
      std::vector<double> instants;
      const std::size_t begin = part * times.size() / parts, end = (part + 1) * times.size() / parts;
      row.begin = times[begin].front(), row.end = times[end - 1].back();
      for (std::size_t b = begin; b < end; ++b) {
        for (const double time : times[b]) {
          const Instant& at = series.instants.at(time);
          if (at.n < 2 || !at.scatter_is_known) continue;
          square += at.square, degrees += at.n - 1;
          row.n_replicates = std::max(row.n_replicates, at.n);
          instants.push_back(time);
          row.slots.push_back(slot(row.observable, time));
        }
      }
      if (row.n_replicates < 3 || degrees < 2 || square <= 0) continue;
      row.weights.assign(row.slots.size(), 1.0 / static_cast<double>(row.slots.size()));
      const double independent = degrees * series.independent_share(instants);
      row.value = std::log(square / degrees), row.sigma = independent, row.u = std::sqrt(2 / independent);
      result_.rows.push_back(std::move(row));
    }
  }

  const Experiment& experiment_;
  const std::vector<NoiseModel>& noise_;  // by observable
  bool spread_;
  int max_bins_;
  std::map<std::pair<int, long long>, int> slots_;
  PointSummary result_;
  std::vector<Eigen::MatrixXd> blocks_;  // of the covariance, one a Gaussian observable, in the order of the rows
};

}  // namespace

double angle_period(const Observable& observable) {
  const ObservableRecord* record = find_observable(observable.id);
  return record && record->period() > 0 ? record->period() : 2 * std::numbers::pi;
}

double wrapped(double difference, double period) { return difference - period * std::round(difference / period); }

std::vector<PointSummary> summarize(const Experiment& experiment, const Simulator& simulator, bool spread, int max_bins) {
  std::vector<PointSummary> summaries;
  const std::vector<NoiseModel> noise = noise_of_repeats(experiment);
  const std::span<const Datum> data(experiment.data);
  std::size_t begin = 0;
  for (int p = 0; p < static_cast<int>(experiment.points.size()); ++p) {
    std::size_t end = begin;
    while (end < data.size() && data[end].point == p) ++end;
    summaries.push_back(PointSummarizer(experiment, noise, simulator, p, spread, max_bins).summarize(data.subspan(begin, end - begin)));
    begin = end;
  }
  return summaries;
}

}  // namespace snag
