#include "simulation/output/rag_forces.hpp"

#include <algorithm>
#include <numeric>

#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/rows.hpp"

namespace snag {

namespace {

struct Magnitudes {
  int rag;
  double fluid, contact;
};

ForceSpread spread_of(std::vector<double> magnitudes) {
  if (magnitudes.empty()) return {};
  std::sort(magnitudes.begin(), magnitudes.end());  // the sum is then the same whatever the ranks
  const auto n = static_cast<double>(magnitudes.size());
  const auto quantile = [&](double p) { return magnitudes[std::min(static_cast<std::size_t>(p * n), magnitudes.size() - 1)]; };
  return {std::accumulate(magnitudes.begin(), magnitudes.end(), 0.0) / n, quantile(0.5), quantile(0.9), quantile(0.99), magnitudes.back()};
}

}  // namespace

RagForces rag_forces(RagSystem& rags, const CoupledSolver* coupled, double step) {
  RagForces forces;
  if (coupled) forces.fluid = coupled->impulses();
  for (Vec3& impulse : forces.fluid) impulse = impulse / step;
  if (rags.contacts()) forces.contact = rags.contacts()->forces(rags.tiles());
  std::size_t n = 0;
  for (const Tile& tile : rags.tiles()) for_particles(tile, [&](int, int, int) { ++n; });
  forces.fluid.resize(n), forces.contact.resize(n);  // none yet, or none at all
  return forces;
}

std::vector<RagForceSpread> force_spreads(const RagSystem& rags, const RagForces& forces) {
  std::vector<Magnitudes> mine;
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int, int, int) {
      const std::size_t b = mine.size();
      mine.push_back({tile.rag, norm(forces.fluid[b]), norm(forces.contact[b])});
    });
  std::vector<std::vector<double>> fluid(rags.rags().size()), contact(rags.rags().size());
  for (const Magnitudes& one : gathered_on_first(rags.comm(), mine)) {
    fluid[one.rag].push_back(one.fluid);
    if (one.contact > 0) contact[one.rag].push_back(one.contact);
  }
  std::vector<RagForceSpread> spreads;
  for (std::size_t rag = 0; rag < fluid.size(); ++rag) {
    const auto n_in_contact = static_cast<std::int64_t>(contact[rag].size());
    spreads.push_back({spread_of(std::move(fluid[rag])), spread_of(std::move(contact[rag])), n_in_contact});
  }
  return spreads;
}

}  // namespace snag
