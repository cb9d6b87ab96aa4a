// snag mesh: parametric geometry by the program snag-mesh beside this one, and a judgement of any mesh.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>

#include "app/command.hpp"
#include "mesh/import.hpp"
#include "mesh/quality.hpp"
#include "parallel/session.hpp"

extern char** environ;

namespace snag {

namespace {

ExitCode judge(const std::string& file, double scale) {
  const Mesh mesh = import_gmsh(file, MPI_COMM_WORLD, {.scale = scale});
  const MeshQuality found = quality(mesh);
  if (rank_of(MPI_COMM_WORLD) == 0) std::cout << quality_table(mesh, found) << std::flush;
  return found.failures.empty() ? ExitCode::ok : ExitCode::mesh;
}

/// Runs snag-mesh with these arguments; not under this process' MPI, which the gmsh library would otherwise try to join.
ExitCode generate(std::vector<std::string> arguments) {
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
  return static_cast<ExitCode>(WIFEXITED(status) ? WEXITSTATUS(status) : static_cast<int>(ExitCode::io));
}

}  // namespace

Action add_mesh(CLI::App& app) {
  struct Options {
    std::string judged;
    double scale = 1;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("mesh",
                         "Make a mesh: snag mesh pump|pipe|channel|box|tank [PARAMS.toml] --out MESH.msh (snag mesh pump --help lists "
                         "the parameters); or judge one: snag mesh --info MESH.msh, exit code 3 on a bad mesh");
  command->add_option("--info", options->judged, "Mesh to judge: cells, patches, zones, quality, what is wrong with it");
  command->add_option("--scale", options->scale, "Metres in one unit of length of the file judged");
  command->prefix_command();
  return [command, options] {
    if (!options->judged.empty()) return judge(options->judged, options->scale);
    int code = 0;
    if (rank_of(MPI_COMM_WORLD) == 0) {
      const std::vector<std::string> rest = command->remaining();
      if (rest.empty()) {
        std::cout << command->help();
        code = static_cast<int>(ExitCode::usage);
      } else {
        code = static_cast<int>(generate(rest));
      }
    }
    MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return static_cast<ExitCode>(code);
  };
}

}  // namespace snag
