// Every mesh reader of the registry is held to the same rules; a new file in mesh/import/readers/ is tested without a line here.
#include "mesh/import/mesh_reader.hpp"

#include <set>

#include "base/error.hpp"
#include "mesh/import/import.hpp"
#include "mesh/import/mesh_format.hpp"
#include "sample.hpp"
#include "tests/sources.hpp"

using namespace snag;

namespace {

std::string refusal(const std::filesystem::path& file, ExitCode code) {
  try {
    mesh_reader_of(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

}  // namespace

// Requirement: no reader is dropped by the linker: the registry holds what its folder holds.
TEST(MeshReaders, RegistryHoldsTheFolder) { EXPECT_EQ(mesh_readers().names().size(), n_sources("mesh/import/readers")); }

// Requirement: a format has a title and endings in small letters, none of them that of another format, and the list of formats names them
// all.
TEST(MeshReaders, Formats) {
  std::set<std::string> endings;
  for (const auto& reader : mesh_readers().make_all()) {
    const MeshFormat format = reader->format();
    EXPECT_NE(readable_mesh_formats().find(format.title), std::string::npos);
    EXPECT_FALSE(format.title.empty() || format.endings.empty());
    for (const std::string& ending : format.endings) {
      EXPECT_EQ(ending, ending_of("mesh" + ending)) << "begins with a dot, in small letters";
      EXPECT_TRUE(endings.insert(ending).second) << ending;
      EXPECT_NE(readable_mesh_formats().find(ending), std::string::npos);
    }
    EXPECT_FALSE(reader->recognises("")) << format.title;
  }
}

// Requirement: what no reader recognises is refused with its first words and the formats that are read.
TEST(MeshReaders, UnknownFormat) {
  const test::TemporaryFile file(".grid");
  std::ofstream(file.path()) << "hello";
  const std::string message = refusal(file.path(), ExitCode::mesh);
  EXPECT_NE(message.find("begins with \"hello\""), std::string::npos) << message;
  EXPECT_NE(message.find(readable_mesh_formats()), std::string::npos) << message;
  EXPECT_NE(message.find(".msh"), std::string::npos) << message;
  for (const char* word : {"x", "xyz", "abcd", "    "}) {  // shorter than the first words of the formats
    std::ofstream(file.path()) << word;
    EXPECT_FALSE(refusal(file.path(), ExitCode::mesh).empty());
  }
}

// Requirement: a mesh is read whatever the ending of its name, since its first bytes show the format.
TEST(MeshReaders, ForeignEnding) {
  const test::TemporaryFile file(test::mixed_units(2), test::Format::ascii41);
  auto renamed = file.path();
  renamed.replace_extension(".grid");
  std::filesystem::copy_file(file.path(), renamed);
  EXPECT_EQ(import_mesh(renamed, MPI_COMM_SELF).n_cells_global, 8);
  std::filesystem::remove(renamed);
}
