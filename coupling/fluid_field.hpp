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
  /// Fluid at the particles of tile `index`, `elapsed` seconds into the step, without the answer to their forces in this step. Valid until
  /// the next call.
  virtual FluidSamples at(std::size_t index, const Tile& tile, double elapsed) = 0;
  /// True if the fluid answers to the forces on the particles.
  virtual bool answers() const { return false; }
};

}  // namespace snag
