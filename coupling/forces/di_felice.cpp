// Drag in a suspension of void fraction epsilon = 1 - solid fraction, at least 0.1 (coupling/suspension_drag.hpp):
//
//   F = 1/2 rho C_d A epsilon^(-1 - beta) |w| w,   C_d = (0.63 + 4.8/Re^(1/2))^2,   Re = rho |w| d/mu
//   beta = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2/2)
//
// Source: di Felice (1994), Int. J. Multiphase Flow 20, 153-159; C_d of Dallavalle (1948).
#include <algorithm>

#include "coupling/suspension_drag.hpp"

namespace snag {
namespace {

struct DiFelice final : SuspensionDrag {
  static constexpr const char* name = "di_felice";

  ForceDescription description() const override {
    return card_of(name, "F = 1/2 rho C_d A epsilon^(-1 - beta) |w| w, C_d = (0.63 + 4.8/Re^(1/2))^2", "di Felice (1994)",
                   "spheres, void fraction 0.4 to 1, all Re; solid fraction of a computed flow");
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    const double* solid = fluid.solid_fraction;
    add_sphere_drag(fluid, particles, forces, [=](double Re, int p) {
      const double root = 0.63 * std::sqrt(Re) + 4.8, x = 1.5 - log(std::max(Re, 1e-12)) / std::numbers::ln10;
      const double beta = 3.7 - 0.65 * exp(-0.5 * x * x);
      return factor * root * root * pow(void_fraction(solid[p]), -1 - beta);
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState dense = stokes_limit().state;
    dense.solid_fraction = 0.5;
    return {drag_at(1e-6, 24e6, 0.05, "Stokes (1851): F = 3 pi mu d w; the law of Dallavalle is 4 % below"),
            drag_at(100, 1.087, 0.14, "standard drag curve, Clift, Grace and Weber (1978)"),
            {.what = "suspension of half solids in creeping flow",
             .source = "Richardson and Zaki (1954): hindered settling with n = 4.65 to 4.8, F ~ epsilon^(-n)",
             .state = dense,
             .force = std::pow(0.5, -4.7) * stokes_limit().force,
             .tolerance = 0.08}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<DiFelice>();

}  // namespace
}  // namespace snag
