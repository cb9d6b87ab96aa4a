#pragma once
// Meshes and frozen water that many runs of one process share, as those of a diagnosis do: read and started once, not at every run.
// Runs that share are made one after another.
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "coupling/known_factors.hpp"
#include "mesh/mesh.hpp"
#include "mesh/quality.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

struct CachedMesh {
  std::shared_ptr<Mesh> mesh;  // null: not read yet
  MeshQuality quality;
  KnownFactors kernel_factors;  // of its cells
};

struct CachedFlow {
  std::shared_ptr<FlowSolver> solver;  // null: not made yet
  std::optional<Flow> as_started;      // at velocity_factor = 1
};

/// By all that decides about them, as text.
struct FlowCache {
  std::map<std::string, CachedMesh> meshes;
  std::map<std::string, CachedFlow> flows;
};

}  // namespace snag
