#include "coupling/exchange.hpp"

#include <algorithm>
#include <sstream>

#include "base/error.hpp"
#include "base/flat.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {
constexpr double momentum_tolerance = 1e-10;  // of what was exchanged
}

Exchange::Exchange(const Kernel& kernel, Flow& flow, bool two_way, bool screens)
    : kernel_(kernel), flow_(flow), two_way_(two_way), screens_(screens) {
  const auto n_cells = static_cast<std::size_t>(flow.mesh.n_cells);
  flow.reaction.resize(n_cells), flow.solid_fraction.resize(n_cells);
}

ExchangeBalance Exchange::spread(const ParticleAmounts& amounts, double dt) {
  const Mesh& mesh = flow_.mesh;
  flow_.solid_fraction.assign(mesh.n_cells, 0.0);
  std::vector<CellSums> fields{{flow_.solid_fraction.data(), 1}};
  if (screens_) {
    flow_.screen.assign(static_cast<std::size_t>(mesh.n_all_cells()), 0.0);
    fields.push_back({flow_.screen.data(), 1});
  }
  if (two_way_) {
    flow_.reaction.assign(mesh.n_cells, {});
    fields.push_back({flat(flow_.reaction).data(), 3});
  }
  std::vector<double> of_particles;
  for (std::size_t b = 0; b < amounts.volume.size(); ++b) {
    of_particles.push_back(amounts.volume[b]);
    if (screens_) of_particles.push_back(amounts.screen[b]);
    for (int i = 0; two_way_ && i < 3; ++i) of_particles.push_back(-amounts.given[b][i] / dt);
  }
  kernel_.spread(of_particles, fields);
  if (screens_) mesh.halo.exchange(flow_.screen);
  const auto largest = std::max_element(flow_.solid_fraction.begin(), flow_.solid_fraction.end());
  ExchangeBalance balance;
  balance.max_solid_fraction = maximum(mesh.comm, largest != flow_.solid_fraction.end() ? *largest : 0);
  if (!two_way_) return balance;
  std::vector<Vec3> applied;
  for (int c = 0; c < mesh.n_cells; ++c)
    if (flow_.reaction[c] != Vec3{}) applied.push_back(dt * mesh.cell_volume[c] * flow_.reaction[c]);
  std::vector<double> exchanged;
  for (const Vec3& impulse : amounts.given) exchanged.push_back(norm(impulse));
  balance.on_rags = sum(mesh.comm, amounts.given);
  balance.on_water = sum(mesh.comm, std::span<const Vec3>(applied));
  balance.exchanged = sum(mesh.comm, std::span<const double>(exchanged));
  return balance;
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
