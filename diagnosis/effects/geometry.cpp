// Geometry of casing and vane: a prescribed flow has none. Of a generated mesh each number that [mesh] set gives may be a candidate of the
// experiment file, or an uncertain input, at mesh.set.NAME (casework/point_case.hpp): no single number stands for the geometry.
#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

struct Geometry final : EffectModel {
  static constexpr const char* name = "geometry";

  Effect effect(const CaseFeatures& base) const override {
    return {.name = name,
            .parameter = "relative change of the gap at the tongue",
            .unit = "1",
            .mean = 0.2,
            .sd = 0.2,
            .minimum = -0.9,
            .maximum = 4,
            .random = false,
            .acts_on_water = false,
            .blind = base.prescribed ? "a prescribed flow has no casing"
                                     : "name numbers of the mesh, such as mesh.set.tongue_gap, as a [[candidate]] or in input_u"};
  }
  void change(double, int, std::uint64_t, RunEdit&) const override {}
};
[[maybe_unused]] const bool registered = effect_models().add<Geometry>();

}  // namespace
}  // namespace snag
