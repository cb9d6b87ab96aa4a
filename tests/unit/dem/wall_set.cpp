// Walls: motion, nearest points, search grid, what a particle does to them and case files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "base/error.hpp"
#include "dem/walls/wall_triangles.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/session.hpp"
#include "tests/structured_box.hpp"
#include "tests/unit/dem/contact_pieces.hpp"
#include "tests/unit/dem/wall_pieces.hpp"

namespace snag {
namespace {

using test::Pieces;

std::mt19937 generator(11);
Vec3 random_vector(double scale) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return scale * Vec3{uniform(generator), uniform(generator), uniform(generator)};
}

// The frame of a wall comes from the time alone: orthonormal after a day of turning, back where it was after whole turns, and its velocity
// is its derivative.
TEST(WallMotion, IsExact) {
  const WallMotion motion{.axis = {1, -2, 0.5}, .origin = {0.1, 0.2, 0.3}, .speed = 2 * std::numbers::pi, .velocity = {0.5, 0, -0.25}};
  const WallPose late = wall_pose(motion, 86400.25);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(dot(late.rotation[i], late.rotation[j]), i == j, 4e-16 * 4);
  const Vec3 X{0.7, -0.1, 0.2};
  EXPECT_NEAR(norm(wall_pose(motion, 1000).in_space(X) - (X + 1000 * motion.velocity)), 0, 1e-11);
  EXPECT_NEAR(norm(late.in_wall(late.in_space(X)) - X), 0, 1e-11);
  const double h = 1e-5, t = 0.37;
  const Vec3 difference = (wall_pose(motion, t + h).in_space(X) - wall_pose(motion, t - h).in_space(X)) / (2 * h);
  EXPECT_NEAR(norm(difference - wall_pose(motion, t).velocity_at(wall_pose(motion, t).in_space(X))), 0, 1e-8);
  // A quarter turn about z takes x to y.
  const WallPose quarter = wall_pose({.axis = {0, 0, 1}, .origin = {}, .speed = std::numbers::pi / 2, .velocity = {}}, 1);
  EXPECT_NEAR(norm(quarter.in_space({1, 0, 0}) - Vec3{0, 1, 0}), 0, 1e-15);
}

// The nearest point of a triangle is nearer than any other of its points, and lies on the feature it names.
TEST(WallTriangles, NearestPointIsNearest) {
  int seen[3] = {0, 0, 0};
  for (int k = 0; k < 500; ++k) {
    const std::array<Vec3, 3> node{random_vector(1), random_vector(1), random_vector(1)};
    const Vec3 c = random_vector(1.5);
    const NearestPoint nearest = nearest_point(node, c);
    ++seen[static_cast<int>(nearest.feature)];
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20 - i; ++j)
        ASSERT_LE(norm(nearest.point - c),
                  norm(node[0] + i / 20.0 * (node[1] - node[0]) + j / 20.0 * (node[2] - node[0]) - c) * (1 + 1e-12));
    const Vec3 a = node[nearest.place], b = node[(nearest.place + 1) % 3];
    if (nearest.feature == TriangleFeature::corner) {
      EXPECT_EQ(norm(nearest.point - a), 0);
    }
    if (nearest.feature == TriangleFeature::edge) {
      EXPECT_LE(norm(cross(nearest.point - a, unit(b - a))), 1e-12);
    }
  }
  for (int n : seen) EXPECT_GT(n, 30);
}

// The search grid lists every triangle within reach, for small triangles, large ones, and points outside of its box.
TEST(WallTriangles, GridMissesNothing) {
  WallSurface surface = test::sheet(17, 9, [](double u, double v) {
    return Vec3{std::sin(3 * u), std::cos(2 * u) * v, 0.3 * v * v + (u > 0.7 ? 0.5 * u : 0.0)};
  });
  const double reach = 0.07;
  const VoxelGrid grid(surface.triangles, reach, 0.1, 1e5), wide(surface.triangles, reach, 0.01, 200);
  int hits = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 x = random_vector(1.4);
    for (const VoxelGrid* g : {&grid, &wide}) {
      const auto listed = g->at(x);
      EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end()));
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        if (norm(nearest_point(surface.triangles[t].node, x).point - x) < reach) {
          ++hits;
          ASSERT_TRUE(std::binary_search(listed.begin(), listed.end(), static_cast<int>(t)));
        }
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_TRUE(grid.at({std::nan(""), 0, 0}).empty());
}

// The sign of the distance to a closed solid tells inside from outside everywhere near it, also off edges and corners.
TEST(WallTriangles, SidesOfASolid) {
  const WallSurface solid = test::solid_box({0, 0, 0}, {1, 2, 3});
  const TriangleSurface surface(solid.triangles, 0.5, 0.6);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 x = Vec3{0.5, 1, 1.5} + Vec3{random_vector(0.95).x, random_vector(1.45).y, random_vector(1.95).z};
    TriangleDistance nearest{infinity, {}, TriangleFeature::face, {}};
    for (int t : surface.near(x)) {
      const TriangleDistance seen = surface.distance(t, x);
      if (std::abs(seen.distance) < std::abs(nearest.distance)) nearest = seen;
    }
    if (nearest.distance == infinity) continue;
    const bool inside = x.x > 0 && x.x < 1 && x.y > 0 && x.y < 2 && x.z > 0 && x.z < 3;
    EXPECT_EQ(nearest.distance < 0, inside) << x.x << " " << x.y << " " << x.z;
  }
}

// A particle driven through a wall is counted while it is beyond, also where it is too deep for the wall to reach it, and no longer once it
// is back.
TEST(WallContacts, ParticlesBeyondAreCounted) {
  const double r = 1e-3;
  WallSet walls;
  walls.add_surface("block", test::solid_box({0, 0, 0}, {0.02, 0.02, 0.02}));
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(r, 540), {0.0101, 0.0099, 0.02 + 0.9 * r}), pieces.add_sphere(Pieces::sphere(r, 540), {0.05, 0, 0});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  const auto tiles = pieces.owned();
  for (int i = 0; i < 178; ++i) {
    const double depth = -0.9 + 0.05 * i;
    pieces.set(0, Tile::x, {0.0101, 0.0099, 0.02 - depth * r});
    pieces.clear_forces();
    contacts.add_forces(tiles, {}, 1e-6);
    EXPECT_EQ(contacts.measures().beyond_walls[0], depth > 1e-9) << depth;
    if (depth < 0.95) {
      EXPECT_GT(pieces.get(0, Tile::fx).z, 0);
    }
  }
  // The flag moves with the tile to another rank.
  ContactSolver other(ContactSettings{}, pieces.rags, &walls);
  other.unpack(*tiles[0], contacts.pack(*tiles[0]));
  other.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(other.measures().beyond_walls, (std::vector<std::int64_t>{1, 0}));
  pieces.set(0, Tile::x, {0.0101, 0.0099, 0.02 + 0.5 * r});
  contacts.add_forces(tiles, {}, 1e-6);
  EXPECT_EQ(contacts.measures().beyond_walls[0], 0);
}

// A plane counts what is beyond it at any depth and pushes it back, with the force of the overlap 2 r at most.
TEST(WallContacts, PlanePushesBackFromAnyDepth) {
  const double r = 1e-3;
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 5});
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(r, 540), {0, 0, -r}), pieces.add_sphere(Pieces::sphere(r, 540), {0.1, 0, -50 * r});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  contacts.add_forces(pieces.owned(), {}, 1e-6);
  EXPECT_EQ(contacts.measures().beyond_walls, (std::vector<std::int64_t>{1, 1}));
  EXPECT_GT(pieces.get(0, Tile::fx).z, 0);
  EXPECT_EQ(pieces.get(0, Tile::fx).z, pieces.get(1, Tile::fx).z);
  EXPECT_NEAR(contacts.measures().max_wall_overlap_over_radius[0], 2, 1e-12);
  EXPECT_NEAR(contacts.measures().max_wall_overlap_over_radius[1], 51, 1e-9);
}

// What the solver tells of the walls' forces on each particle is what its tile got, and two particles on two walls make three contacts.
TEST(WallContacts, ForcesOfWalls) {
  const double r = 1e-3;
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1}), walls.add_plane("side", {}, {1, 0, 0});
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(r, 540), {0.8 * r, 0, 0.9 * r}, {0.1, 0.2, -0.1}),
      pieces.add_sphere(Pieces::sphere(r, 540), {0.5, 0, 0.9 * r});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  for (int k = 0; k < 3; ++k) {
    pieces.clear_forces();
    contacts.add_forces(pieces.owned(), {}, 1e-6);
    for (std::size_t p = 0; p < 2; ++p)
      EXPECT_EQ(contacts.forces(std::span<const Tile>(pieces.owned()[p], 1)).at(0), pieces.get(static_cast<int>(p), Tile::fx));
  }
  EXPECT_GT(pieces.get(0, Tile::fx).z, 0);
  EXPECT_GT(pieces.get(0, Tile::fx).x, 0);
  EXPECT_EQ(pieces.get(1, Tile::fx).x, 0);
  EXPECT_EQ(contacts.measures().n_wall_contacts, 3);
  contacts.reset_measures();
  EXPECT_EQ(contacts.measures().max_wall_overlap_over_radius[0], 0);
}

// A particle counts once in each region where it touches: a wall that moves, one at rest near the tongue, any other at rest. Forces of
// all contacts are told particle by particle.
TEST(WallContacts, PlacesOfTouchAndForces) {
  const double r = 1e-3;
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1}), walls.add_plane("side", {}, {1, 0, 0});
  walls.add_plane("belt", {0, 1, 0}, {0, -1, 0}, WallMotion{.axis = {0, 1, 0}, .origin = {}, .speed = 3, .velocity = {}});
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(r, 540), {0.9 * r, 0.5, 0.9 * r});        // in the corner, twice near the line
  pieces.add_sphere(Pieces::sphere(r, 540), {0.5, 0.5, 0.9 * r});            // on the floor, far from the line
  pieces.add_sphere(Pieces::sphere(r, 540), {4 * r, 1 - 0.9 * r, 0.9 * r});  // on belt and floor, near the line
  pieces.add_sphere(Pieces::sphere(r, 540), {0.5, 0.5, 0.5});                // nowhere
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  contacts.set_tongue({.point = {0, 0.3, 0}, .direction = {0, 1, 0}, .reach = 5 * r});
  for (int k = 0; k < 2; ++k) {
    pieces.clear_forces();
    contacts.add_forces(pieces.owned(), {}, 1e-6);
  }
  const std::vector<std::vector<int>> expected{{0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 0, 0}};  // moving, tongue, other
  ASSERT_EQ(contacts.wall_touches().size(), expected.size() * n_contact_regions);
  for (std::size_t rag = 0; rag < expected.size(); ++rag) {
    for (std::size_t region = 0; region < n_contact_regions; ++region) {
      const WallTouch& touch = contacts.wall_touches()[rag * n_contact_regions + region];
      EXPECT_EQ(touch.now, expected[rag][region]) << rag << " " << region;
      EXPECT_EQ(touch.since_reset, 2 * expected[rag][region]) << rag << " " << region;
    }
    const std::vector<Vec3> force = contacts.forces({pieces.tiles[rag].get(), 1});
    ASSERT_EQ(force.size(), 1U);
    EXPECT_EQ(force[0], pieces.get(static_cast<int>(rag), Tile::fx)) << "nothing but contacts acts here";
    EXPECT_EQ(norm(force[0]) > 0, rag < 3);
  }
  contacts.reset_measures();
  EXPECT_EQ(contacts.wall_touches()[0].since_reset, 0);
}

// A fast wall that comes upon resting particles is noticed in time: the list is made anew before it can have arrived.
TEST(WallContacts, FastWallArrives) {
  const double r = 1e-3, speed = 300;
  WallSet walls;
  walls.add_surface("blade", test::solid_box({0, 0, 0}, {0.1, 0.002, 0.02}),
                    WallMotion{.axis = {0, 0, 1}, .origin = {}, .speed = speed, .velocity = {}});
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(r, 540), {0, 0.08, 0.01});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  const auto tiles = pieces.owned();
  double first = 0;
  for (int k = 0; k < 2000 && first == 0; ++k) {
    pieces.clear_forces();
    contacts.add_forces(tiles, {}, 5e-6);
    if (contacts.measures().n_wall_contacts > 0) first = k * 5e-6;
  }
  // The face y = 0.002 of the blade reaches the sphere's side when its centre is r in front of it: 0.08 cos(angle) = 0.002 + r.
  const double angle = std::acos(0.003 / 0.08);
  EXPECT_NEAR(first, angle / speed, 6e-6);
  EXPECT_LT(pieces.get(0, Tile::fx).x, 0);
}

// [[wall]] reads planes and boxes with the units in the keys, turning walls in rpm; mistakes are refused with the key's name.
TEST(WallSettings, CaseFile) {
  const CaseFile file = CaseFile::parse(R"(
[[wall]]
kind = "plane"
point_m = [0, 0, 1]
normal = [2, 0, 0]
[[wall]]
kind = "box"
name = "tank"
lower_m = [0, 0, 0]
upper_m = ["10 mm", "20 mm", "30 mm"]
rotation_speed = "600 rpm"
axis = [0, 1, 0]
)");
  const WallSet walls = read_walls(file, nullptr);
  file.reject_unread();
  ASSERT_EQ(walls.bodies().size(), 2U);
  EXPECT_EQ(walls.parts(), (std::vector<std::string>{"plane_0", "tank"}));
  EXPECT_EQ(walls.bodies()[0].planes[0].normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(walls.bodies()[1].planes.size(), 6U);
  EXPECT_NEAR(walls.bodies()[1].planes[5].point.z, 0.03, 1e-15);
  EXPECT_NEAR(walls.bodies()[1].motion.speed, 20 * std::numbers::pi, 1e-12);

  const auto message = [](const std::string& text) -> std::string {
    try {
      read_walls(CaseFile::parse(text), nullptr);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("[[wall]]\nkind = \"plane\"\npoint_m = [0,0,0]\n").find("normal"), std::string::npos);
  EXPECT_NE(message("[[wall]]\nkind = \"plane\"\npoint_m = [0,0,0]\nnormal = [0,0,0]\n").find("normal"), std::string::npos);
  EXPECT_NE(message("[[wall]]\nkind = \"box\"\nlower_m = [0,0,0]\nupper_m = [1,-1,1]\n").find("lower"), std::string::npos);
  EXPECT_NE(message("[[wall]]\nkind = \"patches\"\npatches = [\"casing\"]\n").find("mesh"), std::string::npos);
  EXPECT_NE(message("[[wall]]\nkind = \"cone\"\n").find("plane"), std::string::npos);
  EXPECT_NE(message("[[wall]]\npoint_m = [0,0,0]\n").find("kind"), std::string::npos);
}

/// ASCII STL of a surface given with normals out of the fluid, written with the opposite turn: that of a solid body.
std::filesystem::path write_solid_stl(const WallSurface& surface) {
  auto path = std::filesystem::temp_directory_path() / ("snag_wall_set_" + std::to_string(rank_of(MPI_COMM_WORLD)) + ".stl");
  std::ofstream file(path);
  file.precision(17);
  file << "solid block\n";
  for (const WallTriangle& t : surface.triangles) {
    file << "facet normal " << -t.normal.x << " " << -t.normal.y << " " << -t.normal.z << "\nouter loop\n";
    for (int i : {0, 2, 1}) file << "vertex " << 1000 * t.node[i].x << " " << 1000 * t.node[i].y << " " << 1000 * t.node[i].z << "\n";
    file << "endloop\nendfacet\n";
  }
  file << "endsolid block\n";
  return path;
}

// An STL in millimetres of a solid body pushes a particle away from the body when its normals are said to point into the fluid; its part
// has the wall's name.
TEST(WallSettings, Stl) {
  const auto path = write_solid_stl(test::solid_box({0, 0, 0}, {0.01, 0.02, 0.03}));
  const std::string table = "[[wall]]\nkind = \"stl\"\nname = \"block\"\nscale = 1e-3\nfile = \"" + path.string() + "\"\n";
  for (const bool into_fluid : {true, false}) {
    const WallSet walls = read_walls(CaseFile::parse(table + (into_fluid ? "normals_into_fluid = true\n" : "")), nullptr);
    EXPECT_EQ(walls.parts(), std::vector<std::string>{"block"});
    Pieces pieces;
    pieces.add_sphere(Pieces::sphere(1e-3, 540), {0.0107, 0.012, 0.011});
    ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
    contacts.add_forces(pieces.owned(), {}, 1e-6);
    EXPECT_EQ(pieces.get(0, Tile::fx).x > 0, into_fluid);
    EXPECT_EQ(contacts.measures().beyond_walls[0], into_fluid ? 0 : 1);
  }
  std::filesystem::remove(path);
}

// Patches of a mesh keep their names as parts and push particles into the mesh.
TEST(WallSettings, Patches) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.04, 0.03, 0.02}, {4, 3, 2});
  std::string names;
  for (const Patch& patch : mesh.patches) names += (names.empty() ? "\"" : ", \"") + patch.name + "\"";
  const WallSet walls = read_walls(CaseFile::parse("[[wall]]\nkind = \"patches\"\npatches = [" + names + "]\n"), &mesh);
  EXPECT_EQ(walls.parts().size(), mesh.patches.size());
  Pieces pieces;
  const Vec3 centre{0.02, 0.015, 0.01};
  for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    const double half = std::abs(dot(e, centre));
    pieces.add_sphere(Pieces::sphere(1e-3, 540), centre + (half - 0.8e-3) * e);
    ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
    const int last = static_cast<int>(pieces.tiles.size()) - 1;
    pieces.clear_forces();
    contacts.add_forces(pieces.owned(), {}, 1e-6);
    EXPECT_LT(dot(pieces.get(last, Tile::fx), e), 0);
    EXPECT_NEAR(norm(cross(pieces.get(last, Tile::fx), e)), 0, 1e-12);
  }
}

// [contact] reads through its records, defaults within their ranges.
TEST(ContactSettings, CaseFile) {
  ContactSettings settings;
  for (const Parameter& p : settings.section().parameters)
    if (const auto* number = std::get_if<double*>(&p.target)) {
      EXPECT_TRUE(**number >= p.minimum && **number <= p.maximum) << p.key;
    }
  settings.read(CaseFile::parse("[contact]\nrestitution = 0.2\nimpact_speed = \"2 m/s\"\nwall_stiffness_factor = 10\nself_contact = "
                                "false\nmutual_contact = false\n")
                    .root()
                    .table("contact"));
  EXPECT_EQ(settings.restitution, 0.2);
  EXPECT_EQ(settings.impact_speed, 2);
  EXPECT_EQ(settings.wall_stiffness_factor, 10);
  EXPECT_FALSE(settings.self_contact);
  EXPECT_FALSE(settings.mutual_contact);
  EXPECT_THROW(CaseFile::parse("[contact]\nrestitution = 1.2\n").root().table("contact").read(settings.section().parameters), Error);
}

}  // namespace
}  // namespace snag
