// snag calibrate TESTS.toml --radius 1.5mm: three laboratory tests of a cloth -> a textile passport.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command.hpp"
#include "base/atomic_file.hpp"
#include "base/folder_lock.hpp"
#include "base/log.hpp"
#include "base/units.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "report/independence_section.hpp"
#include "textile/passport_text.hpp"

namespace snag {

namespace {

struct CalibrateOptions {
  std::string tests_file, out;
  std::vector<std::string> radii{"1.5mm"};
  bool as_published = false, independence = false;
  int n_seeds = CalibrationSettings{}.n_seeds;
};

/// Radii in metres, rising. Throws Error(usage).
std::vector<double> radii_of(const CalibrateOptions& options) {
  constexpr double smallest = 1e-4, largest = 2e-2;
  std::vector<double> radii;
  for (const std::string& text : options.radii) {
    const double radius = quantity(text, "m", "--radius");
    if (!(radius >= smallest && radius <= largest))
      throw Error(ExitCode::usage, "--radius " + text + ": must lie between 0.1 and 20 mm, such as --radius 1.5mm");
    radii.push_back(radius);
  }
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  return radii;
}

void tell_result(const TextileTests& tests, const Calibration& c) {
  for (int d = 0; d < 2; ++d) {
    const BondProperties& bond = c.bond[d];
    std::string line = std::string(direction_name[d]) + ": S_n " + number_text(bond.normal_stiffness) + " N/m3, critical stress " +
                       number_text(bond.normal_strength) + " Pa, S_nb " + number_text(bond.bending_stiffness) + " N/m3, S_t " +
                       number_text(bond.tangential_stiffness) + " N/m3";
    for (const PublishedBond& p : tests.published)
      if (p.direction == d && std::abs(p.radius - c.settings.radius) < 1e-9 && p.bond.bending_stiffness > 0)
        line += "; S_nb over the published one " + number_text(bond.bending_stiffness / p.bond.bending_stiffness);
    log::info(line);
  }
  const DrapePoint& drape = c.drapes[c.chosen];
  log::info("drape, mean of " + std::to_string(drape.samples.size()) + " seeds: area " +
            number_text(100 * (drape.area / tests.drape.area - 1)) + " % from the measured mean, wave size " +
            number_text(100 * (drape.wave_size / tests.drape.wave_size - 1)) + " %, " + number_text(drape.wave_count) + " waves");
  if (!c.tangential_range.given())
    log::warning(
        "no tangential stiffness brings the drape's area within 7 % and its wave size within 3 % of the measured means; the "
        "nearest was taken: look at the report");
}

void write_results(const std::filesystem::path& out, const TextileTests& tests, const std::vector<Calibration>& calibrations,
                   const std::optional<IndependencePart>& independence, const std::string& tests_file) {
  std::error_code code;
  std::filesystem::create_directories(out / "pictures", code);
  if (code) throw Error(ExitCode::io, out.string() + ": the output folder cannot be made (" + code.message() + "); give another --out");
  std::vector<std::vector<NamedDrawing>> drawings;
  std::vector<std::string> pictures;
  for (const Calibration& c : calibrations) {
    drawings.push_back(calibration_drawings(tests, c));
    for (const NamedDrawing& drawing : drawings.back()) {
      pictures.push_back("pictures/" + drawing.file);
      write_atomically(out / pictures.back(), drawing.svg);
    }
  }
  if (independence)
    for (const NamedDrawing& drawing : independence->drawings) write_atomically(out / "pictures" / drawing.file, drawing.svg);
  write_atomically(out / "passport.toml",
                   passport_text(tests, calibrations, std::filesystem::path(tests_file).filename().string(), pictures));
  write_atomically(out / "calibration.html", calibration_page(tests, calibrations, drawings, independence));
}

ExitCode run_calibrate(const CalibrateOptions& options) {
  TextileTests tests;
  std::vector<double> radii;
  on_all_ranks(MPI_COMM_WORLD, [&] { tests = read_textile_tests(options.tests_file), radii = radii_of(options); });
  const std::filesystem::path tests_file(options.tests_file);
  const std::filesystem::path out = options.out.empty() ? "results/calibrate-" + tests_file.stem().string() : options.out;
  std::optional<FolderLock> lock;
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) lock.emplace(out);
  });
  std::vector<Calibration> calibrations;
  const auto write = [&](const std::optional<IndependencePart>& part) {
    on_all_ranks(MPI_COMM_WORLD, [&] {
      if (rank_of(MPI_COMM_WORLD) == 0) write_results(out, tests, calibrations, part, options.tests_file);
    });
  };
  for (const double radius : radii) {
    log::info("calibration of " + tests.name + " at a particle radius of " + number_text(1e3 * radius) + " mm");
    CalibrationSettings settings{.radius = radius, .as_published = options.as_published, .n_seeds = options.n_seeds};
    settings.report_progress = [](const std::string& line) { log::info(line); };
    calibrations.push_back(calibrate(MPI_COMM_WORLD, tests, settings));
    tell_result(tests, calibrations.back());
    write({});  // the results so far remain if the next radius fails
  }
  if (options.independence) {
    const Calibration& calibration = calibrations[calibrations.size() / 2];
    log::info("independence of particle radius, step, dashpots and friction about " + number_text(1e3 * calibration.settings.radius) +
              " mm");
    IndependencePart part{calibration.settings.radius, independence(MPI_COMM_WORLD, tests, calibration), {}};
    part.drawings = independence_drawings(tests, part.found);
    write(part);
  }
  log::info("passport: " + (out / "passport.toml").string() + ", report: " + (out / "calibration.html").string());
  return ExitCode::ok;
}

Action add_calibrate(CLI::App& app) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Find the bonds of a cloth from its elongation, bending and drape tests; writes a textile passport and a report");
  command->add_option("TESTS", options->tests_file, "File of the tests (.toml), such as cases/textile-aro/tests.toml")->required();
  command->add_option("--radius", options->radii, "Particle radius, such as 1.5mm (the default); several make one passport");
  command->add_flag("--as-published", options->as_published,
                    "Count the clamps of the elongation test twice, as Jensen (2018) did: half of the measured force");
  command->add_flag("--independence", options->independence,
                    "Show the independence of numerical parameters about the middle radius: particle radius, time step, dashpots, "
                    "friction; some minutes more");
  command->add_option("--seeds", options->n_seeds, "Number of drape simulations at the chosen tangential stiffness (default 4)")
      ->check(CLI::Range(2, 100));
  command->add_option("--out", options->out, "Output folder (default results/calibrate-NAME of the tests' file)");
  return [options] { return run_calibrate(*options); };
}
const Command calibrate(80, add_calibrate);

}  // namespace

}  // namespace snag
