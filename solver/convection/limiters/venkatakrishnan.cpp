// Limiter of Venkatakrishnan, each component of velocity by itself. Equation and source: solver/convection/limiters/venkatakrishnan.hpp
#include "solver/convection/limiters/venkatakrishnan.hpp"

#include "solver/convection/cell_limiter.hpp"

namespace snag {
namespace {

struct Venkatakrishnan final : CellLimiter<Venkatakrishnan> {
  static constexpr const char* name = "venkatakrishnan";

  LimiterDescription description() const override {
    return {"psi = (y^2 + 2 y)/(y^2 + y + 2), and near 1 where the velocity varies little, which keeps second order",
            "Venkatakrishnan 1995"};
  }
  static FourValues factor(const FourValues& a, const FourValues& b, double e2) { return venkatakrishnan_factor(a, b, e2); }

 protected:
  double threshold(const Mesh& mesh, double reference_speed) const override { return venkatakrishnan_threshold(mesh, reference_speed); }
};
const bool registered = limiters().add<Venkatakrishnan>();

}  // namespace
}  // namespace snag
