// snag mesh: parametric geometry by the program snag-mesh beside this one, and a judgement of any mesh.

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/import/import.hpp"
#include "mesh/import/mesh_reader.hpp"
#include "mesh/quality.hpp"
#include "parallel/standard_output.hpp"
#include "simulation/setup/mesh_generator.hpp"

namespace snag {

namespace {

ExitCode judge(const std::string& file, double scale) {
  if (!(scale > 0))
    throw Error(ExitCode::usage,
                "--scale: the metres in one unit of length (" + rounded(scale) + "), must be positive; 0.001 for millimetres");
  const Mesh mesh = import_mesh(file, MPI_COMM_WORLD, {.scale = scale});
  const MeshQuality found = quality(mesh);
  const std::string table = quality_table(mesh, found);
  print(table);
  return found.failures.empty() ? ExitCode::ok : ExitCode::mesh;
}

Action add_mesh(CLI::App& app) {
  struct Options {
    std::string judged;
    double scale = 1;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "mesh",
      "Make a mesh: snag mesh pump|pipe|channel|box|tank|blade_rows [PARAMS.toml] --out MESH.msh (snag mesh pump --help lists "
      "the parameters); or check one: snag mesh --info MESH.msh, exit code 3 on a bad mesh");
  command->add_option("--info", options->judged, "Mesh to check, " + readable_mesh_formats() + ": cells, patches, zones, quality, errors");
  command->add_option("--scale", options->scale, "Metres in one unit of length of the checked file");
  command->prefix_command();
  return [command, options] {
    if (!options->judged.empty()) return judge(options->judged, options->scale);
    const std::vector<std::string> rest = command->remaining();
    if (!rest.empty()) return generate_mesh(MPI_COMM_WORLD, rest);
    print(command->help());
    return ExitCode::usage;
  };
}
const Command mesh(30, add_mesh);

}  // namespace

}  // namespace snag
