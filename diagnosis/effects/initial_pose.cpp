// Initial pose: pieces start turned by theta times a standard normal deviate about the line of sight, another one in each replicate.
#include <cmath>
#include <numbers>

#include "base/random_numbers.hpp"
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

/// Box and Muller.
double normal_deviate(std::uint64_t seed) {
  const auto uniform = [](std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; };
  const double u = uniform(mixed(seed)), v = uniform(mixed(seed ^ 0xa5a5a5a5a5a5a5a5));
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

struct InitialPose final : EffectModel {
  static constexpr const char* name = "initial_pose";

  Effect effect(const BaseCase& base) const override {
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
  void change(double theta, int, std::uint64_t seed, RunChange& run) const override { run.turn += theta * normal_deviate(seed); }
};
[[maybe_unused]] const bool registered = effect_models().add<InitialPose>();

}  // namespace
}  // namespace snag
