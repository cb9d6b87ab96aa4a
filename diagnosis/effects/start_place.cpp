// Place of the start: pieces start moved by theta times a normal deviate along each axis, other ones in each replicate.
#include "diagnosis/effects/effect_model.hpp"
#include "diagnosis/statistics/even_deviates.hpp"

namespace snag {
namespace {

struct StartPlace final : EffectModel {
  static constexpr const char* name = "start_place";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "standard deviation of the place at the start along each axis",
            .unit = "m",
            .mean = 0.01,
            .sd = 0.01,
            .minimum = 0,
            .maximum = 0.5,
            .random = true,
            .acts_on_water = false,
            .blind = base.pipe ? "" : "there is no [pipe_flow], or its water is computed"};
  }
  void change(double theta, int, std::uint64_t seed, RunEdit& run) const override {
    const auto [x, y, z] = even_normal_deviates(seed);
    run.move_pieces({theta * x, theta * y, theta * z});
  }
};
[[maybe_unused]] const bool registered = effect_models().add<StartPlace>();

}  // namespace
}  // namespace snag
