// Initial pose: pieces start turned by theta times a standard normal deviate about the line of sight, another one in each replicate.
#include "diagnosis/effects/effect_model.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

struct InitialPose final : EffectModel {
  static constexpr const char* name = "initial_pose";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "standard deviation of the angle at the start",
            .unit = "rad",
            .mean = 0.3,
            .sd = 0.3,
            .minimum = 0,
            .maximum = 1.6,
            .random = true,
            .acts_on_water = false,
            .blind = base.oriented ? "" : "a sphere has no direction"};
  }
  void change(double theta, int, std::uint64_t seed, RunEdit& run) const override { run.turn_pieces(theta * even_normal_deviate(seed)); }
};
[[maybe_unused]] const bool registered = effect_models().add<InitialPose>();

}  // namespace
}  // namespace snag
