// No turbulence model: the equations of solver/fields/flow.hpp with the viscosity of the fluid.
#include "solver/turbulence/turbulence.hpp"

namespace snag {
namespace {

struct Laminar final : Turbulence {
  static constexpr const char* name = "laminar";
  Section section() override { return {.name = name, .meaning = "No model; the fluid's own viscosity.", .parameters = {}}; }
};
const bool registered = turbulence_models().add<Laminar>();

}  // namespace
}  // namespace snag
