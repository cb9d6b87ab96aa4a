// timeout: 600
// Tanks: as the suction side of the pump, and on their own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

// A plate stands 125 mm before the eye of a pump that draws from a tank; the tank's surface is the inlet.
TEST(PumpTank, HasAPlateBeforeTheEye) {
  const auto made = snag_mesh("pump --set inlet=tank tank_length='0.6 m' --out pump_tank.msh");
  ASSERT_EQ(made.code, 0) << made.output;
  const auto mesh = read_mesh(folder() / "pump_tank.msh");
  EXPECT_EQ(leaks(mesh), std::vector<std::string>{});
  double nearest = 1;
  for (const int node : mesh.nodes_of("plate")) nearest = std::min(nearest, mesh.node.at(node).z);
  EXPECT_NEAR(nearest - 0.086, 0.125, 1e-9);
  EXPECT_NEAR(mesh.area("plate"), 2 * 0.4 * 0.4 + 4 * 0.4 * 0.01, 1e-9);
  for (const int node : mesh.nodes_of("inlet")) EXPECT_NEAR(mesh.node.at(node).y, 0.58 - 0.25, 1e-9);
  EXPECT_NEAR(mesh.area("inlet"), 0.56 * 0.6, 1e-9);
  EXPECT_GT(mesh.of("tank_walls").size(), 100U);
  EXPECT_NEAR(mesh.area("interface_rotor") / mesh.area("interface_stator"), 1, 5e-5);
}

// A tank with its pipe at the side holds box and pipe and is open at its surface and at the pipe's end.
TEST(Tank, EmptiesThroughItsSide) {
  ASSERT_EQ(snag_mesh("tank --set outlet_at=side --out tank.msh").code, 0);
  const auto mesh = read_mesh(folder() / "tank.msh");
  EXPECT_EQ(leaks(mesh), std::vector<std::string>{});
  const double pipe = std::numbers::pi * 0.05 * 0.05;
  EXPECT_NEAR(mesh.volume("fluid"), 0.6 * 0.5 * 0.4 + pipe * 0.3, 0.02 * pipe * 0.3);
  EXPECT_NEAR(mesh.area("inlet"), 0.6 * 0.4, 1e-9);
  EXPECT_NEAR(mesh.area("outlet") / pipe, 1, 0.02);
  for (const int node : mesh.nodes_of("outlet")) EXPECT_NEAR(mesh.node.at(node).x, 0.9, 1e-9);
}

// A tank with its pipe at the bottom has its outlet below the floor.
TEST(Tank, EmptiesThroughItsFloor) {
  ASSERT_EQ(snag_mesh("tank --out tank_floor.msh").code, 0);
  const auto mesh = read_mesh(folder() / "tank_floor.msh");
  EXPECT_EQ(leaks(mesh), std::vector<std::string>{});
  for (const int node : mesh.nodes_of("outlet")) EXPECT_NEAR(mesh.node.at(node).y, -0.3, 1e-9);
}
