// snag report DIR: one self-contained HTML file from the outputs of a run.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "report/report.hpp"

namespace snag {

namespace {

constexpr int pictures_per_second = 24;  // of a film

void log_film(const Film& film, const std::string& folder) {
  if (film.n_pictures > 0)
    log::info("film: " + std::to_string(film.n_pictures) + " pictures, " + folder + "/pictures/film_0001.png and on; " +
              number_text(static_cast<double>(film.n_pictures) / pictures_per_second) + " s at " + std::to_string(pictures_per_second) +
              " pictures a second. A video of them: ffmpeg -framerate " + std::to_string(pictures_per_second) + " -i " + folder +
              "/pictures/film_%04d.png -pix_fmt yuv420p " + folder + "/film.mp4");
  if (!film.problem.empty()) log::warning("film: pictures are missing: " + film.problem);
}

Action add_report(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  const auto with_film = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("report", "Write DIR/report.html, one self-contained file, from the outputs of a run");
  command->add_option("DIR", *folder, "Output folder of a run")->required();
  command->add_flag("--film", *with_film,
                    "Also draw DIR/pictures/film_0001.png and so on, one for each time at which the rags were written");
  return [folder, with_film] {
    on_all_ranks(MPI_COMM_WORLD, [&] {
      if (rank_of(MPI_COMM_WORLD) != 0) return;
      write_report(*folder);
      if (*with_film) log_film(make_film(*folder), *folder);
    });
    log::info("report: " + *folder + "/report.html");
    return ExitCode::ok;
  };
}
const Command report(70, add_report);

}  // namespace

}  // namespace snag
