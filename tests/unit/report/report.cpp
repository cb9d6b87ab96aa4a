// The report of a made-up run: a sheet that waves on its way through a channel, written with the same files as a real one.
#include "report/report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>
#include <tuple>

#include "base/error.hpp"
#include "base/series.hpp"
#include "base/vtk_file.hpp"
#include "report/results.hpp"
#include "simulation/setup/checks.hpp"

namespace snag {
namespace {

constexpr int n_instants = 12;
constexpr double duration_s = 0.6;

/// Half (left or right along x) of a channel 1.2 x 0.3 x 0.4 m of hexahedra with a swirling flow.
VtkPiece channel_half(int half, double time) {
  constexpr int nx = 24, ny = 10, nz = 12;
  VtkPiece piece;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) piece.points.push_back({0.6 * half + 0.6 * i / nx, 0.3 * j / ny, 0.4 * k / nz});
  const auto node = [](int i, int j, int k) { return (static_cast<std::int64_t>(k) * (ny + 1) + j) * (nx + 1) + i; };
  VtkArray velocity{"velocity [m/s]", 3, {}, true}, pressure{"pressure [Pa]", 1, {}, true};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        for (const int dk : {0, 1})
          for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) piece.connectivity.push_back(node(i + di, j + dj, k + dk));
        piece.offsets.push_back(static_cast<std::int64_t>(piece.connectivity.size()));
        piece.types.push_back(12);
        const double x = 0.6 * half + 0.6 * (i + 0.5) / nx, z = (k + 0.5) / nz;
        velocity.values.insert(velocity.values.end(),
                               {4 * z * (1 - z) * 1.5, 0, 0.4 * std::sin(12 * x - 9 * time) * std::sin(std::numbers::pi * z)});
        pressure.values.push_back(1000 * (1.2 - x));
      }
  piece.cell_arrays = {velocity, pressure};
  return piece;
}

VtkPiece sheet(double time) {
  constexpr int n = 31, m = 21;
  VtkPiece piece;
  VtkArray tension{"tension [N]", 1, {}, true}, rag{"rag [1]", 1, {}, true};
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const double s = i / (n - 1.0), phase = 2 * std::numbers::pi * (s - 2 * time);
      piece.points.push_back({0.1 + 1.2 * time + 0.25 * s, 0.06 + 0.18 * j / (m - 1), 0.2 + 0.06 * std::sin(phase)});
      tension.values.push_back(0.8 * s * (1 + std::sin(phase)));
      rag.values.push_back(0);
    }
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const std::int64_t a = j * n + i, b = a + 1, c = a + n, d = c + 1;
      for (const auto& triangle : {std::array{a, b, d}, std::array{a, d, c}}) {
        piece.connectivity.insert(piece.connectivity.end(), triangle.begin(), triangle.end());
        piece.offsets.push_back(static_cast<std::int64_t>(piece.connectivity.size()));
      }
    }
  piece.point_arrays = {tension, rag};
  return piece;
}

void write_box_walls(const std::filesystem::path& file) {
  VtkPiece piece;
  for (int corner = 0; corner < 8; ++corner) piece.points.push_back({1.2 * (corner & 1), 0.3 * (corner >> 1 & 1), 0.4 * (corner >> 2)});
  piece.connectivity = {0, 1, 3, 2, 4, 5, 7, 6, 0, 1, 5, 4, 2, 3, 7, 6};
  piece.offsets = {4, 8, 12, 16};
  write_vtk(file, VtkKind::polygons, piece);
}

void write_fields(const std::filesystem::path& dir) {
  for (const char* folder : {"fields", "rags", "walls"}) std::filesystem::create_directories(dir / folder);
  write_box_walls(dir / "walls/walls.vtp");
  VtkCollection water(dir / "fields/water.pvd", false), rags(dir / "rags/rags.pvd", false);
  for (int k = 0; k < n_instants; ++k) {
    const double time = duration_s * k / (n_instants - 1);
    const std::string stem = "water_" + std::to_string(100 + k), cloth = "rags_" + std::to_string(100 + k) + ".vtp";
    for (const int half : {0, 1})
      write_vtk(dir / "fields" / (stem + "_" + std::to_string(half) + ".vtu"), VtkKind::unstructured_grid, channel_half(half, time));
    write_parallel_vtk(dir / "fields" / (stem + ".pvtu"), VtkKind::unstructured_grid, channel_half(0, time),
                       {stem + "_0.vtu", stem + "_1.vtu"});
    write_vtk(dir / "rags" / cloth, VtkKind::polygons, sheet(time));
    water.add(time, stem + ".pvtu");
    rags.add(time, cloth);
  }
}

void write_monitors(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Series residuals(folder / "residuals.csv", {"time [s]", "time_step [1]", "courant_max [1]", "courant_mean [1]", "momentum_residual [1]",
                                              "pressure_residual [1]", "pressure_iterations [1]", "continuity_global [1]"});
  Series rags(folder / "rags.csv",
              {"time [s]", "rag [1]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "elongation_ratio [1]", "bond_strain_max [1]"});
  Series coupling(folder / "coupling.csv", {"time [s]", "force_on_rags_x [N]", "force_on_rags_y [N]", "force_on_rags_z [N]",
                                            "momentum_exchange_rel [1]", "torque_on_rags_x [N m]", "torque_on_rags_y [N m]"});
  Series timing(folder / "timing.csv", {"time [s]", "flow_s [s]", "dem_s [s]", "coupling_s [s]", "output_s [s]"});
  for (int k = 1; k <= 3000; ++k) {
    const double t = duration_s * k / 3000, wave = std::sin(40 * t);
    residuals.add({t, double(k), 0.8 + 0.1 * wave, 0.2, 1e-3 * std::exp(-10 * t), 1e-5 * (1.5 + wave), 5.0 + k % 3, 1e-12 * (1 + wave)});
    for (const int rag : {0, 1})
      rags.add({t, double(rag), 0.2 + 1.2 * t, 0.15 + 0.01 * rag, 0.2 + 0.01 * wave, 1.2, 1.3 + 0.1 * wave, 0.01});
    coupling.add({t, 0.5 + 0.1 * wave, 0, 0.2 * wave, 1e-14, 0.01 * wave, 0.02});
    timing.add({t, 20 * t, 8 * t, 3 * t, t});
  }
}

const char* const summary_text =
    R"({"version": "0.1.0", "git": "0123456789ab", "case": "sheet in a channel", "case_sha256": "feed", "ranks": 2,
 "wall_s": 25.5, "exit": 0, "simulated_s": 0.6, "time_steps": 3000,
 "mesh": {"cells": 5760, "interior_faces": 16000, "facets": 0, "min_quality": 1.0},
 "performance": {"flow_cell_steps_per_s": 1.4e6, "dem_particle_steps_per_s": 3.5e7, "flow_s": 12, "dem_s": 4.8, "coupling_s": 1.8, "output_s": 0.6,
  "peak_memory_bytes": 310000000},
 "pump": {"flow_m3_s": 0.02, "head_m": 8.1, "torque_Nm": 20.5, "shaft_power_W": 2600, "efficiency": 0.61, "revolutions": 4},
 "rags": [{"id": 0, "name": "wipe", "particles": 651, "bonds": 1250, "broken_bonds": 3, "outcome": "stuck_on_tongue", "retention_time_s": null,
  "elongation_ratio": 1.31, "projected_area_m2": 0.045, "my_new_key": 7,
  "events": [{"t_s": 0.31, "angle_deg": 97.5, "what": "edge touches the tongue <first>"}]}],
 "conservation": {"mass_imbalance_rel": 3e-9, "momentum_exchange_rel": 2e-11, "interface_closure_rel": null, "particles_lost": 0, "bonds_lost": 0,
  "particles_beyond_walls": 0}})";

class Report : public testing::Test {
 protected:
  std::filesystem::path dir = std::filesystem::temp_directory_path() / ("snag_report_" + std::to_string(getpid()));
  void SetUp() override { std::filesystem::create_directories(dir); }
  void TearDown() override {
    if (!std::getenv("SNAG_KEEP_REPORT")) std::filesystem::remove_all(dir);
  }
  void write_run() const {
    write_fields(dir);
    write_monitors(dir / "monitors");
    std::ofstream(dir / "summary.json") << summary_text;
    std::ofstream(dir / "case.resolved.toml") << "[flow]\ndensity_kg_m3 = 998.2 # <water & cloth>\n";
    std::ofstream(dir / "log.txt") << "started\ndone\n";
  }
  std::string page() const {
    std::stringstream text;
    text << std::ifstream(dir / "report.html").rdbuf();
    return text.str();
  }
  static std::size_t times(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
  /// Output of Python lines run with the folder as the first argument.
  std::string python(const std::string& lines) const {
    std::ofstream(dir / "check.py") << lines;
    EXPECT_EQ(std::system(
                  ("/usr/bin/python3 " + (dir / "check.py").string() + " " + dir.string() + " > " + (dir / "check.txt").string()).c_str()),
              0);
    std::stringstream text;
    text << std::ifstream(dir / "check.txt").rdbuf();
    return text.str();
  }
};

// The page stands alone: nine instants with their scale and two slices as pictures inside it, plots drawn inside it, nothing fetched from
// anywhere.
TEST_F(Report, IsOneSelfContainedFile) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2> /dev/null && command -v xvfb-run > /dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9 or xvfb is not installed";
  write_run();
  write_report(dir);
  const auto html = page();
  EXPECT_EQ(times(html, "<img src=\"data:image/png;base64,iVBOR"), 12u);
  EXPECT_EQ(times(html, "<img"), 12u);
  EXPECT_EQ(times(html, "<svg"), 9u);
  EXPECT_FALSE(std::regex_search(html, std::regex("https?://|<script|<link|url\\(")));
  EXPECT_FALSE(holds(html, "missing:")) << html.substr(html.find("missing:"), 300);
  EXPECT_LT(html.size(), 6e6) << "small enough to be sent by mail";
}

// Each picture of an instant shows the water (blue), the rag (red to yellow) and a background; and the rag moves between them.
TEST_F(Report, PicturesShowWaterAndRag) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML, matplotlib' 2> /dev/null && command -v xvfb-run > /dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9, python3-matplotlib or xvfb is not installed";
  write_run();
  write_report(dir);
  const auto shares = python(R"(
import sys, matplotlib.image as image
for i in range(1, 10):
    p = image.imread(f'{sys.argv[1]}/pictures/rag_{i}.png')[40:-76, :, :3]
    fire = (p[..., 0] > p[..., 2] + 0.1); blue = (p[..., 2] > p[..., 0] + 0.1)
    print(fire.mean() > 0.01, blue.mean() > 0.05, f'{fire.nonzero()[1].mean():.0f}')
)");
  std::istringstream lines(shares);
  double before = 0;
  int n = 0;
  for (std::string fire, blue, place; lines >> fire >> blue >> place; ++n) {
    EXPECT_EQ(fire, "True") << "no rag in picture " << n + 1;
    EXPECT_EQ(blue, "True") << "no water in picture " << n + 1;
    EXPECT_GT(std::stod(place), before) << "the rag does not move along x in picture " << n + 1;
    before = std::stod(place);
  }
  EXPECT_EQ(n, 9);
}

// A rotor: the speed in its middle plane, and the pressure on all walls and on its own, the last ones of the series.
TEST_F(Report, PicturesOfARotor) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML, matplotlib' 2> /dev/null && command -v xvfb-run > /dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9, python3-matplotlib or xvfb is not installed";
  for (const char* folder : {"fields", "walls", "monitors"}) std::filesystem::create_directories(dir / folder);
  VtkCollection water(dir / "fields/water.pvd", false), walls(dir / "walls/walls.pvd", false);
  VtkPiece piece = channel_half(1, 0.3);
  piece.cell_arrays.push_back({"turning [1]", 1, std::vector<double>(piece.offsets.size(), 1), true});
  write_vtk(dir / "fields/water_1.vtu", VtkKind::unstructured_grid, piece);
  water.add(0.3, "water_1.vtu");
  for (const int k : {0, 1}) {
    VtkPiece box;
    for (int corner = 0; corner < 8; ++corner)
      box.points.push_back({0.6 + 0.6 * (corner & 1), 0.3 * (corner >> 1 & 1), 0.4 * (corner >> 2)});
    box.connectivity = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3};
    box.offsets = {4, 8, 12, 16};
    box.cell_arrays = {{"pressure [Pa]", 1, {1e3, 2e3, 3e3, 9e3 * k}, true}, {"turning [1]", 1, {0, 1, 0, 1}, true}};
    const std::string name = "walls_" + std::to_string(k) + ".vtp";
    write_vtk(dir / "walls" / name, VtkKind::polygons, box);
    walls.add(0.3 * k, name);
  }
  std::ofstream(dir / "case.resolved.toml") << "[rotating_zone]\naxis = [0.0, 2.0, 0.0]\norigin_m = [0.9, 0.0, 0.2]\n";
  write_report(dir);
  const auto html = page();
  EXPECT_TRUE(holds(html, "Speed of the water at t = 0.3 s in the middle plane of the rotor"));
  EXPECT_TRUE(holds(html, "Pressure at t = 0.3 s on all walls"));
  EXPECT_TRUE(holds(html, "Pressure at t = 0.3 s on the walls that turn"));
  EXPECT_FALSE(holds(html, "missing:")) << html.substr(html.find("missing:"), 300);
  const auto shares = python(R"(
import sys, matplotlib.image as image
for name in ('rotor_speed', 'pressure_walls', 'pressure_rotor_walls'):
    p = image.imread(f'{sys.argv[1]}/pictures/{name}.png')[40:-76, :, :3]
    print((p[..., 2] > p[..., 0] + 0.1).mean() > 0.2, (p[..., 0] > p[..., 2] + 0.1).mean() > 0.05)
)");
  EXPECT_EQ(shares, "True False\nFalse True\nFalse True\n");
}

// The report gives each result as a sentence or as a number with its unit. It does not mark a check as passed that the run did not
// measure, and it shows keys that it does not know.
TEST_F(Report, TellsResultsInWords) {
  std::ofstream(dir / "summary.json") << summary_text;
  std::ofstream(dir / "log.txt") << "2026-11-30 12:00:00 info: started\n2026-11-30 12:00:01 warning: large <steps>\n"
                                    "2026-11-30 12:00:02 warning: large <steps>\n2026-11-30 12:00:03 info: done: no warning: of it\n";
  write_report(dir);
  const auto html = page();
  EXPECT_TRUE(holds(html, "<h1>sheet in a channel</h1>"));
  EXPECT_TRUE(holds(html, "<h2>Warnings</h2>\n<ul>\n<li>large &lt;steps&gt;</li>\n</ul>"));
  EXPECT_TRUE(
      holds(html,
            "The run ended as planned. It covers 0.6 s of operation in 3\u2009000 time steps. Rag &quot;wipe&quot; hangs on the tongue. It "
            "has 3 broken bonds."));
  EXPECT_TRUE(holds(html, "<td>Head</td><td>8.1 m</td>"));
  EXPECT_TRUE(holds(html, "<td>3.5 × 10<sup>7</sup> per second</td>"));
  EXPECT_TRUE(holds(html, "<td>my_new_key</td><td>7</td>"));
  EXPECT_TRUE(holds(html, "edge touches the tongue &lt;first&gt;"));
  EXPECT_EQ(times(html, ">pass<"), 5u);
  EXPECT_EQ(times(html, ">FAIL<"), 0u);
  EXPECT_FALSE(holds(html, "sliding interface")) << "there is none";
}

// A run that did not end as planned says why at the top.
TEST_F(Report, NamesTheReasonOfABadEnd) {
  std::ofstream(dir / "summary.json")
      << R"({"case": null, "exit": 4, "error": "|U| < 3", "rags": [{"id": 1, "outcome": null}], "conservation": {"particles_lost": 2}})";
  write_report(dir);
  EXPECT_TRUE(holds(page(), "outcome bad\">The computation diverged: its results must not be used. |U| &lt; 3."));
  EXPECT_EQ(times(page(), ">FAIL<"), 1u);
  EXPECT_EQ(times(page(), ">pass<"), 0u);
}

// Requirement: each check of the report can fail. When one fails, the report marks it, names it at the top and does not say that the run
// ended as planned.
TEST_F(Report, EveryCheckCanFail) {
  const auto good = nlohmann::json::parse(summary_text);
  for (const auto& [group, key, value] :
       std::vector<std::tuple<std::string, std::string, double>>{{"water", "max_speed_over_scale", 21},
                                                                 {"water", "unsolved_steps", 21},
                                                                 {"water", "molecular_over_eddy_viscosity", 2},
                                                                 {"conservation", "mass_imbalance_rel", 2e-4},
                                                                 {"conservation", "momentum_exchange_rel", 2e-10},
                                                                 {"conservation", "interface_closure_rel", 2e-12},
                                                                 {"conservation", "particles_lost", 1},
                                                                 {"conservation", "bonds_lost", 1},
                                                                 {"conservation", "particles_beyond_walls", 1},
                                                                 {"rags", "max_wall_overlap_over_radius", 0.6}}) {
    auto summary = good;
    (group == "rags" ? summary["rags"][0] : summary[group])[key] = value;
    EXPECT_FALSE(ended_well(summary)) << key;
    EXPECT_TRUE(holds(check_table(summary), ">FAIL<")) << key;
    EXPECT_FALSE(holds(outcome_sentence(summary), "as planned")) << key;
    EXPECT_TRUE(holds(outcome_sentence(summary), "Check failed: ")) << key;
  }
  EXPECT_EQ(checked(good).size(), 10u) << "a check was added: let it fail here, too";
}

// A run that was killed before its summary still has a report of its monitors, case and log, which says so.
TEST_F(Report, IsMadeOfWhatThereIs) {
  write_monitors(dir / "monitors");
  std::ofstream(dir / "summary.json") << "{\"case\": ";
  std::ofstream(dir / "monitors" / "broken.csv") << "time [s],a [1]\n1,2\nx,3\n";
  std::ofstream(dir / "case.resolved.toml") << "name = \"<b>\"\n";
  write_report(dir);
  const auto html = page();
  EXPECT_TRUE(holds(html, "no readable summary.json"));
  EXPECT_EQ(times(html, "<svg"), 9u);
  EXPECT_TRUE(holds(html, "broken.csv:3")) << "an unreadable monitor is named";
  EXPECT_TRUE(holds(html, "name = &quot;&lt;b&gt;&quot;"));
}

// Without the packages for pictures the report is written all the same and says what is missing.
TEST_F(Report, GoesWithoutPictures) {
  write_run();
  const std::string path = std::getenv("PATH");
  setenv("PATH", dir.c_str(), 1);
  write_report(dir);
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(holds(page(), "There are no pictures: "));
  EXPECT_TRUE(holds(page(), "python3-vtk9"));
  EXPECT_EQ(times(page(), "<img"), 0u);
}

// A folder that is no run is refused with an input/output error and stays as it was.
TEST_F(Report, RefusesAFolderThatIsNoRun) {
  try {
    write_report(dir);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::io);
    EXPECT_TRUE(holds(error.what(), "--out")) << error.what();
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir));
}

}  // namespace
}  // namespace snag
