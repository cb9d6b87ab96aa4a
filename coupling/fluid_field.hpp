#pragma once
// The fluid as the particles see it: averaged from the cells of the flow (coupling/kernel_field.hpp), or prescribed
// (coupling/prescribed_field.hpp).
#include <cstddef>
#include <span>

#include "coupling/fluid_force.hpp"

namespace snag {

class FluidField {
 public:
  virtual ~FluidField() = default;
  /// The fluid for the step that begins, with the particles where they are now. Collective.
  virtual void sample(std::span<const Tile> tiles, const SampleSet& needed) = 0;
  /// Fluid at the particles of tile `index` for the sub-step of length `step` that begins `elapsed` seconds into the step, without the
  /// answer to their forces in this step: the velocity at the start of the sub-step, where they were half of it ago, with its rate; all
  /// else in the middle, where they are. With FluidSamples::start all is that of the start of the step. Valid until the next call.
  virtual FluidSamples at(std::size_t index, const Tile& tile, double elapsed, double step) = 0;
  /// True if the fluid answers to the forces on the particles.
  virtual bool answers() const { return false; }
};

}  // namespace snag
