// snag observe SUBJECT ... --camera CAMERA.toml --out DIR: what a camera sees of rags, and where in the volute they stay.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "app/observe.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr const char* about =
    "Measure rags in pictures or in a run: area, position, elongation ratio, orientation; residence time by volute angle; differences "
    "between operating points";

constexpr const char* examples =
    "One test:\n"
    "  snag observe results/mine --camera CAMERA.toml        pictures of a run by a virtual camera\n"
    "  snag observe photographs/ --camera CAMERA.toml        photographs, analysed by the same code\n"
    "  Writes observations.csv, statistics.json, coverage.png (where cloth lies in the picture) and extent.png (its extent about its\n"
    "  centroid: contours at 10, 30, 50, 70, 90 % of the rags).\n"
    "Residence of rags in the volute:\n"
    "  snag observe results/rag_*                            runs with [rag_passage]: no camera needed\n"
    "  Writes volute.html, and volute.csv: fraction of time, distance from the shaft and events in bins of 20 degrees from the tongue. A\n"
    "  camera with [pump_in_picture] measures the same in pictures: volute_seen.csv.\n"
    "Differences between operating points:\n"
    "  snag observe --camera CAMERA.toml --group 55 part_load/* --group 90 near_best/*\n"
    "  snag observe repeats.csv                              a table with the columns group,rag,area [m2], ...\n"
    "  Writes groups.csv (mean, sigma, n, n_eff) and anova.csv: p that all groups have one mean, as if all n samples were independent (p)\n"
    "  and with the n_eff that are (p_eff). Each SUBJECT is the test of one rag, and pictures of one rag resemble each other: trust "
    "p_eff.\n"
    "docs/case-file.md describes the camera file, docs/theory.md (Observing) the formulas.";

/// --group NAME SUBJECT ... as often as it is given: the words of each, an empty one between them.
std::vector<ObserveGroup> groups_of(const std::vector<std::string>& words) {
  std::vector<ObserveGroup> groups;
  bool is_name = true;
  for (const std::string& word : words) {
    if (word.empty()) {
      is_name = true;
    } else if (is_name) {
      for (const ObserveGroup& group : groups)
        if (group.name == word)
          throw Error(ExitCode::usage, "snag observe: --group " + word + " is given twice; name all its subjects at once");
      groups.push_back({word, {}});
      is_name = false;
    } else {
      groups.back().subjects.emplace_back(word);
    }
  }
  return groups;
}

Action add_observe(CLI::App& app) {
  struct Options {
    ObserveOptions observe;
    std::vector<std::string> subjects, groups;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("observe", about);
  command->footer(examples);
  auto* subjects =
      command->add_option("SUBJECT", options->subjects, "Folders of pictures, pictures, output folders of runs, or one table (.csv)");
  auto* groups =
      command->add_option("--group", options->groups, "NAME SUBJECT ...: repeats at one operating point; give it for each of them");
  groups->excludes(subjects);
  groups->inject_separator();  // an empty word between two of them
  command->add_option("--camera", options->observe.camera_file, "Camera file (.toml) with [camera], [cloth] and perhaps [pump_in_picture]");
  command->add_option("--out", options->observe.out, "Output folder (default results/observe-NAME)");
  command->add_option("--seed", options->observe.seed, "Seed of the noise of the virtual camera (default 1)");
  return [options, groups] {
    options->observe.groups = groups_of(groups->results());
    if (options->observe.groups.empty()) options->observe.groups = {{"", {options->subjects.begin(), options->subjects.end()}}};
    on_all_ranks(MPI_COMM_WORLD, [&] {
      if (rank_of(MPI_COMM_WORLD) == 0) observe(options->observe);
    });
    return ExitCode::ok;
  };
}
const Command observe(60, add_observe);

}  // namespace

}  // namespace snag
