// ranks: 1 3
// long ranks: 2
// Head, torque and power of a made-up flow, against numbers worked out by hand.
#include "solver/pump_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "solver/monitors.hpp"
#include "tests/structured_box.hpp"

namespace {

using namespace snag;

/// A box of 2 m x 1 m x 1 m; 0.3 m3/s go through it along x, the outlet is 5000 Pa + 500 Pa/m y above the inlet; the wall y1 is pressed
/// with 100 Pa and drawn along x with 3 Pa.
class PumpMonitorTest : public testing::Test {
 protected:
  PumpMonitorTest() {
    flow.density = 1000;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
        const int b = f - mesh.n_interior;
        const std::string& name = mesh.patches[p].name;
        if (name == "x0" || name == "x1") flow.flux[f] = 0.3 * mesh.face_vector[f].x;
        if (name == "x0") flow.boundary_pressure[b] = 1000;
        if (name == "x1") flow.boundary_pressure[b] = 6000 + 500 * mesh.face_centre[f].y;
        if (name == "y1") flow.boundary_pressure[b] = 100, flow.boundary_friction[b] = {3 * norm(mesh.face_vector[f]), 0, 0};
      }
  }
  Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {2, 1, 1}, {8, 6, 4});
  Flow flow{mesh};
  PumpSettings settings{.inlet = "x0", .outlet = "x1", .walls = {"y1"}, .inlet_diameter = {}, .outlet_diameter = {}};
};

TEST_F(PumpMonitorTest, HeadTorqueAndPower) {
  settings.outlet_diameter = 0.8, settings.gravity = 10;
  const PumpMonitor monitor(flow, settings);
  const PumpReading now = monitor.read(flow, {.origin = {0.5, 0, 0}, .axis = {0, 0, 1}, .speed = -7});
  EXPECT_NEAR(now.flow_in, 0.3, 1e-12);
  EXPECT_NEAR(now.flow_out, 0.3, 1e-12);
  const double out = 0.3 / (std::numbers::pi * 0.16), in = 0.3 / 1;
  const double head = 5250 / 1e4 + (out * out - in * in) / 20;
  EXPECT_NEAR(now.head, head, 1e-12);
  // x F_y - y F_x: 100 Pa on 2 m2 whose middle is 0.5 m from the axis; 6 N at 1 m
  EXPECT_NEAR(now.torque_pressure, 100, 1e-9);
  EXPECT_NEAR(now.torque_friction, -6, 1e-12);
  EXPECT_NEAR(now.shaft_power, 94 * 7, 1e-9);
  EXPECT_NEAR(now.hydraulic_power, 1e4 * 0.3 * head, 1e-9);
  EXPECT_NEAR(now.efficiency(), 3e3 * head / 658, 1e-12);
}

// The velocity through a face is that of its flux, along it that of the cell: the inlet's own velocity counts, not that of half a cell on.
TEST_F(PumpMonitorTest, TotalHeadTakesTheVelocityAtTheFaces) {
  for (Vec3& u : flow.velocity) u = {55, 0.4, 0};
  settings.gravity = 10;
  const PumpReading now = PumpMonitor(flow, settings).read(flow, {.origin = {}, .axis = {0, 0, 1}});
  const double kinetic = 500 * (0.3 * 0.3 + 0.4 * 0.4);
  EXPECT_NEAR(flux_means(flow, mesh.patch_index("x0")).total_pressure, 1000 + kinetic, 1e-9);
  EXPECT_NEAR(now.head_total, 5250 / 1e4, 1e-12);
  EXPECT_EQ(now.efficiency(), 0) << "no power where the shaft stands";
}

// Requirement: inlet and outlet are two patches; a diameter far from that of its patch is remarked on.
TEST_F(PumpMonitorTest, FlangesAreThoseOfTheMesh) {
  settings.inlet_diameter = 1.1;  // the patch: 1 m2, as of a circle of 1.128 m
  EXPECT_TRUE(pump_warnings(flow, settings).empty());
  settings.inlet_diameter = 0.11;
  ASSERT_EQ(pump_warnings(flow, settings).size(), 1u);
  EXPECT_NE(pump_warnings(flow, settings)[0].find("inlet_diameter is 110 mm, patch \"x0\" has the area of a circle of 1128.4 mm"),
            std::string::npos)
      << pump_warnings(flow, settings)[0];
  settings.outlet = "x0";
  EXPECT_THROW(PumpMonitor(flow, settings), Error);
}

TEST_F(PumpMonitorTest, UnknownPatchIsNamed) {
  settings.walls = {"y1", "impeler"};
  try {
    PumpMonitor(flow, settings);
    FAIL() << "must throw";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("[pump] walls: the mesh has no patch \"impeler\""), std::string::npos) << error.what();
  }
}

}  // namespace
