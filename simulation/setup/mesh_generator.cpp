#include "simulation/setup/mesh_generator.hpp"

#include <filesystem>

#include "base/child_process.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// Beside this program, as it is built; or in libexec/snag beside bin, as it is installed.
std::filesystem::path generator() {
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::filesystem::path installed = folder.parent_path() / "libexec" / "snag" / "snag-mesh";
  return std::filesystem::exists(installed) ? installed : folder / "snag-mesh";
}

int run_generator(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), generator());
  const int code = run_command(std::move(arguments), {}, "the mesh generator is missing, build it with ./snag build");
  return code < 128 ? code : static_cast<int>(ExitCode::io);
}

}  // namespace

ExitCode generate_mesh(MPI_Comm comm, std::vector<std::string> arguments) {
  int code = 0;
  on_all_ranks(comm, [&] {
    if (rank_of(comm) == 0) code = run_generator(std::move(arguments));
  });
  MPI_Bcast(&code, 1, MPI_INT, 0, comm);
  return static_cast<ExitCode>(code);
}

}  // namespace snag
