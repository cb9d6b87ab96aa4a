// No limiter:   psi = 1
#include <algorithm>

#include "solver/convection/limiter.hpp"

namespace snag {
namespace {

struct NoLimiter final : Limiter {
  static constexpr const char* name = "none";

  LimiterDescription description() const override { return {"psi = 1, not bounded", ""}; }
  bool bounds() const override { return false; }
  void limit(const LimiterInputs&, std::vector<Vec3>& psi) const override { std::fill(psi.begin(), psi.end(), Vec3{1, 1, 1}); }
};
const bool registered = limiters().add<NoLimiter>();

}  // namespace
}  // namespace snag
