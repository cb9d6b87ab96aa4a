#pragma once
// What a pump engineer reads: monitors/pump.csv every step, monitors/revolutions.csv a row a revolution of the rotor, monitors/phase.csv
// the mean over revolutions at each angle.
//
// The start-up is left out of phase.csv. It ends with the first revolution that is not the first of the run, in which the shaft keeps its
// speed, and in which the means of head and torque differ from those of the revolution before by less than 2 % of themselves or of their
// range within a revolution. That revolution counts; revolutions.csv marks those of the start-up.
//
// Angles are those of the rotor in the frame of the casing. In a frame (motion = "frame") the rotor stands at its angle and revolutions are
// those that the shaft would have made.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/monitor.hpp"
#include "simulation/output/revolution_statistics.hpp"
#include "solver/pump_monitor.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;

/// The rotor at one time.
struct RotorState {
  Shaft shaft;
  double angle = 0;  // rad, in the frame of the casing, not reduced
  bool slides = true;
};

/// How far the shaft has turned: where the rotor slides as far as it has, in a frame as far as its speed would have turned it.
struct ShaftTurn {
  double start_angle, speed;  // rad; rad/s, at the end of the last step
  double turned = 0;          // rad, since the start

  explicit ShaftTurn(const RotorState& start) : start_angle(start.angle), speed(start.shaft.speed) {}
  void after_step(const RotorState& rotor, double dt) {
    if (rotor.slides)
      turned = rotor.angle - start_angle;
    else
      turned += 0.5 * (speed + rotor.shaft.speed) * dt;
    speed = rotor.shaft.speed;
  }
};

/// Means over the last complete revolution, over the whole run if none is complete; SI.
struct PumpSummary {
  double flow = 0, head = 0, head_total = 0, torque = 0, shaft_power = 0, efficiency = 0;
  double torque_contacts = 0, shaft_power_total = 0;  // of the rags on the impeller; of water and rags
  double revolutions = 0;                             // of the whole run; below 1: the means are over it all
};

/// One instant: values in the order of the quantities of the pump.
struct PumpInstant {
  double time = 0, angle = 0, revolutions = 0;  // s; rad, of the rotor, reduced to a turn; turned since the start
  std::vector<double> values;
};

/// One revolution: means in the same order; head and torque in particular.
struct RevolutionRecord {
  struct Swing {
    double change = 0;  // of the mean since the revolution before, over its magnitude; NaN: there is none
    Extremes range;
    std::vector<Harmonic> harmonics;  // those that are written; NaN where the steps do not resolve them
  };
  double time = 0;  // s
  std::int64_t number = 0;
  std::vector<double> means;
  bool is_start_up = false;
  double head_noise = 0;  // m
  Swing head, torque;
};

class PumpOutput {
 public:
  /// `start`: the rotor at time 0. Opens the monitors on rank 0; a resume keeps their lines up to from_time. Collective; throws
  /// Error(usage, io).
  PumpOutput(std::filesystem::path monitors, const Flow& flow, const PumpSettings& settings, const RotorState& start, bool resume,
             double from_time);
  /// The step just done. `torque_of_contacts`: of the rags on the walls that turn with the shaft, mean over the step, N m. Collective.
  void after_step(const Flow& flow, const RotorState& rotor, double torque_of_contacts = 0);
  /// monitors/phase.csv as it stands; nothing before a revolution after the start-up is complete. Rank 0 only; throws Error(io).
  void write_phase() const;
  PumpSummary summary() const;

  /// What a resume needs of the past; names begin with "pump/". Collective.
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);
  /// The files that are written a line a step; open on rank 0.
  std::vector<const Series*> series() const { return {&instants_.series(), &revolutions_.series()}; }

 private:
  void complete(const Revolution& revolution, double time);
  RevolutionRecord::Swing swing_of(const Revolution& revolution, const std::vector<double>& means, std::size_t quantity) const;
  bool has_settled(const Revolution& revolution, const std::vector<double>& means) const;

  std::filesystem::path folder_;
  bool root_;
  PumpMonitor monitor_;
  Monitor<PumpInstant> instants_;          // open on rank 0
  Monitor<RevolutionRecord> revolutions_;  // likewise
  ShaftTurn turn_;
  bool keeps_speed_ = true;  // the shaft, in this revolution
  RevolutionSampler sampler_;
  PhaseAverage phase_;
  std::vector<double> last_means_;  // of the last complete revolution, empty before the first
};

}  // namespace snag
