// timeout: 600
// The pump that snag-mesh makes without any parameter, against figures that were computed without it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

namespace {

constexpr double pi = std::numbers::pi;

struct PumpMesh : testing::Test {
  static inline Outcome made;
  static inline MeshFile mesh;
  static void SetUpTestSuite() {
    made = snag_mesh("pump --out pump.msh");
    mesh = read_mesh(folder() / "pump.msh");
  }
};

}  // namespace

// The default pump passes its checks with about 30 thousand tetrahedra.
TEST_F(PumpMesh, HasTheCellsOfItsResolution) {
  ASSERT_EQ(made.code, 0) << made.output;
  const std::size_t cells = mesh.of("rotor").size() + mesh.of("stator").size();
  EXPECT_GT(cells, 25000U);
  EXPECT_LT(cells, 35000U);
  for (const auto& element : mesh.elements) ASSERT_TRUE(element.type == 2 || element.type == 4);
}

// Every boundary face lies in exactly one named surface, and no cell is inverted.
TEST_F(PumpMesh, IsWatertight) { EXPECT_EQ(leaks(mesh), std::vector<std::string>{}); }

// Names and tags are those that cases rely on, unique over all dimensions.
TEST_F(PumpMesh, HasTheAgreedNames) {
  const std::map<std::string, std::pair<int, int>> expected = {
      {"rotor", {3, 1}},           {"stator", {3, 2}},        {"inlet", {2, 11}},           {"outlet", {2, 12}},
      {"impeller_walls", {2, 13}}, {"casing_walls", {2, 14}}, {"interface_rotor", {2, 15}}, {"interface_stator", {2, 16}}};
  EXPECT_EQ(mesh.group, expected);
}

// The rotor's volume is that of its cylinders less the vane, whose area follows from the length of the logarithmic spiral.
TEST_F(PumpMesh, RotorHoldsTheExactVolume) {
  const double r1 = 0.037, r2 = 0.1 - 0.004, sine = std::sin(std::atan(std::log(r2 / r1) / (300 * pi / 180)));
  const double vane = (r2 - r1) / sine * 0.0065 + pi / 2 * (0.0025 * 0.0025 + 0.004 * 0.004);
  const double exact = pi * 0.1045 * 0.1045 * 0.08 + pi * 0.05 * 0.05 * 0.006 - 0.08 * vane;
  EXPECT_NEAR(exact, 2.617628e-3, 2e-9);
  EXPECT_NEAR(made.number("rotor", 4) / exact, 1, 1e-6);
  EXPECT_NEAR(mesh.volume("rotor") / exact, 1, 2e-3);
}

// The stator's volume is that of an independent quadrature of spiral, outlet, transition and pipes.
TEST_F(PumpMesh, StatorHoldsTheExactVolume) {
  EXPECT_NEAR(made.number("stator", 4) / 1.0960971e-2, 1, 1e-6);
  EXPECT_NEAR(mesh.volume("stator") / 1.0960971e-2, 1, 1.5e-2);
}

// Both sides of the interface tile the same surface of revolution and share no node.
TEST_F(PumpMesh, InterfaceSidesAreEqualAndSeparate) {
  const double rotor = mesh.area("interface_rotor"), stator = mesh.area("interface_stator");
  EXPECT_NEAR(rotor / stator, 1, 5e-5);
  EXPECT_NEAR(rotor / 0.0603814, 1, 2e-3);
  for (const auto* side : {"interface_rotor", "interface_stator"})
    for (const int node : mesh.nodes_of(side)) {
      const Vec3 x = mesh.node.at(node);
      const double r = std::hypot(x.x, x.y);
      EXPECT_TRUE(std::abs(r - 0.1045) < 1e-9 || (std::abs(x.z - 0.086) < 1e-9 && r < 0.05 + 1e-9)) << x.x << " " << x.y << " " << x.z;
    }
  const auto in_rotor = mesh.nodes_of("rotor");
  for (const int node : mesh.nodes_of("stator")) ASSERT_FALSE(in_rotor.contains(node));
}

// The two sides are not meshed alike: a sliding interface must not be conformal by chance.
TEST_F(PumpMesh, InterfaceSidesDoNotMatch) {
  std::set<std::array<long, 3>> rotor;
  const auto place = [](const Vec3& x) { return std::array{std::lround(1e7 * x.x), std::lround(1e7 * x.y), std::lround(1e7 * x.z)}; };
  for (const int node : mesh.nodes_of("interface_rotor")) rotor.insert(place(mesh.node.at(node)));
  int common = 0;
  for (const int node : mesh.nodes_of("interface_stator")) common += rotor.contains(place(mesh.node.at(node)));
  EXPECT_LT(common, 5);
}

// Inlet and outlet lie where the dimensions put them: 3 diameters of inlet pipe, 8 of outlet pipe, the outlet along +y.
TEST_F(PumpMesh, OpeningsAreInPlace) {
  for (const int node : mesh.nodes_of("inlet")) EXPECT_NEAR(mesh.node.at(node).z, 0.386, 1e-9);
  for (const int node : mesh.nodes_of("outlet")) {
    const Vec3 x = mesh.node.at(node);
    EXPECT_NEAR(x.y, 0.85997, 1e-5);
    EXPECT_LT(std::hypot(x.x - 0.15301, x.z - 0.04), 0.04 + 1e-5);
  }
}

// The same parameters give the same file, to the byte.
TEST_F(PumpMesh, IsReproducible) {
  ASSERT_EQ(snag_mesh("pump --out again.msh").code, 0);
  EXPECT_TRUE(bytes(folder() / "again.msh") == bytes(folder() / "pump.msh"));
}
