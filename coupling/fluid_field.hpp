#pragma once
// The fluid as the particles see it: averaged from the cells of the flow (coupling/kernel_field.hpp), or prescribed
// (coupling/prescribed_field.hpp).
#include <cstddef>
#include <span>

#include "coupling/fluid_force.hpp"

namespace snag {

/// Arrays in which fields keep the fluid at the particles: the first component of each.
namespace sampled {
enum Array {
  velocity = 0,
  gradient = 3,
  pressure_gradient = 12,
  acceleration = 15,
  k = 18,
  epsilon = 19,
  k_gradient = 20,
  solid = 23,
  width = 24,
  change = 25,
  response = 28,
  coverage = 29,
  start = 30,
  n_fields = 33
};
inline constexpr double undisturbed = 1e9;  // disturbance width where the particle's own force is not in the fluid, m
}  // namespace sampled

class FluidField {
 public:
  virtual ~FluidField() = default;
  /// The fluid for the step that begins, with the particles where they are now. Collective.
  virtual void sample(std::span<const Tile> tiles, const SampleSet& needed) = 0;
  /// Fluid at the particles of tile `index`, `elapsed` seconds into the step, without the answer to their forces in this step. Valid until
  /// the next call.
  virtual FluidSamples at(std::size_t index, const Tile& tile, double elapsed) = 0;
};

}  // namespace snag
