#include "simulation/output/pump_output.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/atomic_file.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr double two_pi = 2 * std::numbers::pi, degrees = 180 / std::numbers::pi;
constexpr std::size_t n_bins = 72;       // of 5 degrees
constexpr std::size_t n_harmonics = 3;   // written
constexpr double settled_change = 0.02;  // of the means of head and torque from a revolution to the next

// Quantities of one instant in the order of the columns; those of the machine's balance by name.
const std::vector<std::string>& quantities() {
  static const std::vector<std::string> names = {"flow_in [m3/s]",        "flow_out [m3/s]",       "head [m]",     "head_total [m]",
                                                 "torque_pressure [N m]", "torque_friction [N m]", "torque [N m]", "shaft_power [W]",
                                                 "hydraulic_power [W]",   "efficiency [1]"};
  return names;
}
enum : std::size_t { flow_out = 1, head = 2, head_total = 3, torque = 6, shaft_power = 7, hydraulic_power = 8, efficiency = 9 };

std::vector<double> values_of(const PumpReading& now) {
  return {now.flow_in,         now.flow_out, now.head,        now.head_total,      now.torque_pressure,
          now.torque_friction, now.torque(), now.shaft_power, now.hydraulic_power, now.efficiency()};
}

/// Of all quantities; efficiency is the mean hydraulic over the mean shaft power.
std::vector<double> means_of(const Revolution& revolution) {
  std::vector<double> means;
  for (std::size_t q = 0; q < quantities().size(); ++q) means.push_back(revolution_mean(revolution, q));
  means[efficiency] = PumpReading::efficiency_of(means[hydraulic_power], means[shaft_power]);
  return means;
}

std::vector<std::string> instant_columns() {
  std::vector<std::string> columns{"time [s]", "angle [deg]", "revolutions [1]"};
  columns.insert(columns.end(), quantities().begin(), quantities().end());
  return columns;
}

std::vector<std::string> revolution_columns() {
  std::vector<std::string> columns{"time [s]", "revolution [1]"};
  columns.insert(columns.end(), quantities().begin(), quantities().end());
  for (const char* column : {"start_up [1]", "head_change_rel [1]", "torque_change_rel [1]", "head_noise [m]"})
    columns.emplace_back(column);
  for (const auto& [name, unit] : {std::pair<std::string, std::string>{"head", "m"}, {"torque", "N m"}}) {
    for (const char* end : {"_min", "_max"}) columns.push_back(name + end + " [" + unit + "]");
    for (std::size_t n = 1; n <= n_harmonics; ++n) {
      columns.push_back(name + "_harmonic_" + std::to_string(n) + " [" + unit + "]");
      columns.push_back(name + "_phase_" + std::to_string(n) + " [deg]");
    }
  }
  return columns;
}

double reduced(double angle) {
  const double rest = std::fmod(angle, two_pi);
  return rest < 0 ? rest + two_pi : rest;
}

}  // namespace

PumpOutput::PumpOutput(std::filesystem::path monitors, const Flow& flow, const PumpSettings& settings, const RotorState& start, bool resume,
                       double from_time)
    : folder_(std::move(monitors)),
      root_(rank_of(flow.mesh.comm) == 0),
      monitor_(flow, settings),
      start_angle_(start.angle),
      speed_(start.shaft.speed),
      sampler_(start.angle),
      phase_(n_bins, 2) {
  together(flow.mesh.comm, [&] {
    if (!root_) return;
    instants_ = Series(folder_ / "pump.csv", instant_columns(), resume, from_time);
    revolutions_ = Series(folder_ / "revolutions.csv", revolution_columns(), resume, from_time);
  });
}

void PumpOutput::after_step(const Flow& flow, const RotorState& rotor) {
  const std::vector<double> values = values_of(monitor_.read(flow, rotor.shaft));
  if (rotor.slides)
    turned_ = rotor.angle - start_angle_;
  else
    turned_ += 0.5 * (speed_ + rotor.shaft.speed) * flow.time_step_size;
  keeps_speed_ = keeps_speed_ && rotor.shaft.speed == speed_;
  speed_ = rotor.shaft.speed;
  for (const Revolution& revolution : sampler_.add(turned_, values)) complete(revolution, flow.time);
  if (!root_) return;
  std::vector<double> record{flow.time, degrees * reduced(rotor.angle), std::abs(turned_) / two_pi};
  record.insert(record.end(), values.begin(), values.end());
  instants_.add(record);
}

/// Whether the start-up is over with this revolution.
bool PumpOutput::has_settled(const Revolution& revolution, const std::vector<double>& means) const {
  if (phase_.n_revolutions() > 0) return true;
  if (last_means_.empty() || !keeps_speed_) return false;
  for (const std::size_t q : {head, torque}) {
    const Extremes range = revolution_extremes(revolution, q);
    if (std::abs(means[q] - last_means_[q]) > settled_change * std::max(std::abs(means[q]), range.highest - range.lowest)) return false;
  }
  return true;
}

void PumpOutput::complete(const Revolution& revolution, double time) {
  const std::vector<double> means = means_of(revolution);
  const bool is_start_up = !has_settled(revolution, means);
  keeps_speed_ = true;
  if (!is_start_up) phase_.add(revolution, {head, torque});
  if (root_) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> record{time, static_cast<double>(revolution.number)};
    record.insert(record.end(), means.begin(), means.end());
    record.push_back(is_start_up);
    for (const std::size_t q : {head, torque})
      record.push_back(last_means_.empty() ? none : (means[q] - last_means_[q]) / std::abs(last_means_[q]));
    record.push_back(revolution_spectrum(revolution, head).noise);
    for (const std::size_t q : {head, torque}) {
      const Extremes range = revolution_extremes(revolution, q);
      const std::vector<Harmonic> harmonics = revolution_spectrum(revolution, q).harmonics;
      record.insert(record.end(), {range.lowest, range.highest});
      for (std::size_t n = 0; n < n_harmonics; ++n) {
        const Harmonic harmonic = n < harmonics.size() ? harmonics[n] : Harmonic{none, none};  // not resolved by the steps
        record.insert(record.end(), {harmonic.amplitude, degrees * harmonic.phase});
      }
    }
    revolutions_.add(record);
  }
  last_means_ = means;
}

void PumpOutput::write_phase() const {
  if (phase_.n_revolutions() == 0) return;
  std::string text = "angle [deg],revolutions [1],head_mean [m],head_deviation [m],torque_mean [N m],torque_deviation [N m]\n";
  for (std::size_t bin = 0; bin < phase_.n_bins(); ++bin) {
    char line[200];
    std::snprintf(line, sizeof line, "%.17g,%lld,%.17g,%.17g,%.17g,%.17g\n", degrees * phase_.angle(bin),
                  static_cast<long long>(phase_.n_revolutions()), phase_.mean(bin, 0), phase_.deviation(bin, 0), phase_.mean(bin, 1),
                  phase_.deviation(bin, 1));
    text += line;
  }
  write_atomically(folder_ / "phase.csv", text);
}

PumpSummary PumpOutput::summary() const {
  const std::vector<double> means = last_means_.empty() ? means_of(sampler_.current()) : last_means_;
  // A revolution that is complete but for round-off counts as one.
  const double revolutions = std::max(std::abs(turned_) / two_pi, static_cast<double>(sampler_.current().number - 1));
  return {means[flow_out], means[head], means[head_total], means[torque], means[shaft_power], means[efficiency], revolutions};
}

void PumpOutput::save(CheckpointWriter& writer) const {
  writer.shared("pump/turned", std::vector<double>{turned_, speed_, keeps_speed_ ? 1.0 : 0.0});
  writer.shared("pump/revolution", sampler_.state());
  writer.shared("pump/phase", phase_.state());
  if (!last_means_.empty()) writer.shared("pump/last_means", last_means_);
}

void PumpOutput::load(CheckpointReader& reader) {
  const std::vector<double> turned = reader.shared("pump/turned");
  turned_ = turned[0], speed_ = turned[1], keeps_speed_ = turned[2] != 0;
  sampler_.restore(reader.shared("pump/revolution"));
  phase_.restore(reader.shared("pump/phase"));
  if (reader.has("pump/last_means")) last_means_ = reader.shared("pump/last_means");
}

}  // namespace snag
