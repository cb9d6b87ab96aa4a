// Limiter of Michalak and Ollivier-Gooch:   psi = y - 4/27 y^3 up to y = 3/2, 1 above,   y = b/a    a, b:
// solver/convection/cell_limiter.hpp
//
// The cubic with psi = 0, dpsi/dy = 1 at y = 0 and psi = 1, dpsi/dy = 0 at y = 3/2: smooth where that of Barth and Jespersen has a kink,
// and exactly 1 where neighbours leave half as much again as the face needs. It leaves out the threshold of the source, which switches the
// limiter off in smooth regions: smooth extrema are limited. Source: Michalak and Ollivier-Gooch (2009), J. Comput. Phys. 228, 8693;
// y = 3/2 and the threshold are not checked against the paper.
#include "solver/convection/cell_limiter.hpp"

namespace snag {
namespace {

struct MichalakOllivierGooch final : CellLimiter<MichalakOllivierGooch> {
  static constexpr const char* name = "michalak_ollivier_gooch";

  LimiterDescription description() const override {
    return {"psi = y - 4/27 y^3 up to y = 3/2, then 1; smooth, without a threshold", "Michalak and Ollivier-Gooch 2009"};
  }
  static FourValues factor(const FourValues& a, const FourValues& b, double) {
    const FourValues y = least(b / a, FourValues{1.5, 1.5, 1.5, 1.5});
    return y - 4.0 / 27 * y * y * y;
  }
};
const bool registered = limiters().add<MichalakOllivierGooch>();

}  // namespace
}  // namespace snag
