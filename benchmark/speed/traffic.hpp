#pragma once
// Estimate of what a time step of the flow moves between memory and processor.
//
//   bytes = sum over loops of (n_faces b_face + n_cells b_cell)
//
// Every array that a loop over faces or cells touches is counted once a loop: 8 bytes a number read or written, 16 where it is read and
// written, 4 an index. Cells of neighbouring faces are taken to stay in the cache within a loop (bandwidth-reducing order), and nothing
// from one loop to the next. So a mesh that fits into the cache can be faster than this limit, and fused loops would lower it. Boundary
// faces are left out; so is the turning of the mesh, which is bound by computing.
#include "solver/flow_solver.hpp"

namespace snag {

/// Bytes of one step.
struct Traffic {
  double momentum = 0, pressure = 0, turbulence = 0, rest = 0;
  double total() const { return momentum + pressure + turbulence + rest; }
};

/// Of a step with linear-upwind convection and k-epsilon, with the sweeps and iterations that it took. Counts of all ranks; faces between
/// two ranks count on both.
Traffic traffic_of(const StepReport& step, double n_cells, double n_faces);

}  // namespace snag
