#pragma once
// Fields of the water and walls for ParaView: fields/water.pvd over water_NNNNNN.pvtu, one piece a rank; walls/walls.vtp once.
#include <filesystem>

#include "base/vtk_file.hpp"
#include "solver/flow.hpp"

namespace snag {

class FieldOutput {
 public:
  /// Keeps the entries of a resumed run up to from_time. Collective.
  FieldOutput(std::filesystem::path folder, const Mesh& mesh, bool single_precision, bool resume, double from_time);
  /// Velocity, pressure, solid fraction, reaction, rank, and k, epsilon, nu_t of a turbulence model, at the flow's time. Collective; throws
  /// Error(io).
  void write(const Flow& flow);

 private:
  std::filesystem::path folder_;
  const Mesh& mesh_;
  bool single_precision_;
  VtkPiece piece_;  // geometry, made once
  VtkCollection collection_;
};

/// Boundary faces of the mesh with the number of their patch, gathered to one file. Collective; throws Error(io).
void write_walls(const std::filesystem::path& file, const Mesh& mesh);

}  // namespace snag
