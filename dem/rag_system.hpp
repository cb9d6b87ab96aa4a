#pragma once
// All cloth of a run: tiles owned by this rank, their halo, bonds, contacts and walls, advanced in stable sub-steps.
#include <functional>
#include <memory>
#include <vector>

#include "dem/rag.hpp"
#include "dem/tile.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;

/// A force from outside (the fluid) on the particles of an owned tile, added once a sub-step to fx .. tz of all its particles.
class TileForce {
 public:
  virtual ~TileForce() = default;
  /// `index`: place of the tile in RagSystem::tiles(); `step`: length of the sub-step, s.
  virtual void add(std::size_t index, Tile& tile, double step) = 0;
};

}  // namespace snag
