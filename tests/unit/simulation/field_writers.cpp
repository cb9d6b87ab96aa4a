// Every format of fields of the registry is held to the same rules; a new file in simulation/writers/formats/ is tested without a line
// here.
#include "simulation/writers/field_writer.hpp"

#include <unistd.h>

#include "base/case_file.hpp"
#include "simulation/setup/settings.hpp"
#include "tests/sources.hpp"

using namespace snag;
namespace fs = std::filesystem;

namespace {

/// A folder that goes when the test does.
struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("snag_fields_" + std::to_string(getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
  std::size_t n_files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator())); }
};

/// A triangle with a number.
VtkPiece triangle() {
  VtkPiece piece;
  piece.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  piece.connectivity = {0, 1, 2}, piece.offsets = {3};
  piece.cell_arrays = {{"pressure [Pa]", 1, {7}, false}};
  piece.field_arrays = {{"TimeValue", 1, {0}, false}};
  return piece;
}

VtkPiece tetrahedron() {
  VtkPiece piece = triangle();
  piece.points.push_back({0, 0, 1});
  piece.connectivity = {0, 1, 2, 3}, piece.offsets = {4}, piece.types = {10};
  return piece;
}

}  // namespace

// Requirement: no format is dropped by the linker: the registry holds what its folder holds; the manual says what each is.
TEST(FieldWriters, RegistryHoldsTheFolder) {
  EXPECT_EQ(field_writers().names().size(), n_sources("simulation/writers/formats"));
  for (const auto& writer : field_writers().make_all()) {
    EXPECT_FALSE(writer->meaning().empty());
    EXPECT_NE(field_format_meaning().find(writer->meaning()), std::string::npos);
  }
}

// Requirement: the default format is known, and a case that states it is the same case as one that does not.
TEST(FieldWriters, DefaultFormat) {
  const auto hash = [](const std::string& text) {
    const CaseFile file = CaseFile::parse(text);
    OutputSettings settings;
    file.root().table("output").read(settings.section().parameters);
    EXPECT_NO_THROW(field_writers().make(settings.format, "test"));
    return file.sha256();
  };
  EXPECT_EQ(hash("[output]\nreport = false\n"), hash("[output]\nreport = false\nformat = \"vtk\"\n"));
  EXPECT_THROW(hash("[output]\nformat = \"vtl\"\n"), Error);
}

// Requirement: each format writes files for a series of one rank, a series of pieces and a data set alone, and those of a step have names
// of their own.
TEST(FieldWriters, WriteFiles) {
  for (const std::string& name : field_writers().names()) {
    SCOPED_TRACE(name);
    const auto writer = field_writers().make(name, "test");
    const TemporaryFolder folder;
    const auto more_files = [&](const auto& write) {
      const std::size_t before = folder.n_files();
      write();
      return folder.n_files() - before;
    };
    const auto series = writer->series({.folder = folder.path, .name = "rags", .kind = VtkKind::polygons});
    EXPECT_GT(more_files([&] { series->add(0, 0, triangle()); }), 0U);
    EXPECT_GT(more_files([&] { series->add(0.1, 1, triangle()); }), 0U);
    const auto pieces = writer->series_of_pieces({.folder = folder.path, .name = "water"}, MPI_COMM_SELF);
    EXPECT_GT(more_files([&] { pieces->add(0, 0, tetrahedron()); }), 0U);
    EXPECT_GT(more_files([&] { writer->write(folder.path, "walls", VtkKind::polygons, triangle()); }), 0U);
  }
}
