#pragma once
// One run of a case for the observables of a measurement: no output, no files, on this rank alone.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/vec3.hpp"
#include "diagnosis/data/simulator.hpp"
#include "simulation/setup/flow_cache.hpp"
#include "simulation/setup/prepared.hpp"

namespace snag {

/// One number asked of a run: an observable (observe/observables.hpp) at a time; or, time NaN, its mean over the time in the window of the
/// camera; or, time NaN, one of the whole run.
struct ObservableRequest {
  std::string observable;
  double time = std::numeric_limits<double>::quiet_NaN();  // s
};

/// Of a particle in its piece.
struct LatticePosition {
  Vec3 x;                     // m
  double along = 0;           // lengthwise, -1 to 1 from end to end
  double mean_abs_along = 0;  // mean of |along| over the columns of the piece
  Vec3 normal;                // of the piece, here: lengthwise x crosswise, turned with it
};

/// Acceleration of a particle in addition to all forces of the case, m/s2: what no candidate expresses, for sealed sets of a benchmark.
using UnmodelledForce = std::function<Vec3(double time, const LatticePosition& place)>;

/// Another case of the same pieces and the same water, which is the case while the gate is open.
struct BehindGate {
  Gate gate;
  CaseFile file;
};

/// Runs a case in a prescribed flow or in frozen water of a mesh, up to the last time that is asked for (its end, if a number of the whole
/// run is asked for; earlier, if every rag has left the mesh). NaN where there is no answer: a time beyond the end of the case, a retention
/// time of a piece that stays, a window that was never reached. `store`: holds meshes and water between runs. `restart`: at the last step
/// before its time; in a prescribed flow only. `behind_gate`: of its keys those of [coupling] may differ; forces that remember begin anew
/// where the gate opens or closes, at the begin of a step. Throws Error.
std::vector<double> run_in_memory(const CaseFile& file, const std::vector<ObservableRequest>& asked, const UnmodelledForce& unmodelled = {},
                                  FlowCache* store = nullptr, const std::optional<Restart>& restart = {}, Prepared* prepared = nullptr,
                                  const BehindGate* behind_gate = nullptr);

}  // namespace snag
