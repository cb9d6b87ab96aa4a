#pragma once
// Fields of the water and walls, in the format of a FieldWriter: fields/water, one piece a rank, and walls/walls.
#include <filesystem>
#include <memory>
#include <optional>

#include "simulation/writers/field_writer.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

class FieldOutput {
 public:
  /// `place`: folder of the files, and the time up to which a resumed run keeps the entries of the run before.
  /// Collective.
  FieldOutput(const FieldWriter& writer, SeriesPlace place, const Mesh& mesh, bool single_precision);
  /// The cells where they are now, with velocity, pressure, solid fraction, reaction, rank, skew cells and those in corners, what turns,
  /// and k, epsilon, nu_t of a turbulence model, at the flow's time. Collective; throws Error(io).
  void write(const Flow& flow);

 private:
  const Mesh& mesh_;
  bool single_precision_;
  VtkPiece piece_;                // connectivity, made once
  std::optional<VtkArray> skew_;  // 1: cells with a skew face, 2: in a corner (mesh/skewness.hpp); none if nowhere
  std::unique_ptr<FieldSeries> series_;
};

/// Boundary faces of the mesh, as triangles with the number of their patch, gathered to one file: once, or where a zone turns as a series
/// with the pressure and y+ at each time.
class WallOutput {
 public:
  /// `place`: folder of the files, and the time up to which a resumed run keeps the entries of the run before.
  /// Collective; throws Error(io).
  WallOutput(std::shared_ptr<const FieldWriter> writer, SeriesPlace place, const Flow& flow);
  /// The walls at the start of a run. Collective; throws Error(io).
  void initial(const Flow& flow);
  /// The walls at the flow's time, where a zone turns. Collective; throws Error(io).
  void write(const Flow& flow);

 private:
  VtkPiece walls_of(const Flow& flow) const;
  std::shared_ptr<const FieldWriter> writer_;
  SeriesPlace place_;
  std::unique_ptr<FieldSeries> series_;  // where a zone turns
};

}  // namespace snag
