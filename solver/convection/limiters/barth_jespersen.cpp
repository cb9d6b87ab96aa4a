// Limiter of Barth and Jespersen:   psi = min(1, b/a)        a, b: solver/convection/cell_limiter.hpp
// Source: Barth and Jespersen (1989), AIAA paper 89-0366.
#include "solver/convection/cell_limiter.hpp"

namespace snag {
namespace {

struct BarthJespersen final : CellLimiter<BarthJespersen> {
  static constexpr const char* name = "barth_jespersen";

  LimiterDescription description() const override { return {"psi = min(1, y)", "Barth and Jespersen 1989"}; }
  static FourValues factor(const FourValues& a, const FourValues& b, double) { return b / a; }
};
const bool registered = limiters().add<BarthJespersen>();

}  // namespace
}  // namespace snag
