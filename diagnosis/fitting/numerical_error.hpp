#pragma once
// Error of the time step of a state, from runs with twice the step: f(2 dt) - f(dt), less what chance has in it, or as the experiment
// states it (numerics_u of an observable).
#include <Eigen/Dense>
#include <vector>

#include "diagnosis/fitting/response.hpp"

namespace snag {

/// By point and row; `responses` are those of the state at these points.
std::vector<Eigen::VectorXd> numerical_error(Responses& model, const State& state, const std::vector<int>& points,
                                             const std::vector<Response>& responses);

}  // namespace snag
