// Initial pose: pieces start turned by theta times a standard normal deviate about the line of sight, another one in each replicate.
#include "diagnosis/effects/effect_model.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

/// Standard normal deviates that fill the distribution evenly where seeds follow each other, so that the few runs of a diagnosis have its
/// spread: quantiles of a Weyl sequence with the golden ratio.
double normal_deviate(std::uint64_t seed) {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;  // 2^64 (sqrt(5) - 1)/2
  return normal_quantile((static_cast<double>((seed * golden) >> 11) + 0.5) * 0x1p-53);
}

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
  void change(double theta, int, std::uint64_t seed, RunEdit& run) const override { run.turn_pieces(theta * normal_deviate(seed)); }
};
[[maybe_unused]] const bool registered = effect_models().add<InitialPose>();

}  // namespace
}  // namespace snag
