#include "simulation/output/pump_record.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {

constexpr int most_revolutions = 3;  // before and after a passage
constexpr double settled = 0.02;     // change of the head from one revolution to the next

/// y at an x between rising ones, linear; the first and last stretch reach beyond the ends.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.size() < 2) return y.at(0);
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, at) - x.begin();
  const double width = x[next] - x[next - 1];
  return width > 0 ? y[next - 1] + (y[next] - y[next - 1]) * (at - x[next - 1]) / width : y[next];
}

}  // namespace

std::optional<double> PumpPassage::change(double PumpMeans::*value) const {
  if (!before || !passing || (*before).*value == 0) return {};
  return (*passing).*value / ((*before).*value) - 1;
}

PumpRecord::PumpRecord(const std::filesystem::path& monitors) : table_(recorded(monitors / "pump.csv")) {
  if (table_.columns.empty()) return;
  time_ = table_.values[0];
  turned_ = table_.column("revolutions");
}

double PumpRecord::revolution(double time) const { return interpolated(time_, turned_, time); }

double PumpRecord::mean(const std::string& name, double from, double to) const {
  const auto& value = table_.column(name);
  double sum = 0, duration = 0;
  for (std::size_t i = 1; i < time_.size(); ++i)
    if (turned_[i] > from + 1e-9 && turned_[i] <= to + 1e-9)
      sum += value[i] * (time_[i] - time_[i - 1]), duration += time_[i] - time_[i - 1];
  return duration > 0 ? sum / duration : NAN;
}

std::optional<PumpMeans> PumpRecord::means(double from, int n) const {
  if (n < 1) return {};
  const auto of = [&](const char* name) { return mean(name, from, from + n); };
  return PumpMeans{n, of("head"), of("torque"), of("shaft_power")};
}

PumpPassage PumpRecord::passage(double entered, double exited) const {
  if (empty()) return {};
  return {before(entered), during(entered, std::isfinite(exited) ? exited : time_.back()), after(exited)};
}

std::optional<PumpMeans> PumpRecord::before(double time) const {
  if (empty() || !std::isfinite(time)) return {};
  const double end = revolution(time), first = turned_.front();
  const int n_most = std::min(most_revolutions, static_cast<int>(std::floor(end - first + 1e-6)) - 1);
  const auto has_settled = [&](double begin) {  // the head of the revolution that begins there, with that of the next one
    const double next = mean("head", begin + 1, begin + 2);
    return std::abs(mean("head", begin, begin + 1) - next) <= settled * std::abs(next);
  };
  int n = 1;
  while (n < n_most && has_settled(end - n - 1)) ++n;
  return n < 2 ? std::nullopt : means(end - n, n);
}

std::optional<PumpMeans> PumpRecord::during(double begin, double end) const {
  if (empty() || !(begin < end)) return {};
  const double first = revolution(begin), last = revolution(end);
  const int n = std::max(1, static_cast<int>(std::floor(last - first + 1e-6)));
  double from = 0.5 * (first + last - n);
  from = std::min(from, turned_.back() - n);
  return from < turned_.front() - 1e-3 ? std::nullopt : means(from, n);
}

std::optional<PumpMeans> PumpRecord::after(double time) const {
  if (empty() || !std::isfinite(time)) return {};
  const double begin = revolution(time);
  return means(begin, std::min(most_revolutions, static_cast<int>(std::floor(turned_.back() - begin + 1e-6))));
}

double PumpRecord::period() const {
  return empty() || turned_.back() - turned_.front() < 1 ? 0 : time_.back() - interpolated(turned_, time_, turned_.back() - 1);
}

std::vector<double> PumpRecord::sliding_mean(const std::string& name) const {
  const auto& value = table_.column(name);
  std::vector<double> sum(time_.size(), 0), result(time_.size(), NAN);  // sum: integral over time, trapezoids
  for (std::size_t i = 1; i < time_.size(); ++i) sum[i] = sum[i - 1] + 0.5 * (value[i] + value[i - 1]) * (time_[i] - time_[i - 1]);
  for (std::size_t i = 0; i < time_.size(); ++i) {
    const double from = turned_[i] - 0.5, to = turned_[i] + 0.5;
    if (from < turned_.front() || to > turned_.back()) continue;
    result[i] = (interpolated(turned_, sum, to) - interpolated(turned_, sum, from)) /
                (interpolated(turned_, time_, to) - interpolated(turned_, time_, from));
  }
  return result;
}

}  // namespace snag
