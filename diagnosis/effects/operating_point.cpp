// Operating point: all set-points of the flow were (1 + theta) times what was written down, the same factor at every point (a flow meter's
// error, a misread unit).
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct OperatingPoint final : EffectModel {
  static constexpr const char* name = "operating_point";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "relative error of all set-points of the flow",
            .unit = "1",
            .mean = 0.15,
            .sd = 0.2,
            .minimum = -0.9,
            .maximum = 4,
            .random = false,
            .acts_on_water = false,
            .blind = base.flows        ? ""
                     : base.prescribed ? "the water is at rest"
                                       : "the case sets neither a flow rate nor a velocity of the water"};
  }
  void change(double theta, int, std::uint64_t, RunEdit& run) const override { run.scale_flow(1 + theta); }
};
[[maybe_unused]] const bool registered = effect_models().add<OperatingPoint>();

}  // namespace
}  // namespace snag
