#include "app/mesh_generator.hpp"

#include <filesystem>

#include "base/child_process.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

int run_generator(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), std::filesystem::read_symlink("/proc/self/exe").parent_path() / "snag-mesh");
  const int code = run_command(std::move(arguments), {}, "the mesh generator is missing, build it with ./snag build");
  return code < 128 ? code : static_cast<int>(ExitCode::io);
}

}  // namespace

ExitCode generate_mesh(MPI_Comm comm, std::vector<std::string> arguments) {
  int code = 0;
  together(comm, [&] {
    if (rank_of(comm) == 0) code = run_generator(std::move(arguments));
  });
  MPI_Bcast(&code, 1, MPI_INT, 0, comm);
  return static_cast<ExitCode>(code);
}

}  // namespace snag
