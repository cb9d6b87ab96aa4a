#include "simulation/output/pump_output.hpp"

#include <algorithm>
#include <array>
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

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Quantity {
  const char* name;
  const char* unit;
  double (*value)(const PumpReading&);
};

/// Of one instant, in the order of the columns; those of the machine's balance by name.
constexpr std::array quantities{Quantity{"flow_in", "m3/s", [](const PumpReading& now) { return now.flow_in; }},
                                Quantity{"flow_out", "m3/s", [](const PumpReading& now) { return now.flow_out; }},
                                Quantity{"head", "m", [](const PumpReading& now) { return now.head; }},
                                Quantity{"head_total", "m", [](const PumpReading& now) { return now.head_total; }},
                                Quantity{"torque_pressure", "N m", [](const PumpReading& now) { return now.torque_pressure; }},
                                Quantity{"torque_friction", "N m", [](const PumpReading& now) { return now.torque_friction; }},
                                Quantity{"torque", "N m", [](const PumpReading& now) { return now.torque(); }},
                                Quantity{"shaft_power", "W", [](const PumpReading& now) { return now.shaft_power; }},
                                Quantity{"hydraulic_power", "W", [](const PumpReading& now) { return now.hydraulic_power; }},
                                Quantity{"efficiency", "1", [](const PumpReading& now) { return now.efficiency(); }},
                                Quantity{"torque_contacts", "N m", [](const PumpReading& now) { return now.torque_contacts; }},
                                Quantity{"shaft_power_total", "W", [](const PumpReading& now) { return now.shaft_power_total; }}};
enum : std::size_t {
  flow_out = 1,
  head = 2,
  head_total = 3,
  torque = 6,
  shaft_power = 7,
  hydraulic_power = 8,
  efficiency = 9,
  torque_contacts = 10,
  shaft_power_total = 11
};

/// Of all quantities; efficiency is the mean hydraulic over the mean shaft power.
std::vector<double> means_of(const Revolution& revolution) {
  std::vector<double> means = revolution_means(revolution, quantities.size());
  means[efficiency] = PumpReading::efficiency_of(means[hydraulic_power], means[shaft_power]);
  return means;
}

std::vector<Column<PumpInstant>> instant_columns() {
  using Record = const PumpInstant&;
  std::vector<Column<PumpInstant>> all{{"time", "s", [](Record r) { return r.time; }},
                                       {"angle", "deg", [](Record r) { return degrees * r.angle; }},
                                       {"revolutions", "1", [](Record r) { return r.revolutions; }}};
  for (std::size_t q = 0; q < quantities.size(); ++q)
    all.push_back({quantities[q].name, quantities[q].unit, [q](Record r) { return r.values[q]; }});
  return all;
}

/// Columns of what swings within a revolution.
void add_swing(std::vector<Column<RevolutionRecord>>& all, std::size_t quantity, RevolutionRecord::Swing RevolutionRecord::*swing) {
  using Record = const RevolutionRecord&;
  const std::string name = quantities[quantity].name, unit = quantities[quantity].unit;
  all.push_back({name + "_min", unit, [swing](Record r) { return (r.*swing).range.lowest; }});
  all.push_back({name + "_max", unit, [swing](Record r) { return (r.*swing).range.highest; }});
  for (std::size_t n = 0; n < n_harmonics; ++n) {
    const std::string number = std::to_string(n + 1);
    all.push_back({name + "_harmonic_" + number, unit, [swing, n](Record r) { return (r.*swing).harmonics[n].amplitude; }});
    all.push_back({name + "_phase_" + number, "deg", [swing, n](Record r) { return degrees * (r.*swing).harmonics[n].phase; }});
  }
}

std::vector<Column<RevolutionRecord>> revolution_columns() {
  using Record = const RevolutionRecord&;
  std::vector<Column<RevolutionRecord>> all{{"time", "s", [](Record r) { return r.time; }},
                                            {"revolution", "1", [](Record r) { return static_cast<double>(r.number); }}};
  for (std::size_t q = 0; q < quantities.size(); ++q)
    all.push_back({quantities[q].name, quantities[q].unit, [q](Record r) { return r.means[q]; }});
  all.insert(all.end(), {{"start_up", "1", [](Record r) { return r.is_start_up ? 1.0 : 0.0; }},
                         {"head_change_rel", "1", [](Record r) { return r.head.change; }},
                         {"torque_change_rel", "1", [](Record r) { return r.torque.change; }},
                         {"head_noise", "m", [](Record r) { return r.head_noise; }}});
  add_swing(all, head, &RevolutionRecord::head), add_swing(all, torque, &RevolutionRecord::torque);
  return all;
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
      turn_(start),
      sampler_(start.angle),
      phase_(n_bins, 2) {
  on_all_ranks(flow.mesh.comm, [&] {
    if (!root_) return;
    instants_ = Monitor<PumpInstant>(folder_ / "pump.csv", instant_columns(), resume, from_time);
    revolutions_ = Monitor<RevolutionRecord>(folder_ / "revolutions.csv", revolution_columns(), resume, from_time);
  });
}

void PumpOutput::after_step(const Flow& flow, const RotorState& rotor, double torque_of_contacts) {
  PumpReading reading = monitor_.read(flow, rotor.shaft);
  reading.torque_contacts = torque_of_contacts;
  reading.shaft_power_total = reading.shaft_power - torque_of_contacts * rotor.shaft.speed;
  const std::vector<double> values = values_of(quantities, reading);
  keeps_speed_ = keeps_speed_ && rotor.shaft.speed == turn_.speed;
  turn_.after_step(rotor, flow.time_step_size);
  for (const Revolution& revolution : sampler_.add(turn_.turned, values)) complete(revolution, flow.time);
  if (!root_) return;
  instants_.add({flow.time, reduced(rotor.angle), std::abs(turn_.turned) / two_pi, values});
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

RevolutionRecord::Swing PumpOutput::swing_of(const Revolution& revolution, const std::vector<double>& means, std::size_t quantity) const {
  RevolutionRecord::Swing swing{.change = none, .range = revolution_extremes(revolution, quantity), .harmonics = {}};
  if (!last_means_.empty()) swing.change = (means[quantity] - last_means_[quantity]) / std::abs(last_means_[quantity]);
  swing.harmonics = revolution_spectrum(revolution, quantity).harmonics;
  swing.harmonics.resize(n_harmonics, {none, none});
  return swing;
}

void PumpOutput::complete(const Revolution& revolution, double time) {
  const std::vector<double> means = means_of(revolution);
  const bool is_start_up = !has_settled(revolution, means);
  keeps_speed_ = true;
  if (!is_start_up) phase_.add(revolution, {head, torque});
  if (root_)
    revolutions_.add({.time = time,
                      .number = revolution.number,
                      .means = means,
                      .is_start_up = is_start_up,
                      .head_noise = revolution_spectrum(revolution, head).noise,
                      .head = swing_of(revolution, means, head),
                      .torque = swing_of(revolution, means, torque)});
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
  const double revolutions = std::max(std::abs(turn_.turned) / two_pi, static_cast<double>(sampler_.current().number - 1));
  return {means[flow_out],    means[head],       means[head_total],      means[torque],
          means[shaft_power], means[efficiency], means[torque_contacts], means[shaft_power_total],
          revolutions};
}

void PumpOutput::save(CheckpointWriter& writer) const {
  writer.shared("pump/turned", std::vector<double>{turn_.turned, turn_.speed, keeps_speed_ ? 1.0 : 0.0});
  writer.shared("pump/revolution", sampler_.state());
  writer.shared("pump/phase", phase_.state());
  if (!last_means_.empty()) writer.shared("pump/last_means", last_means_);
}

void PumpOutput::load(CheckpointReader& reader) {
  const std::vector<double> turned = reader.shared("pump/turned");
  turn_.turned = turned[0], turn_.speed = turned[1], keeps_speed_ = turned[2] != 0;
  sampler_.restore(reader.shared("pump/revolution"));
  phase_.restore(reader.shared("pump/phase"));
  if (reader.has("pump/last_means")) last_means_ = reader.shared("pump/last_means");
}

}  // namespace snag
