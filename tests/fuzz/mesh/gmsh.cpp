// gmsh meshes of both versions, text and bytes: import and judgement of the quality, as `snag mesh --info` does.
#include <unistd.h>

#include "mesh/import/import.hpp"
#include "mesh/quality.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/unit/mesh/sample.hpp"

namespace {

using namespace snag;

std::string sample_file(test::Format format) {
  const auto file = std::filesystem::temp_directory_path() / ("snag_seed_" + std::to_string(getpid()) + ".msh");
  test::write(test::mixed_units(2), format, file);
  std::ifstream stream(file, std::ios::binary);
  std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::filesystem::remove(file);
  return content;
}

void read(const std::filesystem::path& file) {
  const Mesh mesh = import_mesh(file, MPI_COMM_SELF);
  quality(mesh);
}

const fuzz::Registration ascii22({"gmsh_22_ascii", ".msh", [] { return std::vector<std::string>{sample_file(test::Format::ascii22)}; },
                                  read});
const fuzz::Registration binary22({"gmsh_22_binary", ".msh", [] { return std::vector<std::string>{sample_file(test::Format::binary22)}; },
                                   read});
const fuzz::Registration ascii41({"gmsh_41_ascii", ".msh", [] { return std::vector<std::string>{sample_file(test::Format::ascii41)}; },
                                  read});
const fuzz::Registration binary41({"gmsh_41_binary", ".msh", [] { return std::vector<std::string>{sample_file(test::Format::binary41)}; },
                                   read});

}  // namespace
