// Pipe, channel, box and blade rows: exact volumes, counts and periodic partners.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

namespace {

constexpr double pi = std::numbers::pi;

MeshFile made(const std::string& arguments, const std::string& name) {
  const auto outcome = snag_mesh(arguments + " --out " + name);
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  auto mesh = read_mesh(folder() / name);
  EXPECT_EQ(leaks(mesh), std::vector<std::string>{}) << arguments;
  return mesh;
}

// Farthest distance of a node of `first`, shifted, to the nearest node of `second`.
double mismatch(const MeshFile& mesh, const std::string& first, const std::string& second, const Vec3& shift) {
  double worst = 0;
  const auto partners = mesh.nodes_of(second);
  for (const int a : mesh.nodes_of(first)) {
    double nearest = 1e9;
    for (const int b : partners) nearest = std::min(nearest, norm(mesh.node.at(a) + shift - mesh.node.at(b)));
    worst = std::max(worst, nearest);
  }
  return worst;
}

}  // namespace

// A box of hexahedra has the cells asked for and fills its corners exactly.
TEST(BoxMesh, OfHexahedraIsExact) {
  const auto mesh = made("box --set cells=hexahedra size_m=0.125 'upper_m=[2, 1, 0.5]'", "box_hexahedra.msh");
  EXPECT_EQ(mesh.of("fluid").size(), 16U * 8U * 4U);
  EXPECT_NEAR(mesh.volume("fluid"), 1, 1e-12);
  for (const auto* name : {"x0", "x1", "y0", "y1", "z0", "z1"}) EXPECT_FALSE(mesh.of(name).empty()) << name;
  for (const int node : mesh.nodes_of("x1")) EXPECT_EQ(mesh.node.at(node).x, 2);
}

// Halving the size of tetrahedra multiplies their number by about eight.
TEST(BoxMesh, OfTetrahedraFollowsItsSize) {
  const auto coarse = made("box --set size_m=0.2", "box_coarse.msh"), fine = made("box --set size='100 mm'", "box_fine.msh");
  EXPECT_NEAR(coarse.volume("fluid"), 1, 1e-12);
  EXPECT_NEAR(static_cast<double>(fine.of("fluid").size()) / static_cast<double>(coarse.of("fluid").size()), 8, 2);
}

// Periodic sides of a channel of tetrahedra have the same nodes, shifted by the period.
TEST(ChannelMesh, PeriodicSidesMatch) {
  const auto mesh = made("channel --set cells=tetrahedra periodic_x=true periodic_z=true 'length=0.3 m'", "channel_periodic.msh");
  EXPECT_LT(mismatch(mesh, "periodic_x0", "periodic_x1", {0.3, 0, 0}), 1e-12);
  EXPECT_LT(mismatch(mesh, "periodic_z0", "periodic_z1", {0, 0, 0.1}), 1e-12);
  EXPECT_EQ(mesh.of("periodic_x0").size(), mesh.of("periodic_x1").size());
  EXPECT_FALSE(mesh.group.contains("inlet"));
}

// Cell heights of a graded channel grow from both walls, the largest wall_ratio times the smallest.
TEST(ChannelMesh, IsGradedToItsWalls) {
  const auto mesh = made("channel --set cells_x=4 cells_y=10 cells_z=3 wall_ratio=5", "channel_graded.msh");
  EXPECT_EQ(mesh.of("fluid").size(), 120U);
  std::set<long> heights;
  for (const int node : mesh.nodes_of("inlet")) heights.insert(std::lround(mesh.node.at(node).y * 1e10));
  ASSERT_EQ(heights.size(), 11U);
  std::vector<double> cells;
  for (auto y = std::next(heights.begin()); y != heights.end(); ++y) cells.push_back(static_cast<double>(*y - *std::prev(y)));
  EXPECT_NEAR(cells.front() / cells.back(), 1, 1e-6);
  EXPECT_NEAR(*std::ranges::max_element(cells) / cells.front(), 5, 1e-6);
  for (const auto* name : {"inlet", "outlet", "bottom", "top", "side_z0", "side_z1"}) EXPECT_FALSE(mesh.of(name).empty()) << name;
}

// A straight swept pipe holds the volume of the prism over its polygon.
TEST(PipeMesh, SweptHoldsThePolygonsVolume) {
  const auto mesh = made("pipe --set cells=swept n_around=48 'axial_size=0.1 m'", "pipe_swept.msh");
  EXPECT_NEAR(mesh.volume("fluid") / (3 * 24 * 0.01 * std::sin(2 * pi / 48)), 1, 1e-9);
  for (const int node : mesh.nodes_of("walls")) {
    const Vec3 x = mesh.node.at(node);
    EXPECT_NEAR(std::hypot(x.y, x.z), 0.1, 1e-9);
  }
}

// A bent pipe rises along +y into a bend and leaves along +x; both kinds of cells fill the same shape.
TEST(PipeMesh, BendTurnsFromUpToAlong) {
  const double shape = pi * 0.01 * (1 + pi / 2 * 0.3 + 0.4);
  for (const std::string cells : {"tetrahedra", "swept"}) {
    const auto mesh =
        made("pipe --set 'bend_angle=90 deg' 'length=1 m' wall_size_m=0.025 core_size_m=0.04 cells=" + cells, "bend_" + cells + ".msh");
    EXPECT_NEAR(mesh.volume("fluid") / shape, 1, 0.015) << cells;
    for (const int node : mesh.nodes_of("inlet")) EXPECT_NEAR(mesh.node.at(node).y, -0.7, 1e-9);
    for (const int node : mesh.nodes_of("outlet")) EXPECT_NEAR(mesh.node.at(node).x, 1, 1e-9);
  }
}

// Blades and vanes that are plane quadrangles: rings less their areas, walls as long as their outlines, both sides of the interface on one
// circle with nodes of their own.
TEST(BladeRowsMesh, HoldsTheRingsLessTheBlades) {
  const std::string sizes =
      " inlet_radius_mm=100 sliding_radius_mm=160 outlet_radius_mm=220 thickness_mm=4 wall_size_mm=5 edge_size_mm=2 core_size_mm=8";
  const std::string rows =
      " blades=3 'blade_radius_mm=[115, 140, 140, 115]' 'blade_angle_deg=[0, 0, 10, 10]' vanes=5 'vane_radius_mm=[180, 205, 205, 180]' "
      "'vane_angle_deg=[0, 0, 6, 6]'";
  const auto mesh = made("blade_rows --set" + sizes + rows, "blade_rows.msh");
  struct Ring {
    std::string volume, walls, interface;
    double inner, outer, near, far, angle;
    int count;
  };
  for (const Ring& ring : {Ring{"rotor", "impeller_walls", "interface_rotor", 0.1, 0.16, 0.115, 0.14, pi / 18, 3},
                           Ring{"stator", "vane_walls", "interface_stator", 0.16, 0.22, 0.18, 0.205, pi / 30, 5}}) {
    const double blade = (ring.far * ring.far - ring.near * ring.near) / 2 * std::sin(ring.angle);
    const double outline = 2 * (ring.far - ring.near) + 2 * (ring.far + ring.near) * std::sin(ring.angle / 2);
    EXPECT_NEAR(mesh.volume(ring.volume) / (0.004 * (pi * (ring.outer * ring.outer - ring.inner * ring.inner) - ring.count * blade)), 1,
                1e-3);
    EXPECT_NEAR(mesh.area(ring.walls) / (0.004 * ring.count * outline), 1, 1e-9) << ring.walls;
    for (const int node : mesh.nodes_of(ring.interface)) EXPECT_NEAR(std::hypot(mesh.node.at(node).x, mesh.node.at(node).y), 0.16, 1e-9);
  }
  const auto rotor = mesh.nodes_of("interface_rotor"), stator = mesh.nodes_of("interface_stator");
  for (const int node : rotor) EXPECT_FALSE(stator.contains(node));
}

// In three dimensions: the rings less the blades, which end at the tip gap, and an axial inlet. Planes and the walls of blades are exact;
// the inlet is a body of revolution between polygons, of which the volume is integrated here along the axis.
TEST(BladeRowsMesh, HoldsTheMachineBetweenHubAndCasing) {
  const std::string sizes =
      " inlet_radius_mm=100 sliding_radius_mm=160 outlet_radius_mm=220 thickness_mm=30 wall_size_mm=5 edge_size_mm=2 core_size_mm=5";
  const std::string rows =
      " blades=3 'blade_radius_mm=[115, 140, 140, 115]' 'blade_angle_deg=[0, 0, 10, 10]' vanes=5 'vane_radius_mm=[180, 205, 205, 180]' "
      "'vane_angle_deg=[0, 0, 6, 6]'";
  const std::string across =
      " cells_across=8 across_ratio=4 tip_gap_mm=1 tip_gap_cells=2 casing_fillet_mm=20 hub_fillet_mm=80 hub_radius_mm=90 "
      "inlet_length_mm=90";
  const auto mesh = made("blade_rows --set" + sizes + rows + across, "blade_rows_across.msh");
  const double span = 0.03, gap = 0.001;
  const double blade = (0.14 * 0.14 - 0.115 * 0.115) / 2 * std::sin(pi / 18), vane = (0.205 * 0.205 - 0.18 * 0.18) / 2 * std::sin(pi / 30);
  const double around_blade = 0.05 + 0.51 * std::sin(pi / 36), around_vane = 0.05 + 0.77 * std::sin(pi / 60);
  EXPECT_NEAR(mesh.area("impeller_walls") / (3 * (around_blade * (span - gap) + blade)), 1, 1e-9);
  EXPECT_NEAR(mesh.area("vane_walls") / (5 * around_vane * span), 1, 1e-9);
  EXPECT_FALSE(mesh.group.contains("planes"));

  // Between front casing and hub, for z from the inlet to the hub's plane.
  const auto quarter = [](double radius, double R, double x) { return radius - (x < 0 ? R : std::sqrt(R * R - x * x)); };
  double inlet = 0;
  const int n = 20000;
  for (int k = 0; k < n; ++k) {
    const double z = -0.09 + (k + 0.5) / n * (span + 0.09);
    const double casing = z > 0 ? 0.1 : quarter(0.1, 0.02, z + 0.02), hub = quarter(0.09, 0.08, z + 0.05);
    inlet += pi * (casing * casing - hub * hub) * (span + 0.09) / n;
  }
  const double rotor = inlet + span * pi * (0.16 * 0.16 - 0.1 * 0.1) - 3 * (span - gap) * blade;
  EXPECT_NEAR(mesh.volume("rotor") / rotor, 1, 3e-3);
  EXPECT_NEAR(mesh.volume("stator") / (span * (pi * (0.22 * 0.22 - 0.16 * 0.16) - 5 * vane)), 1, 1e-3);
  EXPECT_NEAR(mesh.area("inlet") / (pi * (0.08 * 0.08 - 0.01 * 0.01)), 1, 3e-3);
  for (const int node : mesh.nodes_of("inlet")) EXPECT_NEAR(mesh.node.at(node).z, -0.09, 1e-12);
  for (const int node : mesh.nodes_of("rod")) EXPECT_NEAR(std::hypot(mesh.node.at(node).x, mesh.node.at(node).y), 0.01, 1e-9);
  for (const int node : mesh.nodes_of("diffuser_walls")) EXPECT_NEAR(std::abs(mesh.node.at(node).z - span / 2), span / 2, 1e-12);

  // Hub and casing lie on the shape, the hub as far as the rod; blades begin beyond the gap.
  for (const int node : mesh.nodes_of("casing")) {
    const Vec3 x = mesh.node.at(node);
    const double r = std::hypot(x.x, x.y);
    EXPECT_NEAR(r > 0.1 - 1e-9 ? x.z : x.z > -0.02 ? std::hypot(r - 0.1, x.z + 0.02) - 0.02 : r - 0.08, 0, 1e-9);
  }
  for (const int node : mesh.nodes_of("hub")) {
    const Vec3 x = mesh.node.at(node);
    const double r = std::hypot(x.x, x.y);
    EXPECT_GE(x.z, -0.05 - 1e-9);
    EXPECT_NEAR(r > 0.09 ? x.z - span : std::hypot(r - 0.09, x.z + 0.05) - 0.08, 0, 1e-9);
  }
  double lowest = 1;
  for (const int node : mesh.nodes_of("impeller_walls")) lowest = std::min(lowest, mesh.node.at(node).z);
  EXPECT_NEAR(lowest, gap, 1e-12);
}

// A plane flow has no gap at the tips; a rod and a pipe need room on the axis and before the casing.
TEST(BladeRowsMesh, RefusesAnInletThatDoesNotFit) {
  const std::string rows =
      "blade_rows --out blade_rows_no_inlet.msh --set 'blade_radius_mm=[150, 200, 200, 150]' 'blade_angle_deg=[0, 0, 10, 10]' "
      "'vane_radius_mm=[240, 260, 260, 240]' 'vane_angle_deg=[0, 0, 6, 6]' thickness_mm=40 ";
  for (const auto& [values, words] :
       {std::pair<std::string, std::string>{"tip_gap_mm=1", "a plane flow"},
        {"cells_across=8 tip_gap_mm=30", "below half of thickness"},
        {"cells_across=8 casing_fillet_mm=20 hub_fillet_mm=95 hub_radius_mm=90", "hub_radius"},
        {"cells_across=8 casing_fillet_mm=70 hub_fillet_mm=95 hub_radius_mm=96", "pipe wider than the rod"},
        {"cells_across=8 casing_fillet_mm=20 hub_fillet_mm=95 hub_radius_mm=99 inlet_length_mm=40", "inlet_length"}}) {
    const auto refused = snag_mesh(rows + values);
    EXPECT_EQ(refused.code, 2) << values << "\n" << refused.output;
    EXPECT_NE(refused.output.find(words), std::string::npos) << values << "\n" << refused.output;
  }
}

// Layers that would reach over the sliding interface are refused with the place; so is an outline with radii and angles of different
// numbers.
TEST(BladeRowsMesh, RefusesRowsWithoutRoom) {
  const std::string rows =
      "blade_rows --out blade_rows_refused.msh --set 'blade_angle_deg=[0, 0, 10, 10]' 'vane_radius_mm=[240, 260, 260, 240]' "
      "'vane_angle_deg=[0, 0, 6, 6]'";
  const auto close = snag_mesh(rows + " 'blade_radius_mm=[150, 216, 216, 150]'"),
             short_of_one = snag_mesh(rows + " 'blade_radius_mm=[150, 200, 200]'");
  EXPECT_EQ(close.code, 2) << close.output;
  EXPECT_NE(close.output.find("room for the layers"), std::string::npos) << close.output;
  EXPECT_EQ(short_of_one.code, 2) << short_of_one.output;
  EXPECT_NE(short_of_one.output.find("complete them"), std::string::npos) << short_of_one.output;
}
