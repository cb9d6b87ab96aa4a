// Scale of the camera: every length in a picture is (1 + theta) times the true one, about the origin of the coordinates; areas go with the
// square, ratios and angles do not change. Calibrations of a camera in water are wrong by some per cent when refraction is left out.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct Measurement final : EffectModel {
  static constexpr const char* name = "measurement";

  Effect effect(const BaseCase&) const override {
    return {.name = name,
            .parameter = "relative error of the camera's scale",
            .unit = "1",
            .mean = 0.03,
            .sd = 0.03,
            .minimum = -0.3,
            .maximum = 0.3,
            .random = false,
            .acts_on_water = false,
            .blind = {}};
  }
  void change(double theta, std::uint64_t, RunChange& run) const override { run.picture_scale *= 1 + theta; }
};
[[maybe_unused]] const bool registered = effect_models().add<Measurement>();

}  // namespace
}  // namespace snag
