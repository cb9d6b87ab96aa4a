#pragma once
// gmsh files: MSH 2.2 and 4.1, ASCII and binary, with linear cells and named physical groups.
#include <filesystem>

#include "mesh/import/parts.hpp"

namespace snag {

/// The whole mesh of a file as one part: all cells owned, in the order of the file; of its nodes those of cells and named faces, in the
/// order of the file; boundary faces of named surfaces; zone -1 for cells without a named volume. One rank calls it. Throws Error(io) if
/// the file is missing, cut off or damaged, Error(mesh) for other formats and versions, curved elements, no volume cells, cells that do not
/// fit together.
MeshParts read_gmsh(const std::filesystem::path& file, double scale);

}  // namespace snag
