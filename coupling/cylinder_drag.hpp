#pragma once
// Drag of a length l of a cylinder of the diameter d, w the slip across (n) or along (t) its axis:
//
//   F_n = mu l f_n w_n,   F_t = mu l f_t w_t
//
//   any length, across   f_n = C_n Re_n/2,   Re_n = rho |w_n| d/mu: what comes along the axis does not count (independence principle)
//       C_n = 8 pi/(Re_n s) (1 - 0.87 s^-2), s = ln(8/Re_n) - 0.0772      Re_n < 1
//             1.45 + 8.55 Re_n^-0.9                                       1 <= Re_n < 30
//             1.1 + 4 Re_n^-0.5                                           Re_n >= 30
//   cable, along         f_t = pi (0.55 Re^(1/2) + 0.084 Re^(2/3)),   Re = rho |w| d/mu
//   swept layer, along   f_t = 2.7 Re_n^(1/2): boundary layer that the flow across keeps thin
//   creeping flow, a cylinder of the length L = p d, p >= 2
//                        f_n = 4 pi/(ln p + 0.839 + 0.185/p + 0.233/p^2),   f_t = 2 pi/(ln p - 0.207 + 0.980/p - 0.133/p^2)
//                        f_t/f_n -> 1/2 for p -> infinity (slender bodies)
//
// Source: Casarella and Choo (1971), J. Hydronaut. 5, 3-10 (any length across, cable); Taylor (1952), Proc. R. Soc. A 214, 158-183
// (independence principle, swept layer); Tirado, Lopez Martinez and Garcia de la Torre (1984), J. Chem. Phys. 81, 2047-2052 (creeping flow,
// fitted for p from 2 to 30); Batchelor (1970), J. Fluid Mech. 44, 419-440 (slender bodies).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag::cylinder {

/// f_n of any length.
inline double across(double Re_n) {
  const double creeping_Re = std::clamp(Re_n, 1e-9, 1.0), s = log(8 / creeping_Re) - 0.077215665;
  const double creeping = 8 * std::numbers::pi / s * (1 - 0.87 / (s * s));
  const double large_Re = std::max(Re_n, 1.0);
  const double moderate = 1.45 * large_Re + 8.55 * pow(large_Re, 0.1), fast = 1.1 * large_Re + 4 * std::sqrt(large_Re);
  return 0.5 * (Re_n < 1 ? creeping : Re_n < 30 ? moderate : fast);
}
/// f_t of a cable.
inline double along_cable(double Re) { return std::numbers::pi * (0.55 * std::sqrt(Re) + 0.084 * pow(Re, 2.0 / 3)); }
/// f_t of a swept layer.
inline double along_swept(double Re_n) { return 2.7 * std::sqrt(Re_n); }

/// f_n and f_t in creeping flow; shorter cylinders than p = 2 count as that one.
struct Creeping {
  double across, along;
};
inline Creeping creeping(double length_over_diameter) {
  const double p = std::max(length_over_diameter, 2.0), slender = std::log(p);
  return {4 * std::numbers::pi / (slender + 0.839 + 0.185 / p + 0.233 / (p * p)),
          2 * std::numbers::pi / (slender - 0.207 + 0.980 / p - 0.133 / (p * p))};
}

/// Which law holds along the axis beyond creeping flow.
enum class Along { cable, swept };

/// Force and its slope, the larger of mu l f_n and mu l f_t.
struct Drag {
  Vec3 force;
  double slope;
};
/// Of a length whose axis has the direction t, with mu l; its slip w has the Reynolds number `per_speed` |w|, and its f_n and f_t are not
/// below `least`. Without an axis (t = 0) all slip is across.
template <Along law>
inline Drag drag(const Vec3& w, const Vec3& t, double per_speed, double mu_l, const Creeping& least) {
  const Vec3 w_t = dot(w, t) * t, w_n = w - w_t;
  const double Re = per_speed * std::sqrt(norm_squared(w)), Re_n = per_speed * std::sqrt(norm_squared(w_n));
  const double K_n = mu_l * std::max(across(Re_n), least.across);
  const double K_t = mu_l * std::max(law == Along::cable ? along_cable(Re) : along_swept(Re_n), least.along);
  return {K_n * w_n + K_t * w_t, std::max(K_n, K_t)};
}

/// Measured drag across the flow, of a particle that stands for the length of its diameter.
inline std::vector<ReferenceCase> measured_across() {
  std::vector<ReferenceCase> cases;
  for (const auto& [Re, C_d, tolerance] : {std::array{100.0, 1.45, 0.08}, std::array{1e4, 1.1, 0.08}, std::array{10.0, 2.8, 0.1}}) {
    auto one = drag_at(Re, 0, tolerance, "Wieselsberger (1921), as given by Tritton (1959): circular cylinder across the flow");
    one.state.next_in_row = {0, 0, one.state.diameter};
    const double speed = norm(one.state.velocity), d = one.state.diameter;
    one.force = {0.5 * one.state.fluid_density * C_d * d * d * speed * speed, 0, 0};
    cases.push_back(one);
  }
  return cases;
}

}  // namespace snag::cylinder
