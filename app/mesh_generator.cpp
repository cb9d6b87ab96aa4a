#include "app/mesh_generator.hpp"

#include <mpi.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "parallel/session.hpp"

extern char** environ;

namespace snag {

namespace {

// Not under this process' MPI, which the gmsh library would otherwise try to join.
int run_generator(std::vector<std::string> arguments) {
  const auto program = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "snag-mesh").string();
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv, environment;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  for (char** entry = environ; *entry; ++entry) {
    if (!std::strstr(*entry, "PMIX") && std::strncmp(*entry, "OMPI_COMM", 9) != 0) environment.push_back(*entry);
  }
  environment.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environment.data()) != 0)
    throw Error(ExitCode::io, program + ": the mesh generator cannot be started; build it with ./snag build");
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : static_cast<int>(ExitCode::io);
}

}  // namespace

ExitCode generate_mesh(std::vector<std::string> arguments) {
  int code = 0;
  together(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) code = run_generator(std::move(arguments));
  });
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return static_cast<ExitCode>(code);
}

}  // namespace snag
