#pragma once
// The fluid's forces on the particles, sub-step by sub-step, and what they sum to.
//
//   M dv/dt = F_other + F,   du/dt = r - d (F - m_a dv/dt),   F = F_0 + K (w - w_0),   w = u - v
//   F -> phi F_0 + h K chi (r - F_other/M),  theta = h K (1/M + d + e)     mean over a sub-step h
//   phi = (1 + theta/6)/(1 + 2 theta/3 + theta^2/6) = (1 - exp(-theta))/theta + O(theta^3),   chi = (1 - phi)/theta
//   J += h (m dv/dt - F_other)                                            impulse of the water on each particle, N s
//
// K = dF/dw (secant) by the slip of the samples, m_a added mass, M = m + m_a; r and d: how the water at the particle goes on and answers to
// the particle within the step (coupling/water_prediction.hpp); r = r_0 + G v on the way of the particle, d = 0 one-way; e: slip that the
// law itself takes off per impulse (Forces::relief). phi is the mean of the relaxation of water and particle towards each other: third
// order in theta for a linear drag, and L-stable: a particle much lighter than its drag takes the fluid's velocity within one sub-step,
// without ringing. F_other must be complete: bonds, contacts and walls come before the fluid. Particles that a clamp holds (Tile::free
// below 1/2) count as infinitely heavy; where their hold moves, - m_a dv/dt of its motion is part of F. Forces that do not react on the
// fluid (weight, buoyancy, pressure gradient) act on the particle and are left out of J. Torque likewise:  I dw/dt = (T_other + T) phi(h
// K_t/I). Source of phi: Pade approximant (1, 2) of exp, Hairer and Wanner (1996), Solving Ordinary Differential Equations II, IV.3.
#include <memory>

#include "coupling/fluid_field.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/nearest_wall.hpp"
#include "coupling/particle_list.hpp"
#include "dem/rag_system.hpp"
#include "solver/fields/time_scheme.hpp"

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
  /// After a step of a fluid that answers: keeps the impulses of the step and what the answer in the next one is predicted with
  /// (KernelField::missed_rates), m/s2.
  void end_step(std::span<Tile> tiles, std::span<const Vec3> missed_rates);
  /// Numbers that the forces keep for each particle (Tile::particle_state).
  int n_particle_state() const { return n_particle_state_; }
  void add(std::size_t index, Tile& tile, double step) override;

  /// J of the particle at place k of a tile, N s.
  Vec3 impulse(std::size_t index, int k) const;
  /// Integral of the slope K of that particle over the step, kg.
  double slope(std::size_t index, int k) const;
  /// Whether a force gives screens; and that of a particle, mean over the step, m2.
  bool gives_screen() const { return screen_; }
  double screen(std::size_t index, int k) const;
  /// J of all particles of this rank, N s.
  std::vector<Vec3> impulses(std::span<const Tile> tiles) const;
  /// What a fluid that answers is given: I = now J - older J^old, N s (coupling/exchange.hpp).
  std::vector<Vec3> given(std::span<const Tile> tiles, const TimeScheme& time) const;
  /// J with what the water gives and does not feel, as the pressure gradient, which would push water in their place, too. Without
  /// weight and buoyancy.
  std::vector<Vec3> impulses_with_unfelt(std::span<const Tile> tiles) const;
  /// Largest dt K/m of this rank's particles: above 1 a particle follows the water within one step of the flow.
  double max_stiffness(std::span<const Tile> tiles) const;

 private:
  FluidSamples evaluate(std::size_t index, Tile& tile, double step);
  void follow(FluidSamples& fluid, std::size_t index, Tile& tile, const Particles& particles);
  void add_torque(Tile& tile, double step);
  void keep_drag(Tile& tile, const FluidSamples& fluid, const Particles& particles);
  double* state(Tile& tile, int i) const { return tile.particle_state.data() + i * tile.exists.size(); }
  double* last_impulse(Tile& tile, int i) const { return state(tile, impulse_begin_ + i); }
  double* array(int f) { return scratch_.data() + f * scratch_size_; }

  /// A force with what its description says.
  struct Member {
    const FluidForce* force;
    bool reacts, is_unfelt;
    Role role;
    int state_begin;
  };
  std::vector<Member> forces_;  // in the order in which they act
  FluidField& field_;
  const std::vector<Rag>& rags_;
  SampleSet needed_;
  bool all_react_ = true, unfelt_ = false, torque_ = false, added_mass_ = false, changes_fluid_ = false,
       screen_ = false;  // what the forces give
  bool needs_impulse_ = false, needs_drag_ = false;
  int n_particle_state_ = 0, impulse_begin_ = 0, drag_begin_ = 0, missed_rate_begin_ = -1, step_impulse_begin_ = -1;
  std::optional<NearestWall> nearest_wall_;
  double time_ = 0;               // at the start of the step, s
  std::vector<double> elapsed_;   // since the start of the step, by tile, s
  TileArrays sums_;               // J, integral of K, impulse of what the water does not feel
  AlignedDoubles scratch_;        // [n_arrays][scratch_size_]; fields that no force writes stay zero
  std::size_t scratch_size_ = 0;  // places of the largest tile
};

}  // namespace snag
