// snag observe IMAGES|RUN --camera CAMERA.toml --out DIR: what a camera sees of rags.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "app/observe.hpp"
#include "parallel/session.hpp"

namespace snag {

Action add_observe(CLI::App& app) {
  const auto options = std::make_shared<ObserveOptions>();
  CLI::App* command = app.add_subcommand(
      "observe", "Area, place, elongation ratio and orientation of rags in pictures, or in pictures of a run by a virtual camera");
  command->add_option("SUBJECT", options->subject, "Folder of pictures, a picture, or the output folder of a run")->required();
  command->add_option("--camera", options->camera_file, "Camera file (.toml) with [camera] and [cloth]")->required();
  command->add_option("--out", options->out, "Output folder (default results/observe-NAME)");
  command->add_option("--seed", options->seed, "Of the virtual camera's noise (default 1)");
  return [options] {
    together(MPI_COMM_WORLD, [&] {
      if (rank_of(MPI_COMM_WORLD) == 0) observe(*options);
    });
    return ExitCode::ok;
  };
}

}  // namespace snag
