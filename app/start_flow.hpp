#pragma once
// A start from the water of another run: its newest checkpoint gives the initial velocity, pressure, k and epsilon.
//
// The cells are found by their number in the mesh file, on any number of ranks; or, where the meshes differ, by the nearest centre (first
// order in the cells' width; the start of the solver takes the divergence out). Time begins at 0; nothing of the other run's history is
// taken over, so that the first step is of first order.
#include <filesystem>
#include <string>

#include "base/parameter.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;

struct StartSettings {
  std::string from;  // output folder of the other run, relative to the case file; empty: no such start
  bool map = false;
  Section section();
};

/// Sets the initial fields; returns a line for the log. Collective. Throws Error(io) where `folder` holds no valid checkpoint, Error(usage)
/// where its cells are not those of this mesh.
std::string start_flow(FlowSolver& water, const StartSettings& settings, const std::filesystem::path& folder);

/// What such a start needs of a checkpoint beside the fields: where the cells are. Collective.
void save_cell_centres(CheckpointWriter& checkpoint, const Mesh& mesh);

}  // namespace snag
