#pragma once
// Which uncertain inputs of base cases are free in every hypothesis, and which points share one deviation.
#include <string>
#include <utility>
#include <vector>

#include "casework/point_case.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

/// A set-point of the flow is one of its own at every point; what has the same value at several points (a fluid, a particle) is the same
/// kind of thing there: one half of its variance is common, the other each point's own. A drag law is the same everywhere, and off by the
/// same, unless its error is said to be each point's own; beside the factor on it the exponent of Re is free. `input_u`: relative standard
/// uncertainties by key and point, as DIAGNOSIS.toml gives them.
std::vector<Nuisance> input_nuisances(const std::vector<const PointCase*>& bases,
                                      const std::vector<std::vector<std::pair<std::string, double>>>& input_u);

}  // namespace snag
