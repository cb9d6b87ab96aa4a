#include "observe/volute_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "base/words.hpp"

namespace snag {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::size_t index_of(PassageEvent event) {
  return std::find(VoluteHistogram::events.begin(), VoluteHistogram::events.end(), event) - VoluteHistogram::events.begin();
}

}  // namespace

int volute_bin(double angle) {
  const double turns = angle / (2 * std::numbers::pi);
  return std::min(static_cast<int>((turns - std::floor(turns)) * n_volute_bins), n_volute_bins - 1);
}

void VoluteStay::add(double angle, double radius, double duration) {
  const int bin = volute_bin(angle);
  time[bin] += duration, radius_time[bin] += duration * radius;
}

void VoluteHistogram::add(const VoluteHistogram& other) {
  rags_.insert(rags_.end(), other.rags_.begin(), other.rags_.end());
  for (std::size_t e = 0; e < events.size(); ++e)
    for (int bin = 0; bin < n_volute_bins; ++bin) n_events_[e][bin] += other.n_events_[e][bin];
}

void VoluteHistogram::count(PassageEvent event, double angle) {
  const std::size_t e = index_of(event);
  if (e < events.size()) ++n_events_[e][volute_bin(angle)];
}

int VoluteHistogram::n_events(PassageEvent event, int bin) const { return n_events_.at(index_of(event))[bin]; }

double VoluteHistogram::time(int bin) const {
  double sum = 0;
  for (const VoluteStay& rag : rags_) sum += rag.time[bin];
  return sum;
}

double VoluteHistogram::time() const {
  double sum = 0;
  for (int bin = 0; bin < n_volute_bins; ++bin) sum += time(bin);
  return sum;
}

double VoluteHistogram::radius(int bin) const {
  double sum = 0;
  for (const VoluteStay& rag : rags_) sum += rag.radius_time[bin];
  return sum / time(bin);
}

std::vector<double> VoluteHistogram::radii(int bin) const {
  std::vector<double> means;
  for (const VoluteStay& rag : rags_)
    if (rag.time[bin] > 0) means.push_back(rag.radius_time[bin] / rag.time[bin]);
  return means;
}

double VoluteHistogram::radius_deviation(int bin) const {
  const std::vector<double> means = radii(bin);
  if (means.size() < 2) return none;
  const double n = static_cast<double>(means.size());
  double mean = 0, square = 0;
  for (const double radius : means) mean += radius / n;
  for (const double radius : means) square += (radius - mean) * (radius - mean);
  return std::sqrt(square / (n - 1));
}

std::string VoluteHistogram::csv() const {
  std::string text = "angle_from [deg],angle_to [deg],time [s],share [1],radius [m],radius_sigma [m],rags [1]";
  for (const PassageEvent event : events) {
    std::string name = words_of(event).key;
    std::replace(name.begin(), name.end(), ' ', '_');
    text += "," + name + " [1]";
  }
  for (int bin = 0; bin < n_volute_bins; ++bin) {
    char line[200];
    std::snprintf(line, sizeof line, "\n%d,%d,%.10g,%.10g,%.10g,%.10g,%zu", bin * 360 / n_volute_bins, (bin + 1) * 360 / n_volute_bins,
                  time(bin), share(bin), radius(bin), radius_deviation(bin), radii(bin).size());
    text += line;
    for (std::size_t e = 0; e < events.size(); ++e) text += "," + std::to_string(n_events_[e][bin]);
  }
  return text + "\n";
}

std::string VoluteHistogram::words() const {
  std::string text = std::to_string(n_rags()) + (n_rags() == 1 ? " rag, " : " rags, ") + snag::number_text(time()) + " s";
  for (std::size_t e = 0; e < events.size(); ++e) {
    int n = 0;
    for (const int in_bin : n_events_[e]) n += in_bin;
    text += std::string(", ") + words_of(events[e]).key + " " + std::to_string(n);
  }
  return text;
}

}  // namespace snag
