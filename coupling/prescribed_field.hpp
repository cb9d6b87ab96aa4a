#pragma once
// A flow that is given as a formula and feels nothing: single spheres and fibres without a mesh.
//
//   u_i(x, t) = velocity_i + sum_j gradient_ij x_j + amplitude_i sin(omega_i t + phase_i) + modes of [pipe_flow]
//   k(x) = max(k_0 + x . grad k, 0),   epsilon uniform
//   Du/Dt = du/dt + G u,    grad p = -rho Du/Dt + mu lap u = -rho Du/Dt      (beside the hydrostatic)
//
// Evaluated on the way of the particles in every sub-step of length h, in whose middle they are at x_m: u_0 = u(x_m - h/2 v, t),
// u_m = u(x_m, t + h/2), and the rate du/dt + G v on their way is 2 (u_m - u_0)/h, to the second order of h.
#include "coupling/fluid_field.hpp"
#include "coupling/particle_list.hpp"
#include "coupling/pipe_flow.hpp"

namespace snag {

/// [flow] with kind = "prescribed".
struct PrescribedFlow {
  std::string kind = "prescribed";
  double density = 998.2;                                        // kg/m3
  std::optional<double> dynamic_viscosity, kinematic_viscosity;  // Pa s, m2/s: one of them, or water at 20 degrees
  Vec3 velocity;                                                 // m/s
  Mat3 gradient{};                                               // 1/s
  Vec3 amplitude, omega, phase;                                  // m/s, rad/s, rad
  double turbulent_kinetic_energy = 0, dissipation_rate = 0;     // k at the origin, m2/s2; epsilon, m2/s3
  Vec3 turbulent_kinetic_energy_gradient;                        // m/s2
  PipeFlow pipe;                                                 // a table of its own

  Section section();
  /// U of the pipe, m/s.
  double pipe_speed() const { return dot(velocity, pipe.axis); }
  /// Throws Error(usage) if both viscosities are given.
  double viscosity() const;  // mu, Pa s
  /// Throws Error(usage) if the flow makes or takes volume.
  void check_divergence() const;
};

class PrescribedField final : public FluidField {
 public:
  /// Throws Error(usage) for a flow that cannot be.
  explicit PrescribedField(const PrescribedFlow& flow);
  /// Time at the start of the step that comes, s.
  void set_time(double time) { time_ = time; }
  void sample(std::span<const Tile> tiles, const SampleSet& needed) override;
  FluidSamples at(std::size_t index, const Tile& tile, double elapsed, double step) override;

 private:
  /// The part of u that is the same everywhere, m/s, and its derivative in time, m/s2.
  Vec3 uniform_velocity(double t) const;
  Vec3 uniform_rate(double t) const;
  /// u at the time t where the particles of a tile were a time `ago`.
  void set_velocity(const VectorSum& u_at, const Tile& tile, double t, double ago) const;
  /// G with the modes of the pipe, where the particles are.
  void set_gradient(const std::array<VectorSum, 3>& G_at, const Tile& tile) const;

  PrescribedFlow flow_;
  double viscosity_, time_ = 0;
  SampleSet needed_;
  TileArrays arrays_;
};

}  // namespace snag
