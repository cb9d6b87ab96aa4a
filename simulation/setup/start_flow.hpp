#pragma once
// A start from the water of another run: its newest checkpoint gives the initial velocity, pressure, k and epsilon. The water goes on from
// there, or stays as it is (frozen) and carries rags that it does not feel.
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
  bool map_nearest_cell = false;
  bool frozen = false;
  double velocity_factor = 1;
  Section section();
};

/// Velocities times a factor, with all that follows from them in a flow where only convection counts: p with its square, k too, epsilon
/// with its cube. `as_started`: the state at factor 1, on the same mesh.
void scale_flow(Flow& flow, const Flow& as_started, double factor);

struct StartedFlow {
  std::string log_message;  // a line for the log
  double time;              // of the other run at which its water was taken, s
};

/// Sets the initial fields. Collective. Throws Error(io) where `folder` holds no valid checkpoint, Error(usage)
/// where its cells are not those of this mesh.
StartedFlow start_flow(FlowSolver& water, const StartSettings& settings, const std::filesystem::path& folder);

/// What such a start needs of a checkpoint in addition to the fields: where the cells are. Collective.
void save_cell_centres(CheckpointWriter& checkpoint, const Mesh& mesh);

}  // namespace snag
