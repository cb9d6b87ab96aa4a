#pragma once
// Fields of the water and walls for ParaView: fields/water.pvd over water_NNNNNN.pvtu, one piece a rank.
#include <filesystem>
#include <optional>

#include "base/vtk_file.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

class FieldOutput {
 public:
  /// Keeps the entries of a resumed run up to from_time. Collective.
  FieldOutput(std::filesystem::path folder, const Mesh& mesh, bool single_precision, bool resume, double from_time);
  /// The cells where they are now, with velocity, pressure, solid fraction, reaction, rank, skew cells and those in corners, what turns,
  /// and k, epsilon, nu_t of a turbulence model, at the flow's time. Collective; throws Error(io).
  void write(const Flow& flow);

 private:
  std::filesystem::path folder_;
  const Mesh& mesh_;
  bool single_precision_;
  VtkPiece piece_;                // connectivity, made once
  std::optional<VtkArray> skew_;  // 1: cells with a skew face, 2: in a corner (mesh/skewness.hpp); none if nowhere
  VtkCollection collection_;
};

/// Boundary faces of the mesh, as triangles with the number of their patch, gathered to one file: walls/walls.vtp once; where a zone turns
/// walls/walls.pvd over walls_NNNNNN.vtp with the pressure and y+ at each time.
class WallOutput {
 public:
  /// Keeps the entries of a resumed run up to from_time. Collective; throws Error(io).
  WallOutput(std::filesystem::path folder, const Flow& flow, bool resume, double from_time);
  /// The walls at the start of a run. Collective; throws Error(io).
  void initial(const Flow& flow);
  /// The walls at the flow's time, where a zone turns. Collective; throws Error(io).
  void write(const Flow& flow);

 private:
  VtkPiece walls_of(const Flow& flow) const;
  std::filesystem::path folder_;
  std::optional<VtkCollection> collection_;  // where a zone turns
};

}  // namespace snag
