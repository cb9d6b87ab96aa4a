#include "simulation/setup/coupling_remedy.hpp"

#include "coupling/coupling_settings.hpp"

namespace snag {

std::string coupling_remedy(const Coupling* coupling) {
  if (!coupling || !coupling->settings.two_way()) return {};
  const CouplingSettings& settings = coupling->settings;
  if (settings.kernel == "cell")
    return "with [coupling] kernel = \"cell\" a particle feels its own wake, which its force makes larger from step to step: use kernel = "
           "\"gaussian\" with a kernel_width of two particle diameters or more";
  return {};
}

}  // namespace snag
