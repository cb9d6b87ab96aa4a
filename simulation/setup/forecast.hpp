#pragma once
// What `snag check` says of a run before its first step, from the speed of the case (solver/divergence.hpp):
//
//   turn of the rotor and Courant number a step,   Re = U D/nu,   y+ = y u_tau/nu of each wall,   cost and memory
//
// U: speed at the patch; D: sqrt(4 A/pi) of the widest open patch, or the extent of the body in a flow around one; u_tau = 0.05 U, that of
// a turbulent boundary layer within a third; y: distance of the first cell centre. Estimates, to a factor of two.
#include <string>
#include <vector>

#include "simulation/setup/simulation.hpp"

namespace snag {

struct Forecast {
  std::string text;                   // lines for the log
  std::vector<std::string> warnings;  // what will be wrong with the run
};

/// Collective, the same on every rank.
Forecast forecast(const Simulation& simulation);
/// Throws Error(usage) for a step in which the rotor turns so far that no result could be used.
void check_turn(const FlowSolver& water, double step);
/// Where the cloth is: particles in the run, and those that wait as they will be put in; on one rank each, m.
std::vector<Vec3> places_of_cloth(const Simulation& simulation);

}  // namespace snag
