#pragma once
// Formats of mesh files: one format, one file in mesh/import/readers/, chosen by the ending of the name and the first bytes of the file.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/registry.hpp"
#include "mesh/import/parts.hpp"

namespace snag {

/// What a format is, for messages and the manual.
struct MeshFormat {
  std::string title;                 // "gmsh MSH 2.2 or 4.1"
  std::vector<std::string> endings;  // of the name, in small letters: ".msh"
};

class MeshReader {
 public:
  virtual ~MeshReader() = default;
  virtual MeshFormat format() const = 0;
  /// True if a file that begins with these bytes (at most 4096) is of this format.
  virtual bool recognises(std::string_view beginning) const = 0;
  /// The whole mesh of a file as one part: all cells owned, in the order of the file; of its nodes those of cells and named faces, in the
  /// order of the file, numbered from 0; boundary faces of named surfaces; zone -1 for cells without a named volume. Lengths of the file
  /// times `scale` are metres. One rank calls it. Throws Error(io) if the file is cut off or damaged, Error(mesh) for what the format
  /// may hold and Snag does not read (other versions, curved elements), and where there are no volume cells.
  virtual MeshParts read(const std::filesystem::path& file, double scale) const = 0;
};

Registry<MeshReader>& mesh_readers();
/// The formats that are read, with their endings: "gmsh MSH 2.2 or 4.1 (.msh)".
std::string readable_mesh_formats();
/// The reader that recognises a file; of several, the one with the ending of its name. Throws Error(io) if the file does not exist, is no
/// file or is empty, Error(mesh) for a format that is not read: the message lists those that are.
std::unique_ptr<MeshReader> mesh_reader_of(const std::filesystem::path& file);

}  // namespace snag
