// Bonds whose four stiffnesses are constants.
#include "dem/bonds/tile_bonds.hpp"

namespace snag {

namespace {

struct LinearBond {
  BondCoefficients coefficients;

  template <int direction, bool damped>
  [[gnu::always_inline]] BondForce force(const BondEnd& one, const BondEnd& two) const {
    return bond_force<direction, damped>(coefficients, one, two);
  }
};

}  // namespace

std::unique_ptr<PieceBonds> linear_bonds(const std::array<BondCoefficients, 2>& coefficients) {
  return std::make_unique<TileBonds<LinearBond>>(std::array<LinearBond, 2>{{{coefficients[0]}, {coefficients[1]}}});
}

}  // namespace snag
