#pragma once
// Balances of angular momentum and of energy of a run with a turning zone (solver/balances.hpp): monitors/balance.csv every step, and means
// over the last complete revolution for summary.json.
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/monitor.hpp"
#include "simulation/output/pump_output.hpp"
#include "simulation/output/revolution_statistics.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

/// One step.
struct BalanceRecord {
  double time = 0;  // s
  const Balances* balances = nullptr;
};

/// Means over the last complete revolution, over the whole run if none is complete; SI.
struct BalanceSummary {
  double shaft_torque = 0, torque_lost_rotor = 0, torque_lost_stator = 0;
  double torque_residual = 0;  // of both zones, without its sign
  double shaft_power = 0, given_power = 0, hydraulic_power = 0, stored_power = 0;
  double dissipation_viscous = 0, dissipation_turbulent = 0, dissipation_walls = 0;
  double numerical_power = 0, power_residual = 0;

  /// Over the shaft's; none where the shaft has none. What is lost in one zone does not make up for what is lost in the other.
  std::optional<double> torque_lost_rel() const {
    return share(std::abs(torque_lost_rotor) + std::abs(torque_lost_stator), std::abs(shaft_torque));
  }
  std::optional<double> torque_residual_rel() const { return share(torque_residual, std::abs(shaft_torque)); }
  std::optional<double> numerical_power_rel() const { return share(numerical_power, shaft_power); }
  std::optional<double> power_residual_rel() const { return share(power_residual, std::abs(shaft_power)); }

 private:
  static std::optional<double> share(double part, double whole) { return whole != 0 ? std::optional(part / whole) : std::nullopt; }
};

class BalanceOutput {
 public:
  /// `start`: the rotor at time 0. Opens the monitor on rank 0, of a solver that keeps balances; a resume keeps its lines up to from_time.
  /// Collective; throws Error(io).
  BalanceOutput(const std::filesystem::path& monitors, const FlowSolver& water, const RotorState& start, bool resume, double from_time);
  /// The step just done. Local.
  void after_step(const FlowSolver& water, const RotorState& rotor);
  BalanceSummary summary() const;

  /// What a resume needs of the past; names begin with "balance/". Collective.
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);
  /// Open on rank 0.
  const Series& series() const { return monitor_.series(); }

 private:
  bool root_;
  Monitor<BalanceRecord> monitor_;  // open on rank 0
  ShaftTurn turn_;
  RevolutionSampler sampler_;
  std::vector<double> last_means_;  // of the last complete revolution, empty before the first
};

}  // namespace snag
