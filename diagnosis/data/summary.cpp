#include "diagnosis/data/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/data/noise.hpp"
#include "diagnosis/data/repeats_of_row.hpp"
#include "diagnosis/data/sample_series.hpp"
#include "diagnosis/statistics/lifetimes.hpp"
#include "diagnosis/statistics/statistics.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

using Kind = Observable::Kind;

double transformed(const Observable& observable, double value) { return observable.kind == Kind::lognormal ? std::log(value) : value; }

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
    SampleSeries series{&observable, &noise_[static_cast<std::size_t>(data[0].observable)], data[0].observable, {}, {}, false, {}};
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
    blocks_.push_back(covariance_of_bins(series, rows, times));
    if (spread_ && observable.noise_u > 0) add_spread(series, times);
    for (Row& row : rows) result_.rows.push_back(std::move(row));
  }

  Row path_row(const SampleSeries& series, const std::vector<double>& times) const {
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

  // Variance between three replicates or more, in three parts of the time, where the noise alone has a known one.
  void add_spread(const SampleSeries& series, const std::vector<std::vector<double>>& times) {
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
