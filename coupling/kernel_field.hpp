#pragma once
// The water of the flow solver at the particles: kernel averages, frozen over the sub-steps of one fluid step.
//
//   Du/Dt = (u^n - u^(n-1))/dt + G u      from the last step's length dt; before the first step the flow counts as steady
#include "coupling/fluid_field.hpp"
#include "coupling/kernel.hpp"
#include "coupling/particle_list.hpp"
#include "solver/flow.hpp"

namespace snag {

class KernelField final : public FluidField {
 public:
  KernelField(const Flow& flow, Kernel& kernel) : flow_(flow), kernel_(kernel) {}
  /// Length of the step that led to the present state, s; 0: none yet.
  void set_last_step(double dt) { last_step_ = dt; }
  double last_step() const { return last_step_; }
  void sample(std::span<const Tile> tiles, const SampleSet& needed) override;
  FluidSamples at(std::size_t index, const Tile& tile, double elapsed) override;
  /// The particles of the last sample(), in the order of the kernel.
  const ParticleList& particles() const { return particles_; }

 private:
  const Flow& flow_;
  Kernel& kernel_;
  double last_step_ = 0;
  ParticleList particles_;
  std::vector<Vec3> acceleration_;  // Du/Dt of the owned cells, m/s2
  TileArrays arrays_;
};

}  // namespace snag
