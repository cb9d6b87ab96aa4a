#include "diagnosis/data/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/data/noise.hpp"
#include "diagnosis/statistics/lifetimes.hpp"
#include "diagnosis/statistics/statistics.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

using Kind = Observable::Kind;

double transformed(const Observable& observable, double value) { return observable.kind == Kind::lognormal ? std::log(value) : value; }

// The samples of one observable at one point, by time and replicate.
struct Series {
  const Observable* observable;
  const NoiseModel* noise;
  int observable_index = 0;
  std::map<int, int> replicates;                  // name -> 0 ..
  std::map<double, std::map<int, double>> value;  // time -> replicate -> value (transformed)
};

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
    if (stated == 0) return sample * (n > 3 ? (n - 1.0) / (n - 3.0) : 3);
    return n > 1 && chi_squared_tail((n - 1) * sample / stated, n - 1) < 0.01 ? sample : stated;
  }

  void add_series(std::span<const Datum> data, const Observable& observable) {
    Series series{&observable, &noise_[static_cast<std::size_t>(data[0].observable)], data[0].observable, {}, {}};
    const double period = angle_period(observable);
    for (const Datum& d : data) {
      const int replicate = series.replicates.emplace(d.replicate, static_cast<int>(series.replicates.size())).first->second;
      auto& at = series.value[d.time];
      double value = transformed(observable, d.value);
      if (observable.kind == Kind::angle && !at.empty()) value = at.begin()->second + wrapped(value - at.begin()->second, period);
      at[replicate] = value;
    }
    const int n_times = static_cast<int>(series.value.size()), n_bins = std::min(max_bins_, n_times);
    std::vector<std::vector<double>> times(n_bins);
    int k = 0;
    for (const auto& [time, at] : series.value) times[static_cast<long long>(k++) * n_bins / n_times].push_back(time);
    std::vector<Row> rows;
    for (const auto& bin : times) rows.push_back(path_row(series, bin));
    result_.duration = std::max(result_.duration, series.value.rbegin()->first - std::min(0.0, series.value.begin()->first));
    blocks_.push_back(series_covariance(series, rows, times));
    if (spread_ && series.replicates.size() >= 3 && observable.noise_u > 0) add_spread(series, times);
    for (Row& row : rows) result_.rows.push_back(std::move(row));
  }

  Row path_row(const Series& series, const std::vector<double>& times) const {
    Row row;
    row.observable = series.observable_index;
    row.begin = times.front(), row.end = times.back();
    row.noise_u = series.noise->factor * series.observable->noise_u;
    row.n_replicates = static_cast<int>(series.replicates.size());
    double samples = 0;
    for (const double time : times) samples += static_cast<double>(series.value.at(time).size());
    for (const double time : times) {
      const auto& at = series.value.at(time);
      double mean = 0;
      for (const auto& [replicate, value] : at) mean += value / static_cast<double>(at.size());
      row.slots.push_back(slot(row.observable, time));
      row.weights.push_back(static_cast<double>(at.size()) / samples);
      row.means.push_back(mean);
      row.value += row.weights.back() * mean;
    }
    row.u = std::sqrt(noise_between(series, row, times, row, times));
    return row;
  }

  // Covariance that the noise makes between the means of two bins.
  static double noise_between(const Series& series, const Row& a, const std::vector<double>& times_a, const Row& b,
                              const std::vector<double>& times_b) {
    double sum = 0;
    for (std::size_t i = 0; i < times_a.size(); ++i)
      for (std::size_t j = 0; j < times_b.size(); ++j) {
        const double correlation = series.noise->correlation(times_a[i] - times_b[j]);
        if (correlation == 0) continue;
        const std::size_t most = std::max(series.value.at(times_a[i]).size(), series.value.at(times_b[j]).size());
        sum += a.weights[i] * b.weights[j] * correlation / static_cast<double>(most);
      }
    return a.noise_u * b.noise_u * sum;
  }

  // Mean over a bin of each replicate's deviation from the mean of all: [bins] x [replicates], NaN where a replicate has no sample.
  static Eigen::MatrixXd deviations(const Series& series, const std::vector<Row>& rows, const std::vector<double>& all_times) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows.size(), series.replicates.size()), count = sum;
    std::size_t bin = 0, in_bin = 0;
    for (const double time : all_times) {
      if (in_bin == rows[bin].slots.size()) ++bin, in_bin = 0;
      for (const auto& [replicate, value] : series.value.at(time)) {
        sum(bin, replicate) += value - rows[bin].means[in_bin];
        count(bin, replicate) += 1;
      }
      ++in_bin;
    }
    return sum.cwiseQuotient(count);
  }

  static std::vector<double> all_times(const Series& series) {
    std::vector<double> times;
    for (const auto& [time, at] : series.value) times.push_back(time);
    return times;
  }

  // Noise/n and, where replicates scatter more than their noise, that excess: its variance from bin to bin, correlated as
  // exp(-|t - t'|/tau).
  static Eigen::MatrixXd series_covariance(const Series& series, std::vector<Row>& rows, const std::vector<std::vector<double>>& times) {
    const int n = static_cast<int>(rows.size()), R = static_cast<int>(series.replicates.size());
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) C(i, j) = noise_between(series, rows[i], times[i], rows[j], times[j]);
    if (R < 2) return C;
    const Eigen::MatrixXd D = deviations(series, rows, all_times(series));
    Eigen::VectorXd variance(n), next(n);
    double ratio = 0;
    const bool stated = series.observable->noise_u > 0;
    for (int i = 0; i < n; ++i) {
      variance[i] = product(D, i, i), next[i] = i + 1 < n ? product(D, i, i + 1) : 0;
      ratio += stated ? variance[i] / (C(i, i) * R) / n : 0;
    }
    const double next_bin = n > 1 ? C(0, 1) / std::sqrt(C(0, 0) * C(1, 1)) : 0;  // as many bins are independent as so correlated ones tell
    const double independent = std::max(1.0, n * (1 - next_bin * next_bin) / (1 + next_bin * next_bin));
    if (stated && ratio < 1 + 3.1 * std::sqrt(2.0 / ((R - 1.0) * independent))) return C;
    Eigen::VectorXd excess(n);
    for (int i = 0; i < n; ++i) {
      const int begin = std::max(0, i - 2), width = std::min(n, i + 3) - begin;
      excess[i] = std::max(0.0, variance.segment(begin, width).mean() - R * C.diagonal().segment(begin, width).mean());
    }
    if (!stated) excess *= R > 3 ? (R - 1.0) / (R - 3.0) : 3;
    const double step = n > 1 ? (rows.back().begin - rows.front().begin) / (n - 1) : 1;
    const double correlation =
        n > 1 ? std::clamp(next.head(n - 1).mean() / std::max(excess.head(n - 1).mean(), 1e-300), 0.03, 0.999) : 0.03;
    const double tau = -step / std::log(correlation);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j)
        C(i, j) += std::sqrt(excess[i] * excess[j]) * std::exp(-std::abs(rows[i].begin - rows[j].begin) / tau) / R;
      rows[i].u = std::sqrt(C(i, i) + (i == n - 1 && C(i, i) == 0 ? 1e-300 : 0));
    }
    return C;
  }

  // Mean over the replicates of the product of deviations in two bins.
  static double product(const Eigen::MatrixXd& D, int i, int j) {
    double sum = 0;
    int n = 0;
    for (int r = 0; r < D.cols(); ++r)
      if (std::isfinite(D(i, r)) && std::isfinite(D(j, r))) sum += D(i, r) * D(j, r), ++n;
    return n > 1 ? sum / (n - 1) : 0;
  }

  // Variance between replicates in three parts of the time, where the noise alone has a known one. Where noise lasts, n samples tell as
  // little of it as n^2/sum over i, j of r_ij^2 independent ones, r the correlation: the variance of a sum of squares of Gaussian numbers
  // is 2 sum r_ij^2.
  void add_spread(const Series& series, const std::vector<std::vector<double>>& times) {
    const int parts = std::min<int>(3, static_cast<int>(times.size()));
    for (int part = 0; part < parts; ++part) {
      Row row;
      row.kind = Row::Kind::spread;
      row.observable = series.observable_index;
      row.n_replicates = static_cast<int>(series.replicates.size());
      row.noise_u = series.noise->factor * series.observable->noise_u;
      double square = 0, degrees = 0;
      std::vector<double> instants;
      const std::size_t begin = part * times.size() / parts, end = (part + 1) * times.size() / parts;
      row.begin = times[begin].front(), row.end = times[end - 1].back();
      for (std::size_t b = begin; b < end; ++b) {
        for (const double time : times[b]) {
          const auto& at = series.value.at(time);
          if (at.size() < 2) continue;
          double mean = 0;
          for (const auto& [r, v] : at) mean += v / static_cast<double>(at.size());
          for (const auto& [r, v] : at) square += (v - mean) * (v - mean);
          degrees += static_cast<double>(at.size()) - 1;
          instants.push_back(time);
          row.slots.push_back(slot(row.observable, time));
        }
      }
      if (degrees < 2 || square <= 0) continue;
      row.weights.assign(row.slots.size(), 1.0 / static_cast<double>(row.slots.size()));
      double correlated = 0;
      for (const double a : instants)
        for (const double b : instants) correlated += std::pow(series.noise->correlation(a - b), 2);
      const double independent = degrees * static_cast<double>(instants.size()) / correlated;
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
