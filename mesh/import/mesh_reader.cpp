#include "mesh/import/mesh_reader.hpp"

#include <algorithm>

#include "base/words.hpp"
#include "mesh/import/mesh_format.hpp"

namespace snag {

Registry<MeshReader>& mesh_readers() {
  static Registry<MeshReader> readers("mesh format");
  return readers;
}

std::string readable_mesh_formats() {
  std::vector<std::string> formats;
  for (const auto& reader : mesh_readers().make_all()) {
    const MeshFormat format = reader->format();
    formats.push_back(format.title + " (" + joined(format.endings) + ")");
  }
  return joined(formats);
}

std::unique_ptr<MeshReader> mesh_reader_of(const std::filesystem::path& file) {
  const std::string beginning = beginning_of_mesh(file), ending = ending_of(file);
  std::unique_ptr<MeshReader> found;
  for (auto& reader : mesh_readers().make_all()) {
    if (!reader->recognises(beginning)) continue;
    const auto endings = reader->format().endings;
    const bool has_ending = std::find(endings.begin(), endings.end(), ending) != endings.end();
    if (!found || has_ending) found = std::move(reader);
  }
  if (!found) refuse_mesh_format(file, beginning);
  return found;
}

}  // namespace snag
