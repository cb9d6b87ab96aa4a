// ranks: 1 2
// The monitors of a pump whose head is known at every angle: what is written, and that a resumed run writes the same.
#include "simulation/output/pump_output.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/atomic_file.hpp"
#include "base/series.hpp"
#include "base/words.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "report/pump_section.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

namespace {

using namespace snag;

constexpr double two_pi = 2 * std::numbers::pi, degree = two_pi / 360, omega = 20 * two_pi, dt = 2e-4;  // 1.44 degrees a step

double head_at(double angle) { return 4 + std::cos(angle - 50 * degree) + 0.2 * std::cos(3 * angle); }
double torque_at(double angle) { return -10 + 0.5 * std::cos(2 * (angle - 30 * degree)); }

class PumpOutputTest : public testing::Test {
 protected:
  PumpOutputTest() {
    int process = getpid();
    MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
    dir = std::filesystem::temp_directory_path() / ("snag-pump-output-" + std::to_string(process));
    if (root) std::filesystem::create_directories(dir / "checkpoint");
    flow.density = 1000, flow.time_step_size = dt;
    settings.gravity = 10;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~PumpOutputTest() override {
    MPI_Barrier(MPI_COMM_WORLD);
    if (root) std::filesystem::remove_all(dir);
  }
  RotorState rotor(double time) const { return {{.origin = {}, .axis = {0, 0, 1}, .speed = omega}, 0.25 + omega * time, true}; }
  /// One step of the made-up pump: 1 m2 flanges, 0.2 m3/s.
  void step(PumpOutput& output, int number) {
    flow.time = number * dt;
    const double angle = 0.25 + omega * flow.time;
    for (const Patch& patch : mesh.patches)
      for (int f = patch.first; f < patch.end(); ++f) {
        const int b = f - mesh.n_interior;
        if (patch.name[0] == 'x') flow.flux[f] = 0.2 * mesh.face_vector[f].x;
        if (patch.name == "x1") flow.boundary_pressure[b] = 1e4 * (head_at(angle) + climb * std::min(0.0, flow.time / climbing_time - 1));
        if (patch.name == "y1") flow.boundary_friction[b] = {-torque_at(angle) * norm(mesh.face_vector[f]), 0, 0};
      }
    output.after_step(flow, rotor(flow.time), contacts_at(angle));
  }
  static double contacts_at(double angle) { return -3 + std::sin(angle); }  // N m, of rags on the rotor
  double climb = 0, climbing_time = 1;                                      // by which the head still rises, m; until then, s

  std::string text(const std::string& name) const { return file_text(dir / name).value_or(""); }

  bool root = rank_of(MPI_COMM_WORLD) == 0;
  std::filesystem::path dir;
  Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 1, 1}, {4, 3, 5});
  Flow flow{mesh};
  PumpSettings settings{.inlet = "x0", .outlet = "x1", .walls = {"y1"}, .inlet_diameter = {}, .outlet_diameter = {}};
};

/// Every column of a file of monitors/ has a row with its name and unit in docs/outputs.md.
void expect_documented(const std::filesystem::path& file) {
  const std::string page = file_text(in_sources("docs/outputs.md")).value_or("");
  const std::size_t begin = page.find("### " + file.filename().string());
  ASSERT_NE(begin, std::string::npos) << file;
  const auto rows = split(page.substr(begin, page.find("\n### ", begin) - begin), '\n');
  for (const std::string& column : split(split(file_text(file).value_or(""), '\n').front(), ',')) {
    const std::string name = column.substr(0, column.find(' ')),
                      unit = column.substr(column.find('[') + 1, column.find(']') - column.find('[') - 1);
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(),
                            [&](const std::string& row) {
                              return row.find("`" + name + "`") < row.find("| " + unit + " |") &&
                                     row.find("| " + unit + " |") != std::string::npos;
                            }))
        << file << ": " << column << " has no row in docs/outputs.md";
  }
}

TEST_F(PumpOutputTest, RevolutionsAndPhase) {
  PumpOutput output(dir, flow, settings, rotor(0), false, 0);
  for (int i = 1; i <= 100; ++i) step(output, i);
  EXPECT_NEAR(output.summary().revolutions, 0.4, 1e-12);
  double mean = 0;
  for (int i = 1; i <= 100; ++i) mean += 0.01 * head_at(0.25 + i * 1.44 * degree);
  EXPECT_NEAR(output.summary().head, mean, 0.02) << "of what there is of the first revolution";
  for (int i = 101; i <= 1000; ++i) step(output, i);
  EXPECT_GE(output.summary().revolutions, 4) << "whatever the round-off of the angle";
  for (int i = 1001; i <= 1010; ++i) step(output, i);
  if (root) output.write_phase();
  const PumpSummary pump = output.summary();
  EXPECT_NEAR(pump.flow, 0.2, 1e-12);
  EXPECT_NEAR(pump.head, 4, 1e-6);
  EXPECT_NEAR(pump.torque, -10, 1e-6);
  EXPECT_NEAR(pump.shaft_power, 10 * omega, 1e-4);
  EXPECT_NEAR(pump.efficiency, 1e4 * 0.2 * 4 / (10 * omega), 1e-6) << "of the water, as torque and shaft power are";
  EXPECT_NEAR(pump.torque_contacts, -3, 1e-6);
  EXPECT_NEAR(pump.shaft_power_total, 13 * omega, 1e-4);
  EXPECT_NEAR(pump.revolutions, 4.04, 1e-12);
  if (!root) return;

  const SeriesTable instants = read_series(dir / "pump.csv"), table = read_series(dir / "revolutions.csv"),
                    phase = read_series(dir / "phase.csv");
  for (const char* file : {"pump.csv", "revolutions.csv", "phase.csv"}) expect_documented(dir / file);
  ASSERT_EQ(instants.column("time").size(), 1010u);
  EXPECT_NEAR(instants.column("angle")[249], 0.25 / degree, 1e-9) << "after one revolution where it started";
  EXPECT_NEAR(instants.column("head")[36], head_at(0.25 + 37 * 1.44 * degree), 1e-9);
  EXPECT_NEAR(instants.column("torque_contacts")[36], contacts_at(0.25 + 37 * 1.44 * degree), 1e-9);
  EXPECT_NEAR(instants.column("shaft_power_total")[36] - instants.column("shaft_power")[36],
              -omega * instants.column("torque_contacts")[36], 1e-9);
  ASSERT_EQ(table.column("revolution"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_NEAR(table.column("time")[3], 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(table.column("head_change_rel")[0]));
  EXPECT_NEAR(table.column("head_change_rel")[3], 0, 1e-9);
  EXPECT_NEAR(table.column("head_harmonic_1")[3], 1, 1e-6);
  EXPECT_NEAR(table.column("head_phase_1")[3], 50, 1e-6);
  EXPECT_NEAR(table.column("head_harmonic_3")[3], 0.2, 1e-6);
  EXPECT_NEAR(table.column("torque_harmonic_2")[3], 0.5, 1e-6);
  EXPECT_NEAR(table.column("torque_phase_2")[3], 60, 1e-6);
  EXPECT_NEAR(table.column("head_noise")[3], 0, 1e-6);
  EXPECT_NEAR(table.column("torque_max")[3], -9.5, 1e-3);
  ASSERT_EQ(phase.column("angle").size(), 72u);
  for (std::size_t bin = 0; bin < 72; ++bin) {
    EXPECT_NEAR(phase.column("head_mean")[bin], head_at(phase.column("angle")[bin] * degree), 2e-3);
    EXPECT_NEAR(phase.column("torque_mean")[bin], torque_at(phase.column("angle")[bin] * degree), 2e-3);
    EXPECT_NEAR(phase.column("head_deviation")[bin], 0, 1e-9);
  }
  EXPECT_EQ(phase.column("revolutions")[0], 3);

  // The report finds its numbers in these files: the last two revolutions side by side, and its six plots.
  const std::string html = pump_section({{"pump", {{"head_m", 4.0}, {"revolutions", 4.04}}}}, dir);
  const auto times = [&](const std::string& text) {
    std::size_t n = 0;
    for (std::size_t at = html.find(text); at != std::string::npos; at = html.find(text, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(times("class=\"problem\""), 0u) << html;
  EXPECT_EQ(times("<th>Revolution 4</th><th>Revolution 3</th>"), 1u);
  EXPECT_EQ(times("<td>Head</td><td>4 m</td>"), 2u) << "in the summary and in the table of revolutions";
  EXPECT_EQ(times("<tr><td>1</td><td>1 m</td><td>50°</td>"), 1u);
  EXPECT_EQ(times("<svg"), 6u);
  EXPECT_EQ(times("stroke-width=\"0.7\""), 2u * 2 + 2 * 2) << "two revolutions between the first and the last, and the scatter, twice";
}

// A periodic flow after a start-up in which the head climbs for three revolutions is called periodic: the start-up is no part of its
// averages.
TEST_F(PumpOutputTest, PhaseAveragesLeaveOutTheStartUp) {
  climb = 2, climbing_time = 0.15;
  PumpOutput output(dir, flow, settings, rotor(0), false, 0);
  for (int i = 1; i <= 2010; ++i) step(output, i);
  if (!root) return;
  output.write_phase();
  const std::vector<double> start_up = read_series(dir / "revolutions.csv").column("start_up");
  ASSERT_EQ(start_up.size(), 8u);
  for (std::size_t i = 0; i < start_up.size(); ++i) EXPECT_EQ(start_up[i] != 0, i < 4) << i;
  const SeriesTable phase = read_series(dir / "phase.csv");
  EXPECT_EQ(phase.column("revolutions")[0], 4);
  for (std::size_t bin = 0; bin < 72; ++bin) {
    EXPECT_NEAR(phase.column("head_mean")[bin], head_at(phase.column("angle")[bin] * degree), 2e-3);
    EXPECT_NEAR(phase.column("head_deviation")[bin], 0, 1e-9);
  }
}

TEST_F(PumpOutputTest, ResumedRunWritesTheSame) {
  constexpr int middle = 620, n_steps = 1020;
  {
    PumpOutput whole(dir, flow, settings, rotor(0), false, 0);
    for (int i = 1; i <= n_steps; ++i) {
      step(whole, i);
      if (i != middle) continue;
      CheckpointWriter writer(MPI_COMM_WORLD, dir / "checkpoint",
                              {.case_sha256 = "", .ranks = size_of(MPI_COMM_WORLD), .time_step = i, .time = i * dt});
      whole.save(writer);
      writer.finish();
    }
    if (root) whole.write_phase();
  }
  const std::string names[] = {"pump.csv", "revolutions.csv", "phase.csv"};
  std::vector<std::string> before;
  for (const std::string& name : names) before.push_back(text(name));
  MPI_Barrier(MPI_COMM_WORLD);
  PumpOutput resumed(dir, flow, settings, rotor(0), true, middle * dt);
  CheckpointReader reader(MPI_COMM_WORLD, dir / "checkpoint");
  resumed.load(reader);
  for (int i = middle + 1; i <= n_steps; ++i) step(resumed, i);
  if (!root) return;
  resumed.write_phase();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GT(before[i].size(), 100u);
    EXPECT_EQ(text(names[i]), before[i]) << names[i];
  }
}

// In a frame the rotor stands at its angle; the shaft counts on, and with a ramp by the mean speed of each step.
TEST_F(PumpOutputTest, FrameCountsTheShaft) {
  RotorState still = rotor(0);
  still.slides = false, still.shaft.speed = 0;
  PumpOutput output(dir, flow, settings, still, false, 0);
  for (int i = 1; i <= 100; ++i) {
    flow.time = i * dt, still.shaft.speed = omega * std::min(1.0, i / 50.0);
    output.after_step(flow, still);
  }
  EXPECT_NEAR(output.summary().revolutions, (25 + 50) * dt * 20, 1e-12);
  if (!root) return;
  EXPECT_NEAR(read_series(dir / "pump.csv").column("angle").back(), 0.25 / degree, 1e-9);
}

}  // namespace
