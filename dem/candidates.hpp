#pragma once
// Effects of the diagnosis that are settings of the rags, of their contacts and of laws that the case holds. The reference Re of
// drag_exponent is none: it changes drag by one factor, as drag_magnitude does.
#include <vector>

#include "base/prior.hpp"

namespace snag {

/// Here theta changes the value that the case has at the key: at zero it is the base model.
std::vector<Candidate> dem_candidates();

}  // namespace snag
