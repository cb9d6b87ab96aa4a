#pragma once
// Meshes in: files with named volumes and surfaces (mesh/import/mesh_reader.hpp), distributed over the ranks.
#include <filesystem>
#include <optional>

#include "mesh/mesh.hpp"

namespace snag {

struct ImportOptions {
  double scale = 1;  // file unit in metres
  std::vector<PeriodicPair> periodic = {};
  std::optional<std::vector<int>> partition = {};  // rank of every cell of the file (known on all ranks), as stored by a checkpoint
};

/// Cells and nodes carry their numbers in the file, from 0; nodes that no element uses are not counted.
/// Read, distribute (SCOTCH, mesh/import/partition.hpp) and flatten a mesh; cells in bandwidth-reducing order; the same on every run.
/// Collective. Throws Error(io) if the file is missing or unreadable, Error(mesh) if it is of a format that is not read, holds no volume
/// cells, cells that do not fit together, unnamed boundary faces, or an unmatched periodic pair.
Mesh import_mesh(const std::filesystem::path& file, MPI_Comm comm, const ImportOptions& options = {});

/// Rank of every cell of the file, for the checkpoint. Collective.
std::vector<int> partition_of(const Mesh& mesh);

}  // namespace snag
