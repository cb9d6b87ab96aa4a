#pragma once
// What makes a coupling of particles and water unstable, as a remedy for the message of a run that diverged.
#include <string>

namespace snag {

struct Coupling;

/// Empty where nothing in the coupling is known to do it; `coupling` may be null.
std::string coupling_remedy(const Coupling* coupling);

}  // namespace snag
