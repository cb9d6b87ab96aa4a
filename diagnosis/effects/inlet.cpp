// Inlet: swirl or a profile that the base case leaves out.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct Inlet final : EffectModel {
  static constexpr const char* name = "inlet";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "swirl of the water that comes in",
            .unit = "1",
            .mean = 0.2,
            .sd = 0.2,
            .minimum = -2,
            .maximum = 2,
            .random = false,
            .acts_on_water = false,
            .blind = base.prescribed ? "a prescribed flow has no inlet" : "the inlet of a mesh is varied by an [[alternative]]"};
  }
  void change(double, int, std::uint64_t, RunEdit&) const override {}
};
[[maybe_unused]] const bool registered = effect_models().add<Inlet>();

}  // namespace
}  // namespace snag
