#pragma once
// The fluid's forces on the particles, sub-step by sub-step, and what they sum to.
//
//   M a = (F_other + F(u, v)) phi(theta)      M = m + m_a,  theta = h K/M;  K = dF/dw (secant), m_a added mass, h sub-step
//   phi = (1 + theta/6) / (1 + 2 theta/3 + theta^2/6) = (1 - exp(-theta))/theta + O(theta^3)
//   F_fluid = m a - F_other                   what the integrator adds to the other forces so that it kicks by a
//   J += h F_fluid                            impulse on each particle, N s
//   Q += h K phi m/M                          its sensitivity dJ/du, kg, for the implicit drag of the flow
//
// phi is the mean of the relaxation towards the fluid over a sub-step: third order in theta for a linear drag, and L-stable: a particle
// much lighter than its drag takes the fluid's velocity within one sub-step, without ringing. F_other must be complete: bonds, contacts and
// walls come before the fluid. Particles that a clamp holds (Tile::free = 0) feel the force without relaxing: phi = 1. Forces that do not
// react on the fluid (weight, buoyancy, pressure gradient) act on the particle and are left out of J.
// Torque likewise:  I dw/dt = (T_other + T) phi(h K_t/I).
// Source of phi: Pade approximant (1, 2) of exp, Hairer and Wanner (1996), Solving Ordinary Differential Equations II, IV.3.
#include <memory>

#include "coupling/fluid_field.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/nearest_wall.hpp"
#include "coupling/particle_list.hpp"
#include "dem/rag_system.hpp"

namespace snag {

using FluidForces = std::vector<std::unique_ptr<FluidForce>>;

class FluidLoad final : public TileForce {
 public:
  /// All arguments must outlive the load; `rags` are those that Tile::rag counts.
  FluidLoad(const FluidForces& forces, FluidField& field, const std::vector<Rag>& rags);

  /// Walls for forces that need them; `walls` must outlive the load.
  void set_walls(const WallSet& walls);
  /// What the forces need of the fluid.
  const SampleSet& needed() const { return needed_; }
  /// Samples the fluid at `time` (s) and sets all sums to zero. Collective.
  void begin_step(std::span<const Tile> tiles, double time);
  /// Numbers that the forces keep for each particle (Tile::memory).
  int memory() const { return memory_; }
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
  void evaluate(std::size_t index, Tile& tile, double step);
  void add_torque(Tile& tile, double step);
  double* array(int f) { return scratch_.data() + f * scratch_size_; }

  /// A force with what its card says.
  struct Member {
    const FluidForce* force;
    bool reacts;
    Role role;
    int memory_begin;
  };
  std::vector<Member> forces_;  // in the order in which they act
  FluidField& field_;
  const std::vector<Rag>& rags_;
  SampleSet needed_;
  bool all_react_ = true, torque_ = false, added_mass_ = false, changes_fluid_ = false;  // what the forces give
  int memory_ = 0;
  std::optional<NearestWall> nearest_wall_;
  double time_ = 0;               // at the start of the step, s
  std::vector<double> elapsed_;   // since the start of the step, by tile, s
  TileArrays sums_;               // J, Q
  AlignedDoubles scratch_;        // [n_arrays][scratch_size_]; fields that no force writes stay zero
  std::size_t scratch_size_ = 0;  // places of the largest tile
};

}  // namespace snag
