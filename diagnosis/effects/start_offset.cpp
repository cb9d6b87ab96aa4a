// Offset of the start: all pieces start nearer the inside of the bend of [pipe_flow] by theta, whatever part of the pipe they start in.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct StartOffset final : EffectModel {
  static constexpr const char* name = "start_offset";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "way by which the pieces start nearer the inside of the bend",
            .unit = "m",
            .mean = 0.01,
            .sd = 0.02,
            .minimum = -0.5,
            .maximum = 0.5,
            .random = false,
            .acts_on_water = false,
            .blind = base.bend ? "" : "there is no bend in [pipe_flow], or its water is computed"};
  }
  void change(double theta, int, std::uint64_t, RunEdit& run) const override { run.move_pieces_inside(theta); }
};
[[maybe_unused]] const bool registered = effect_models().add<StartOffset>();

}  // namespace
}  // namespace snag
