// The report of a rag in a pump whose head, way and contacts are known: its sentences, its numbers, its plots, and the pictures with the
// impeller at its angle.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "base/vtk_file.hpp"
#include "report/passage_section.hpp"
#include "report/report.hpp"
#include "simulation/output/summary.hpp"

namespace snag {
namespace {

constexpr double dt = 1e-3, end_s = 1, turns_per_s = 20;  // 50 steps a revolution

/// Swings with the shaft by more than the rag takes off it between 0.4 and 0.7 s: 8 % of its mean.
double head_at(double t) { return 5 * (t > 0.4 + 1e-9 && t < 0.7 + 1e-9 ? 0.92 : 1) + std::cos(2 * std::numbers::pi * turns_per_s * t); }

class PassageReport : public testing::Test {
 protected:
  std::filesystem::path dir = std::filesystem::temp_directory_path() / ("snag_report_passage_" + std::to_string(getpid()));
  void SetUp() override { std::filesystem::create_directories(dir / "monitors"); }
  void TearDown() override { std::filesystem::remove_all(dir); }

  void write_pump(bool with_column_of_head = true) const {
    Series pump(dir / "monitors/pump.csv", {"time [s]", "angle [deg]", "revolutions [1]", with_column_of_head ? "head [m]" : "other [m]",
                                            "torque [N m]", "shaft_power [W]"});
    for (int k = 1; k <= std::lround(end_s / dt); ++k) {
      const double t = k * dt;
      pump.add({t, std::fmod(360 * turns_per_s * t, 360), turns_per_s * t, head_at(t), -20, 2500});
    }
  }
  /// One and a half turns round the volute from 0.45 s on, touching the impeller for 0.12 s and the tongue never.
  void write_way() const {
    Series way(dir / "monitors/passage.csv",
               {"time [s]", "rag [1]", "angle [deg]", "radius [m]", "height [m]", "particles_upstream [1]", "particles_in_casing [1]",
                "particles_out [1]", "touching_impeller [1]", "touching_tongue [1]", "touching_other_wall [1]", "max_tension [N]",
                "max_tension_x [m]", "max_tension_y [m]", "max_tension_z [m]"});
    Series forces(dir / "monitors/rag_forces.csv",
                  {"time [s]", "rag [1]", "fluid_mean [N]", "fluid_p50 [N]", "fluid_p90 [N]", "fluid_p99 [N]", "fluid_max [N]",
                   "contact_mean [N]", "contact_p50 [N]", "contact_p90 [N]", "contact_p99 [N]", "contact_max [N]", "in_contact [1]"});
    Series rags(dir / "monitors/rags.csv", {"time [s]", "rag [1]", "x [m]", "y [m]", "z [m]", "particles_out [1]", "bond_tension_max [N]"});
    for (int k = 1; k <= std::lround(end_s / dt); ++k) {
      const double t = k * dt;
      const int out = t > 0.69 ? 100 : 0, upstream = t < 0.45 ? 100 : 0;
      const double angle = t < 0.45 ? 10 : 10 + 540 * (t - 0.45) / 0.25, touching = t > 0.5 + 1e-9 && t < 0.62 + 1e-9 ? 7 : 0;
      way.add({t, 0, angle, 0.05 + 0.1 * t, 0.04, double(upstream), double(100 - out - upstream), double(out), touching, 0, 3, 5 + t, 0.01,
               0.02, 0.03});
      const double f = 1e-3 * (1 + t);
      forces.add({t, 0, 2 * f, f, 3 * f, 9 * f, 20 * f, 0, 0, 0, 0, 0, touching});
      rags.add({t, 0, 0.05 + 0.1 * t, 0, 0.04, double(out), 5 + t});
    }
  }
  void write_case() const {
    std::ofstream(dir / "case.resolved.toml")
        << "[rotating_zone]\nmotion = \"sliding\"\naxis = [0.0, 0.0, 1.0]\norigin_m = [0.0, 0.0, 0.0]\nrotation_speed_rad_s = "
           "125.66\n[rag_passage]\n"
           "inlet_normal = [0.0, 0.0, -1.0]\noutlet_normal = [0.0, 1.0, 0.0]\ntongue_m = [0.03, 0.04, 0.5]\nimpeller_radius_m = 0.1\n";
  }
  static nlohmann::json summary() {
    return nlohmann::json::parse(
        R"({"case": "pump", "exit": 0, "conservation": {}, "rags": [{"id": 0, "name": "rag", "outcome": "exited", "retention_time_s": 0.25,
      "time_to_enter_s": 0.05, "recirculations": 1, "broken_bonds": 0, "stuck_on_tongue_s": 0, "stuck_on_impeller_s": 0,
      "max_wall_overlap_over_radius": 0.7,
      "volute": [{"angle_deg": 0, "time_s": 0.1, "mean_radius_m": 0.11}, {"angle_deg": 20, "time_s": 0, "mean_radius_m": null}],
      "events": [{"t_s": 0.4, "angle_deg": 0, "what": "entered"}, {"t_s": 0.45, "angle_deg": 9, "what": "wholly in the casing"},
                 {"t_s": 0.7, "angle_deg": 99, "what": "exited"}]}]})");
  }
  void write_summary(const nlohmann::json& content) const { std::ofstream(dir / "summary.json") << content; }
  std::string verdict(const nlohmann::json& content) const {
    return passage_verdict(rag_passages(content, dir / "monitors"), PumpRecord(dir / "monitors"));
  }
  std::string page() const {
    std::stringstream text;
    text << std::ifstream(dir / "report.html").rdbuf();
    return text.str();
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
  static std::size_t times(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
  }
};

// Retention, entering, contact and the loss of head stand in one paragraph; the swing of the head with the shaft does not disturb its mean.
TEST_F(PassageReport, TellsTheVerdict) {
  write_pump();
  write_way();
  EXPECT_EQ(verdict(summary()),
            "The rag left the pump 0.25 s after it had wholly entered; it took 0.05 s to enter; it touched the impeller for 0.12 s and the "
            "tongue never; it was carried past the tongue back into the volute once; the head fell by 8 % while it passed.");
}

// Keys that are null or absent, events of the old kind and a run without a pump give shorter sentences, never wrong ones.
TEST_F(PassageReport, SaysOnlyWhatIsKnown) {
  write_way();
  auto content = summary();
  auto& rag = content["rags"][0];
  rag["retention_time_s"] = nullptr, rag["time_to_enter_s"] = nullptr, rag["recirculations"] = nullptr;
  rag["events"] = nlohmann::json::parse(R"([{"t_s": 0.69, "what": "reached the outlet"}, {"t_s": 0.7, "what": "exited"}])");
  EXPECT_EQ(verdict(content), "The rag left the pump; it touched the impeller for 0.12 s and the tongue never.");
  rag["outcome"] = "recirculating";
  rag["events"] = nlohmann::json::parse(R"([{"t_s": 0.4, "what": "entered"}, {"t_s": 0.5, "what": "wholly in the casing"}])");
  EXPECT_TRUE(
      verdict(content).starts_with("The rag was still going round in the casing when the run ended, 0.5 s after it had wholly entered;"))
      << verdict(content);
  rag["outcome"] = "upstream";
  EXPECT_TRUE(verdict(content).starts_with("The rag was still entering the pump when the run ended;")) << verdict(content);
  rag["events"] = nullptr;
  EXPECT_TRUE(verdict(content).starts_with("The rag had not reached the pump when the run ended;")) << verdict(content);
  EXPECT_EQ(verdict({}), "The rag has no outcome yet; it touched the impeller for 0.12 s and the tongue never.");
  std::filesystem::remove(dir / "monitors/passage.csv");
  EXPECT_EQ(verdict(summary()), "");
}

// Means before, while and after are of whole revolutions of the shaft.
TEST_F(PassageReport, TakesMeansOfWholeRevolutions) {
  write_pump();
  const PumpRecord pump(dir / "monitors");
  const auto before = pump.before(0.4), during = pump.during(0.4, 0.7), after = pump.after(0.7);
  ASSERT_TRUE(before && during && after);
  EXPECT_EQ(before->revolutions, 3);
  EXPECT_EQ(during->revolutions, 6);
  EXPECT_NEAR(before->head, 5, 1e-9);
  EXPECT_NEAR(during->head, 4.6, 1e-9);
  EXPECT_NEAR(after->head, 5, 1e-9);
  EXPECT_FALSE(pump.before(0.11)) << "the first revolution does not count, and one more does not tell whether the head had settled";
  EXPECT_EQ(pump.before(0.16)->revolutions, 2);
  EXPECT_FALSE(pump.before(0.45)) << "the head had fallen by 8 % from one revolution to the next";
  EXPECT_FALSE(pump.after(0.97));
  EXPECT_EQ(pump.before(0.85)->revolutions, 3);
  EXPECT_EQ(pump.before(0.81)->revolutions, 2) << "the third revolution before is that in which the head rose by 8 %";
  EXPECT_NEAR(pump.before(0.81)->head, 5, 1e-9);
  EXPECT_NEAR(pump.period(), 0.05, 1e-9);
  const auto mean = pump.sliding_mean("head");
  EXPECT_TRUE(std::isnan(mean[0]) && std::isnan(mean.back()));
  EXPECT_NEAR(mean[200], 5, 1e-2);
  EXPECT_NEAR(mean[550], 4.6, 1e-2);
}

// The summary gives head and power before, while and after a rag passes, null where they are not known.
TEST_F(PassageReport, SummaryGivesTheChangeOfHeadAndPower) {
  write_pump();
  const PumpRecord pump(dir / "monitors");
  Summary run;
  run.rags.resize(3);
  run.rags[0].pump = pump.passage(0.4, 0.7);
  run.rags[1].pump = pump.passage(0.1, 0.97);
  run.rags[2].pump = pump.passage(NAN, NAN);
  const auto rags = summary_json(run)["rags"];
  EXPECT_NEAR(rags[0]["pump"]["head_before_m"], 5, 1e-9);
  EXPECT_NEAR(rags[0]["pump"]["head_passing_m"], 4.6, 1e-9);
  EXPECT_NEAR(rags[0]["pump"]["head_after_m"], 5, 1e-9);
  EXPECT_NEAR(rags[0]["pump"]["head_change_rel"], -0.08, 1e-9);
  EXPECT_NEAR(rags[0]["pump"]["shaft_power_change_rel"], 0, 1e-9);
  for (const char* key : {"head_before_m", "head_after_m", "head_change_rel", "shaft_power_change_rel"})
    EXPECT_TRUE(rags[1]["pump"][key].is_null()) << key;
  EXPECT_TRUE(rags[1]["pump"]["head_passing_m"].is_number());
  EXPECT_TRUE(rags[2]["pump"]["head_passing_m"].is_null());
  const std::vector<std::string> keys = summary_keys();
  EXPECT_TRUE(std::find(keys.begin(), keys.end(), "rags.0.pump.head_change_rel") != keys.end());
}

// The section shows the path with a line for each turn, its means, impeller and tongue; what it shows is not shown again over time.
TEST_F(PassageReport, ShowsThePassageOnce) {
  write_pump();
  write_way();
  write_case();
  write_summary(summary());
  write_report(dir);
  const auto html = page();
  EXPECT_TRUE(holds(html, "<h2>Passage of the rag through the pump</h2>"));
  EXPECT_TRUE(holds(html, "The rag left the pump 0.25 s after"));
  EXPECT_TRUE(holds(html, ">edge of the impeller</text>") && holds(html, ">tongue</text>"));
  EXPECT_TRUE(holds(html, "mean of 20 degrees"));
  EXPECT_TRUE(holds(html, "<td>Revolutions that the mean is over</td><td>3</td><td>6</td><td>3</td>"));
  EXPECT_TRUE(holds(html, "<td>Head</td><td>5 m</td><td>4.6 m</td><td>5 m</td><td>-8 %</td>")) << html.substr(html.find("<td>Head"), 200);
  EXPECT_TRUE(holds(html, "(x, y, z) = (0.01, 0.02, 0.03) m")) << "place of the largest tension";
  EXPECT_TRUE(
      holds(html, "<p>Letters in the plots: <b>a</b> entered, 0.4 s; <b>b</b> wholly in the casing, 0.45 s; <b>c</b> exited, 0.7 s.</p>"));
  const auto over_time = html.substr(html.find("<h2>Over time"));
  for (const char* other : {"passage: ", "rag forces: ", "Largest tension of a bond", "Particles that have left"})
    EXPECT_FALSE(holds(over_time, other)) << other;
  EXPECT_TRUE(holds(html, "Deepest overlap of a particle with a wall, in its radii</td><td>0.7</td><td>0.5</td><td><span class=\"fail\">"));
}

// A monitor with another set of columns costs the section, not the report.
TEST_F(PassageReport, GoesWithoutAMonitorItCannotRead) {
  write_pump(false);
  write_way();
  write_summary(summary());
  write_report(dir);
  EXPECT_TRUE(holds(page(), "The passage of the rags could not be drawn"));
  EXPECT_TRUE(holds(page(), "Rag 0 has left the domain") || holds(page(), "Rag has left the domain")) << "the outcome is told all the same";
}

// So does an event that no run writes: here its name is a number.
TEST_F(PassageReport, GoesWithoutEventsItCannotRead) {
  write_pump();
  write_way();
  auto content = summary();
  content["rags"][0]["events"][1]["what"] = 5;
  write_summary(content);
  write_report(dir);
  EXPECT_TRUE(holds(page(), "The passage of the rags cannot be shown: summary.json has other values than a run writes"));
  EXPECT_TRUE(holds(page(), "<h2>Rags</h2>"));
}

/// A vane along +x at time 0, a square casing around it, and a small sheet beside the shaft, five times.
void write_scene(const std::filesystem::path& dir) {
  for (const char* folder : {"rags", "walls"}) std::filesystem::create_directories(dir / folder);
  VtkPiece walls;
  VtkArray turning{"turning [1]", 1, {}, true};
  const auto box = [&](const Vec3& low, const Vec3& high, double turns) {
    const auto first = static_cast<std::int64_t>(walls.points.size());
    for (int corner = 0; corner < 8; ++corner)
      walls.points.push_back({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    for (const auto& side : {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
      for (const int corner : side) walls.connectivity.push_back(first + corner);
      walls.offsets.push_back(static_cast<std::int64_t>(walls.connectivity.size()));
      turning.values.push_back(turns);
    }
  };
  box({-0.2, -0.2, 0}, {0.2, 0.2, 0.1}, 0);
  box({0.02, -0.01, 0}, {0.1, 0.01, 0.1}, 1);
  walls.cell_arrays = {turning};
  write_vtk(dir / "walls/walls_0.vtp", VtkKind::polygons, walls);
  VtkCollection(dir / "walls/walls.pvd", false).add(0, "walls_0.vtp");
  VtkCollection rags(dir / "rags/rags.pvd", false);
  for (int k = 0; k < 5; ++k) {
    VtkPiece sheet;
    const double x = -0.15;
    sheet.points = {{x, -0.02, 0.05}, {x + 0.04, -0.02, 0.05}, {x, 0.02, 0.06}};
    sheet.connectivity = {0, 1, 2}, sheet.offsets = {3};
    sheet.point_arrays = {{"tension [N]", 1, {1.0, 2.0, 3.0}, true}};
    const std::string name = "rags_" + std::to_string(k) + ".vtp";
    write_vtk(dir / "rags" / name, VtkKind::polygons, sheet);
    rags.add(0.4125 + 0.0125 * k, name);  // a quarter of a revolution apart
  }
}

// Seen from the inlet the vane stands where the shaft has turned it, though walls were written only once; a film has all instants.
TEST_F(PassageReport, TurnsTheImpellerInItsPictures) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML, matplotlib' 2> /dev/null && command -v xvfb-run > /dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9, python3-matplotlib or xvfb is not installed";
  write_pump();
  write_way();
  write_case();
  write_summary(summary());
  write_scene(dir);
  write_report(dir);
  EXPECT_EQ(times(page(), "<img"), 5u + 2u) << "instants, their scale, the path";
  EXPECT_FALSE(holds(page(), "missing:")) << page().substr(page().find("missing:"), 300);
  const Film film = make_film(dir);
  EXPECT_EQ(film.n_pictures, 5u);
  EXPECT_EQ(film.problem, "");
  std::ofstream(dir / "check.py") << R"(
import sys, numpy, matplotlib.image as image
p = image.imread(f'{sys.argv[1]}/pictures/film_0001.png')
print(p.shape[0] % 2, p.shape[1] % 2)
for i in range(1, 6):
    p = image.imread(f'{sys.argv[1]}/pictures/rag_{i}.png')[110:, :, :3]
    vane = (p[..., 2] > p[..., 0] + 0.1)
    y, x = (k.mean() for k in vane.nonzero())
    red = (p[..., 0] > p[..., 2] + 0.1)
    y0, x0 = 0.5 * p.shape[0] - 35, 0.5 * p.shape[1]  # below the line of the time
    print(round(numpy.degrees(numpy.arctan2(y0 - y, x - x0)) / 90) % 4, red.nonzero()[1].mean() < x0)
)";
  ASSERT_EQ(
      std::system(("/usr/bin/python3 " + (dir / "check.py").string() + " " + dir.string() + " > " + (dir / "check.txt").string()).c_str()),
      0);
  std::stringstream text;
  text << std::ifstream(dir / "check.txt").rdbuf();
  EXPECT_EQ(text.str(), "0 0\n1 True\n2 True\n3 True\n0 True\n1 True\n") << "quarters of a turn, the rag to the left";
}

}  // namespace
}  // namespace snag
