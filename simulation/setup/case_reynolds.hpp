#pragma once
// Re = U D/nu of a case. U: speed of the case (solver/divergence.hpp), m/s; D: sqrt(4 A/pi) of the widest open patch, or the extent of the
// body in a flow around one, m; nu: kinematic viscosity of the water, m2/s.
#include <optional>
#include <string>

#include "simulation/setup/simulation.hpp"

namespace snag {

constexpr double transition_of_a_pipe = 4000;  // Reynolds number from which its flow is turbulent

struct CaseReynolds {
  double number = 0, width = 0;  // 1; D, m
  std::string width_of;          // for messages
};

/// None in a closed domain. Collective, the same on every rank.
std::optional<CaseReynolds> case_reynolds(const Simulation& simulation);

}  // namespace snag
