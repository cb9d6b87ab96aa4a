// Limiter of Venkatakrishnan:
//
//   psi = ((b^2 + e^2) + 2 a b) / (b^2 + 2 a^2 + a b + e^2),    e^2 = K^3 (V/V_total) U^2        a, b: solver/convection/cell_limiter.hpp
//
// e is Venkatakrishnan's threshold (K h)^3 made dimensionless with the volume of the domain and the speed U: a smooth extremum, where
// |b| ~ h^2 u'', is limited by O(h^2) only and the scheme stays second order.
// Source: Venkatakrishnan (1995), J. Comput. Phys. 118, 120. The value of K is not checked against the paper.
#include "parallel/sum.hpp"
#include "solver/convection/cell_limiter.hpp"

namespace snag {
namespace {

constexpr double smooth_cells = 5;  // K, in the range that is usual

struct Venkatakrishnan final : CellLimiter<Venkatakrishnan> {
  static constexpr const char* name = "venkatakrishnan";

  LimiterDescription description() const override {
    return {"psi = (y^2 + 2 y)/(y^2 + y + 2), and near 1 where the velocity varies little, which keeps second order",
            "Venkatakrishnan 1995"};
  }
  static FourValues factor(const FourValues& a, const FourValues& b, double e2) {
    const FourValues b2 = b * b + e2, ab = a * b;
    return (b2 + 2 * ab) / (b2 + 2 * a * a + ab);
  }

 protected:
  double threshold(const Mesh& mesh, double reference_speed) const override {
    double volume = 0;
    for (int c = 0; c < mesh.n_cells; ++c) volume += mesh.cell_volume[c];
    return smooth_cells * smooth_cells * smooth_cells * reference_speed * reference_speed / sum(mesh.comm, volume);
  }
};
const bool registered = limiters().add<Venkatakrishnan>();

}  // namespace
}  // namespace snag
