// Flow field: the part of the flow that changes in space or time is (1 + theta) times the one assumed, while the mean, which a flow meter
// tells, is right. A prescribed flow without a mean, or without such a part, cannot tell it from an error of the set-points.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct FlowError final : EffectModel {
  static constexpr const char* name = "flow_error";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "relative error of shear and oscillation of the flow",
            .unit = "1",
            .mean = 0.15,
            .sd = 0.2,
            .minimum = -0.9,
            .maximum = 4,
            .random = false,
            .acts_on_water = false,
            .blind = base.prescribed && base.uniform && base.varies ? "" : "the flow has no steady mean beside a part that varies"};
  }
  void change(double theta, int, std::uint64_t, RunEdit& run) const override { run.scale_varying_flow(1 + theta); }
};
[[maybe_unused]] const bool registered = effect_models().add<FlowError>();

}  // namespace
}  // namespace snag
