#include "coupling/exchange.hpp"

#include <algorithm>
#include <sstream>

#include "base/error.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {
constexpr double momentum_tolerance = 1e-10;  // of what was exchanged
}

double Exchange::spread_volumes(std::span<const double> volumes) {
  flow_.solid_fraction.assign(flow_.mesh.n_cells, 0.0);
  kernel_.spread(volumes, 1, flow_.solid_fraction);
  double largest = 0;
  for (const double fraction : flow_.solid_fraction) largest = std::max(largest, fraction);
  return maximum(flow_.mesh.comm, largest);
}

void Exchange::spread_screens(std::span<const double> screens) {
  const Mesh& mesh = flow_.mesh;
  flow_.screen.assign(static_cast<std::size_t>(mesh.n_all_cells()), 0.0);
  kernel_.spread(screens, 1, std::span(flow_.screen).first(static_cast<std::size_t>(mesh.n_cells)));
  mesh.halo.exchange(flow_.screen);
}

ExchangeBalance Exchange::spread_reaction(std::span<const Vec3> impulse, double dt) {
  const Mesh& mesh = flow_.mesh;
  std::vector<double> amounts(3 * impulse.size()), exchanged(impulse.size());
  for (std::size_t b = 0; b < impulse.size(); ++b) {
    for (int i = 0; i < 3; ++i) amounts[3 * b + i] = -impulse[b][i] / dt;
    exchanged[b] = norm(impulse[b]);
  }
  flow_.reaction.assign(mesh.n_cells, {});
  kernel_.spread(amounts, 3, std::span(mesh.n_cells > 0 ? &flow_.reaction[0].x : nullptr, 3 * static_cast<std::size_t>(mesh.n_cells)));
  std::vector<Vec3> applied;
  for (int c = 0; c < mesh.n_cells; ++c)
    if (flow_.reaction[c] != Vec3{}) applied.push_back(dt * mesh.cell_volume[c] * flow_.reaction[c]);
  return {.on_rags = sum(mesh.comm, impulse),
          .on_water = sum(mesh.comm, std::span<const Vec3>(applied)),
          .exchanged = sum(mesh.comm, std::span<const double>(exchanged))};
}

void check_momentum(const ExchangeBalance& balance) {
  const double lost = norm(balance.on_rags + balance.on_water);
  if (lost <= momentum_tolerance * balance.exchanged) return;
  std::ostringstream message;
  message << "coupling lost momentum: " << lost << " N s of " << balance.exchanged << " N s exchanged in this step, limit "
          << momentum_tolerance << " of it; do the kernel weights sum to 1?";
  throw Error(ExitCode::invariant, message.str());
}

}  // namespace snag
