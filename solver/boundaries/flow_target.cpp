#include "solver/boundaries/flow_target.hpp"

#include <cmath>

namespace snag {

void FlowTarget::advance(const Measured& measured, double target, double density, double response_time) {
  const double inertance = density / conductance_;
  if (measured.dt_before > 0) {
    const double now = level_ + inertance * (measured.flow - measured.flow_before) / measured.dt_before;
    // The first measurement is taken whole: the level at the start is a guess.
    holding_ += (known_ ? -std::expm1(-measured.dt / response_time) : 1) * (now - holding_);
    known_ = true;
  }
  level_ = holding_ + inertance * (measured.flow - target) / response_time;
}

void FlowTarget::restore(const std::vector<double>& state) {
  conductance_ = state.at(0), level_ = state.at(1), holding_ = state.at(2), known_ = state.at(3) != 0;
}

}  // namespace snag
