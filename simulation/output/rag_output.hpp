#pragma once
// Rags for ParaView: rags/rags.pvd over sheets (triangles with bond tension), rags/particles.pvd over all particles; and what a camera
// would see.
#include <filesystem>
#include <vector>

#include "base/vtk_file.hpp"
#include "dem/rag_measures.hpp"
#include "observe/silhouette.hpp"
#include "simulation/output/rag_forces.hpp"

namespace snag {

class RagOutput {
 public:
  /// Keeps the entries of a resumed run up to from_time. Rank 0 writes.
  RagOutput(std::filesystem::path folder, bool resume, double from_time);
  /// Collective; throws Error(io).
  void write(const RagSystem& rags, const RagForces& forces, std::int64_t time_step, double time);
  /// Silhouettes of the rags as they were last written, seen against z (x to the right, y up); on rank 0.
  const std::vector<Silhouette>& silhouettes() const { return silhouettes_; }
  /// Those silhouettes, for a resume.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  std::filesystem::path folder_;
  VtkCollection sheets_, particles_;
  std::vector<Silhouette> silhouettes_;
};

}  // namespace snag
