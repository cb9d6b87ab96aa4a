#include "simulation/setup/coupling_remedy.hpp"

#include <variant>

#include "base/words.hpp"
#include "coupling/coupling_settings.hpp"

namespace snag {

namespace {
constexpr double large_normal_coefficient = 50;  // of sheet_drag: a cloth that hardly lets water through
}  // namespace

std::string coupling_remedy(const Coupling* coupling) {
  if (!coupling || !coupling->settings.two_way()) return {};
  const CouplingSettings& settings = coupling->settings;
  if (settings.kernel == "cell")
    return "with [coupling] kernel = \"cell\" a particle feels its own wake, which its force makes larger from step to step: use kernel = "
           "\"gaussian\" with a kernel_width of two particle diameters or more";
  for (std::size_t i = 0; i < settings.forces.size(); ++i) {
    if (settings.forces[i] != "sheet_drag") continue;
    for (const Parameter& parameter : coupling->forces[i]->parameters())
      if (const auto* value = std::get_if<std::optional<double>*>(&parameter.target);
          parameter.key == "normal_coefficient" && value && (*value)->value_or(0) > large_normal_coefficient)
        return "[coupling.sheet_drag] normal_coefficient = " + words(***value) +
               " is stiffer than the step resolves: lower it, widen "
               "kernel_width, or use a shorter [time] step";
  }
  return {};
}

}  // namespace snag
