// Spin of the start: pieces start with an angular velocity of theta times a normal deviate about each axis, other ones in each replicate.
#include "diagnosis/effects/effect_model.hpp"
#include "diagnosis/statistics/even_deviates.hpp"

namespace snag {
namespace {

struct StartSpin final : EffectModel {
  static constexpr const char* name = "start_spin";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "standard deviation of the angular velocity at the start about each axis",
            .unit = "rad/s",
            .mean = 3,
            .sd = 3,
            .minimum = 0,
            .maximum = 200,
            .random = true,
            .acts_on_water = false,
            .blind = !base.oriented ? "a sphere has no direction"
                     : base.pipe    ? ""
                                    : "there is no [pipe_flow], or its water is computed"};
  }
  void change(double theta, int, std::uint64_t seed, RunEdit& run) const override {
    const auto [x, y, z] = even_normal_deviates(seed);
    run.spin_pieces({theta * x, theta * y, theta * z});
  }
};
[[maybe_unused]] const bool registered = effect_models().add<StartSpin>();

}  // namespace
}  // namespace snag
