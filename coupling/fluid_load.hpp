#pragma once
// The fluid's forces on the particles, sub-step by sub-step, and what they sum to.
//
//   (m + m_a + h/2 K) a = F_other + F(u, v)       K = dF/dw (secant), m_a added mass, h sub-step: the drag of the mean velocity v + h/2 a
//   F_fluid = m a - F_other                       what the integrator adds to the other forces so that it kicks by a
//   J += h F_fluid,  Q += h K                     impulse on each particle (N s), and its sensitivity dJ/du (kg) for the implicit drag of
//   the flow
//
// Second order in h, and stable for any h K/m. F_other must be complete: bonds, contacts and walls come before the fluid.
// Forces that do not react on the fluid (weight and buoyancy) act on the particle and are left out of J.
#include <memory>

#include "coupling/fluid_field.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/particle_list.hpp"
#include "dem/rag_system.hpp"

namespace snag {

using FluidForces = std::vector<std::unique_ptr<FluidForce>>;

class FluidLoad final : public TileForce {
 public:
  /// All arguments must outlive the load; `rags` are those that Tile::rag counts.
  FluidLoad(const FluidForces& forces, FluidField& field, const std::vector<Rag>& rags);

  /// Samples the fluid and sets all sums to zero. Collective.
  void begin_step(std::span<const Tile> tiles);
  void add(std::size_t index, Tile& tile, double step) override;

  /// J of the particle at place k of a tile, N s.
  Vec3 impulse(std::size_t index, int k) const;
  /// Q of that particle, kg: divided by the step, the mean slope K.
  double sensitivity(std::size_t index, int k) const;
  /// J of all particles of this rank, N s.
  std::vector<Vec3> impulses(std::span<const Tile> tiles) const;
  /// Largest Q/m of this rank's particles: above 1 the particle would follow the water within one step of the flow.
  double max_stiffness(std::span<const Tile> tiles) const;

 private:
  const FluidForces& forces_;
  FluidField& field_;
  const std::vector<Rag>& rags_;
  SampleSet needed_;
  std::vector<bool> reacts_;     // by force
  std::vector<double> elapsed_;  // since the start of the step, by tile, s
  TileArrays sums_;              // J, Q
  AlignedDoubles scratch_;
};

}  // namespace snag
