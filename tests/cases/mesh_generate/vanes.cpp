// timeout: 600
// Pumps of one and seven vanes on coarse meshes, against figures that follow from the plan view alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double R = 0.1045, r_eye = 0.05, eye_length = 0.006, b = 0.02;  // m: sliding radius, eye, width

// Large cells and short pipes: seconds a mesh.
const std::string coarse =
    "'impeller_width=20 mm' 'side_gap=5 mm' 'design_flow=8 L/s' 'inlet_length=60 mm' 'outlet_length=80 mm' 'wall_size=16 mm' 'core_size=23 "
    "mm' "
    "'interface_size=13 mm' "
    "'pipe_size=40 mm' ";

// Vanes by the rules of the help: a logarithmic spiral of 300 deg / n^0.6, 5 mm / n^(1/3) thick at its leading edge, 8 mm / n^(1/3) at the
// other; all in metres.
struct Vane {
  explicit Vane(int n) : t1(0.005 / std::cbrt(n)), t2(0.008 / std::cbrt(n)), r2(0.1 - t2 / 2), wrap(300 * pi / 180 / std::pow(n, 0.6)) {}
  double t1, t2, r1 = 0.037, r2, wrap;

  double length(double from, double to) const { return (to - from) / std::sin(std::atan(std::log(r2 / r1) / wrap)); }
  double thickness(double r) const { return t1 + (t2 - t1) * (r - r1) / (r2 - r1); }
  double area() const { return length(r1, r2) * (t1 + t2) / 2 + pi / 8 * (t1 * t1 + t2 * t2); }
  double area_in_eye() const { return length(r1, r_eye) * (t1 + thickness(r_eye)) / 2 + pi / 8 * t1 * t1; }
  double perimeter() const { return 2 * length(r1, r2) + pi / 2 * (t1 + t2); }
  /// Distance of a point from the surface of the vane whose leading edge stands at the angle `start`: discs along the centre line.
  double distance(const Vec3& x, double start) const {
    double least = 1;
    for (int k = 0; k <= 2000; ++k) {
      const double s = wrap * k / 2000, r = r1 * std::exp(std::log(r2 / r1) * s / wrap);
      least = std::min(least, std::hypot(x.x - r * std::cos(start - s), x.y - r * std::sin(start - s)) - thickness(r) / 2);
    }
    return least;
  }
};

struct MadePump {
  Outcome outcome;
  MeshFile mesh;
};

// Made once for all tests.
const MadePump& pump_of(int vanes) {
  static std::map<int, MadePump> made;
  if (!made.contains(vanes)) {
    const std::string number = std::to_string(vanes), file = "vanes_" + number + ".msh";
    const auto outcome = snag_mesh("pump --out " + file + " --set vanes=" + number + " " + coarse);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    made[vanes] = {outcome, outcome.code == 0 ? read_mesh(folder() / file) : MeshFile{}};
  }
  return made.at(vanes);
}

struct VanedPump : testing::TestWithParam<int> {
  const Outcome& outcome() const { return pump_of(vanes()).outcome; }
  const MeshFile& mesh() const { return pump_of(vanes()).mesh; }
  int vanes() const { return GetParam(); }
  void SetUp() override { ASSERT_EQ(outcome().code, 0); }
};

std::string message(const std::string& settings, int code) {
  const auto outcome = snag_mesh("pump --out refused.msh --set " + settings);
  EXPECT_EQ(outcome.code, code) << outcome.output;
  return outcome.output;
}

}  // namespace

// Every boundary face lies in exactly one named surface, no cell is inverted, and the mesh is a small one.
TEST_P(VanedPump, IsWatertight) {
  EXPECT_EQ(leaks(mesh()), std::vector<std::string>{});
  EXPECT_LT(mesh().elements.size(), 60000U);
}

// The rotor's volume is that of its cylinders less the vanes.
TEST_P(VanedPump, RotorHoldsTheExactVolume) {
  const double exact = pi * R * R * b + pi * r_eye * r_eye * eye_length - vanes() * b * Vane(vanes()).area();
  EXPECT_NEAR(outcome().number("rotor", 4) / exact, 1, 1e-6);
  EXPECT_NEAR(mesh().volume("rotor") / exact, 1, 5e-3);
}

// The impeller's walls are hub, shroud, the eye's rim, the sides of the vanes and their tops inside the eye.
TEST_P(VanedPump, ImpellerWallsHaveTheirArea) {
  const Vane vane(vanes());
  const double hub = pi * R * R - vanes() * vane.area();
  const double top = pi * (R * R - r_eye * r_eye) - vanes() * (vane.area() - 2 * vane.area_in_eye());
  const double walls = hub + top + 2 * pi * r_eye * eye_length + vanes() * b * vane.perimeter();
  EXPECT_NEAR(mesh().area("impeller_walls") / walls, 1, 0.01);
}

// Both sides of the interface tile the same surface of revolution.
TEST_P(VanedPump, InterfaceSidesAreEqual) {
  const double rotor = mesh().area("interface_rotor"), exact = 2 * pi * R * b + pi * r_eye * r_eye;
  EXPECT_NEAR(rotor / mesh().area("interface_stator"), 1, 1e-4);
  EXPECT_NEAR(rotor / exact, 1, 6e-3);
}

// The surface of the vanes has n-fold symmetry: each node between hub and shroud lies on the first vane turned by a multiple of 360/n
// degrees, and each vane carries the same area.
TEST_P(VanedPump, VanesAreEqualAndEvenlySpaced) {
  const Vane vane(vanes());
  const double rotor_angle = 7 * pi / 180;
  std::map<int, int> owner;  // node of a vane's side -> its vane
  for (const int node : mesh().nodes_of("impeller_walls")) {
    const Vec3 x = mesh().node.at(node);
    if (x.z < 1e-6 || x.z > b - 1e-6) continue;
    double least = 1;
    for (int k = 0; k < vanes(); ++k)
      if (const double d = std::abs(vane.distance(x, rotor_angle + 2 * pi * k / vanes())); d < least) least = d, owner[node] = k;
    ASSERT_LT(least, 5e-5) << x.x << " " << x.y << " " << x.z;
  }
  std::map<int, double> area;
  for (const auto* face : mesh().of("impeller_walls")) {
    const auto inner = std::ranges::find_if(face->nodes, [&](int node) { return owner.contains(node); });
    if (inner == face->nodes.end()) continue;
    const auto x = [&](std::size_t k) { return mesh().node.at(face->nodes[k]); };
    area[owner.at(*inner)] += norm(cross(x(1) - x(0), x(2) - x(0))) / 2;
  }
  ASSERT_EQ(area.size(), static_cast<std::size_t>(vanes()));
  // Triangles with no node between hub and shroud are missing.
  for (const auto& [k, sides] : area) EXPECT_NEAR(sides / (b * vane.perimeter()), 1, 0.15) << "vane " << k;
}

INSTANTIATE_TEST_SUITE_P(Pump, VanedPump, testing::Values(1, 7));

// Numbers of vanes outside of 1 to 7, and vanes that overlap or nearly close their passages, are refused with value, rule and remedy.
TEST(Vanes, AreRefusedWhereTheyDoNotFit) {
  EXPECT_NE(message("vanes=0", 2).find("vanes"), std::string::npos);
  EXPECT_NE(message("vanes=8", 2).find("vanes"), std::string::npos);
  const auto overlap = message("vanes=7 'wrap_angle=300 deg' 'leading_edge_thickness=9 mm' 'trailing_edge_thickness=12 mm'", 2);
  EXPECT_NE(overlap.find("they overlap"), std::string::npos) << overlap;
  const auto narrow = message("vanes=5 'wrap_angle=300 deg'", 2);
  EXPECT_NE(narrow.find("narrowest passage between the vanes (0.00"), std::string::npos) << narrow;
  EXPECT_NE(narrow.find("must hold 3 cells of edge_size"), std::string::npos) << narrow;
  EXPECT_NE(narrow.find("take fewer vanes, a smaller wrap_angle"), std::string::npos) << narrow;
}

// Another seed makes another mesh of the same pump and sizes, and no cell of it is worse than the quality asked for.
TEST(Vanes, MeshFollowsSeedAndQuality) {
  const auto made = snag_mesh("pump --out seed_2.msh --set vanes=3 mesh_seed=2 minimum_quality=0.2 " + coarse);
  ASSERT_EQ(made.code, 0) << made.output;
  EXPECT_GE(std::stod(made.output.substr(made.output.find("least ") + 6)), 0.2) << made.output;
  EXPECT_NE(made.output.find("below 0.2: 0"), std::string::npos) << made.output;
  const MeshFile &one = pump_of(3).mesh, two = read_mesh(folder() / "seed_2.msh");
  EXPECT_FALSE(bytes(folder() / "vanes_3.msh") == bytes(folder() / "seed_2.msh"));
  EXPECT_NEAR(one.volume("rotor") / two.volume("rotor"), 1, 1e-3);
  EXPECT_NEAR(static_cast<double>(one.elements.size()) / static_cast<double>(two.elements.size()), 1, 0.05);
}
