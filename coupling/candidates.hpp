#pragma once
// Effects of the diagnosis that are settings of the water as the rags feel it: no force of their own.
#include <vector>

#include "base/prior.hpp"

namespace snag {

/// Here theta changes the value that the case has at the key: at zero it is the base model.
std::vector<Candidate> coupling_candidates();

}  // namespace snag
