// Scale of the camera: every length in a picture is (1 + theta) times the true one, about a centre that nobody tells: the origin of the
// coordinates, give or take the size of the picture in each direction. Areas go with the square, ratios and angles do not change.
// Calibrations of a camera in water are wrong by some per cent when refraction is left out.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct Measurement final : EffectModel {
  static constexpr const char* name = "measurement";

  Effect effect(const CaseFeatures&) const override {
    return {.name = name,
            .parameter = "relative error of the camera's scale",
            .unit = "1",
            .mean = 0.03,
            .sd = 0.03,
            .minimum = -0.3,
            .maximum = 0.3,
            .random = false,
            .acts_on_water = false,
            .blind = {},
            .n_deviations = 3};
  }
  void change(double theta, int form, std::uint64_t, RunEdit& run) const override { run.scale_picture(1 + theta, form - 1); }
};
[[maybe_unused]] const bool registered = effect_models().add<Measurement>();

}  // namespace
}  // namespace snag
