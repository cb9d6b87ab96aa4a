// Drag in a suspension by Wen and Yu, in a packed bed by Ergun (coupling/suspension_drag.hpp), with a smooth passage:
//
//   F = (1 - s) K_e w + s K_w w,   s = 1/2 + arctan(150 * 1.75 (epsilon - 0.8))/pi
// Source: Gidaspow (1994), Multiphase Flow and Fluidization; passage of Huilin and Gidaspow (2003), Chem. Eng. Sci. 58, 3777-3792.
#include "coupling/suspension_drag.hpp"

namespace snag {
namespace {

struct Gidaspow final : SuspensionDrag {
  static constexpr const char* name = "gidaspow";

  ForceDescription description() const override {
    return card_of(name, "F = ((1 - s) K_Ergun + s K_WenYu) w, s = 1/2 + arctan(262.5 (epsilon - 0.8))/pi",
                   "Gidaspow (1994), Huilin and Gidaspow (2003)", "spheres, all Re; solid fraction of a computed flow");
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    const double* solid = fluid.solid_fraction;
    add_sphere_drag(fluid, particles, forces, [=](double Re, int p) {
      const double epsilon = void_fraction(solid[p]);
      const double s = 0.5 + std::atan(150 * 1.75 * (epsilon - 0.8)) / std::numbers::pi;
      return factor * ((1 - s) * ergun(epsilon, Re) + s * wen_yu(epsilon, Re));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {drag_at(1e-6, 24e6, 0.01, "Stokes (1851); the passage leaves 0.6 % of Ergun's law"),
            drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)"), packed_bed(0.05)};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Gidaspow>();

}  // namespace
}  // namespace snag
