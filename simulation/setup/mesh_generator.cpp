#include "simulation/setup/mesh_generator.hpp"

#include <unistd.h>

#include <filesystem>

#include "base/atomic_file.hpp"
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

int run_generator(std::vector<std::string> arguments, const std::filesystem::path& output = {}) {
  arguments.insert(arguments.begin(), generator());
  const int code = run_command(std::move(arguments), output, "the mesh generator is missing, build it with ./snag build");
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

std::string geometry_tables() {
  const auto file = std::filesystem::temp_directory_path() / ("snag-" + std::to_string(getpid()) + ".md");
  const int code = run_generator({"--manual"}, file);
  const auto text = file_text(file);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (code != 0 || !text)
    throw Error(ExitCode::io, generator().string() + " --manual: ended with code " + std::to_string(code) +
                                  " and wrote no tables; try it by itself, or build it again with ./snag build");
  return *text;
}

}  // namespace snag
