#pragma once
// Effects of the diagnosis that are settings of the rags and their contacts.
#include <vector>

#include "base/prior.hpp"

namespace snag {

/// Here theta is added to the value that the case has at the key: at zero it is the base model.
std::vector<Candidate> dem_candidates();

}  // namespace snag
