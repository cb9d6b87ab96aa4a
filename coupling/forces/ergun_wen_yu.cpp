// Drag in a suspension by Wen and Yu, in a packed bed by Ergun (coupling/suspension_drag.hpp):
//
//   F = K_e w for epsilon < 0.8, K_w w above
//
// The two do not meet at epsilon = 0.8: coupling/forces/gidaspow.cpp blends them.
// Source: Ergun (1952), Chem. Eng. Progr. 48, 89-94; Wen and Yu (1966), Chem. Eng. Progr. Symp. Ser. 62, 100-111.
#include "coupling/suspension_drag.hpp"

namespace snag {
namespace {

struct ErgunWenYu final : SuspensionDrag {
  static constexpr const char* name = "ergun_wen_yu";

  ForceDescription description() const override {
    return card_of(name, "F = K w by Ergun for epsilon < 0.8, by Wen and Yu above", "Ergun (1952), Wen and Yu (1966)",
                   "spheres, all Re; solid fraction of a computed flow");
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    const double* solid = fluid.solid_fraction;
    add_sphere_drag(fluid, particles, forces, [=](double Re, int p) {
      const double epsilon = void_fraction(solid[p]);
      return factor * (epsilon < 0.8 ? ergun(epsilon, Re) : wen_yu(epsilon, Re));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {stokes_limit(), drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)"), packed_bed(2e-3)};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<ErgunWenYu>();

}  // namespace
}  // namespace snag
