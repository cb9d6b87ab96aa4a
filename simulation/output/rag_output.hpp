#pragma once
// Rags in the format of a FieldWriter: rags/rags, sheets (triangles with bond tension), and rags/particles, all particles; and what a
// camera would see.
#include <memory>
#include <vector>

#include "dem/rag_measures.hpp"
#include "observe/silhouette.hpp"
#include "simulation/output/rag_forces.hpp"
#include "simulation/writers/field_writer.hpp"

namespace snag {

class RagOutput {
 public:
  /// `place`: folder of the files, and the time up to which a resumed run keeps the entries of the run before. `view`: of the silhouettes.
  /// Rank 0 writes.
  RagOutput(const FieldWriter& writer, SeriesPlace place, const View& view);
  /// Collective; throws Error(io).
  void write(const RagSystem& rags, const RagForces& forces, std::int64_t time_step, double time);
  /// Silhouettes of the rags as they were last written; on rank 0.
  const std::vector<Silhouette>& silhouettes() const { return silhouettes_; }
  /// Those silhouettes, for a resume.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  std::unique_ptr<FieldSeries> sheets_, particles_;
  View view_;
  std::vector<Silhouette> silhouettes_;
};

}  // namespace snag
