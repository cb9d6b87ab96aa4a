// ranks: 1 3
// long ranks: 2 5
#include "mesh/wall_surface.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "check.hpp"
#include "mesh/import/import.hpp"
#include "parallel/rows.hpp"
#include "sample.hpp"
#include "tests/structured_box.hpp"

namespace {

using namespace snag;

double area(const WallSurface& surface) {
  double total = 0;
  for (const auto& t : surface.triangles) total += 0.5 * norm(cross(t.node[1] - t.node[0], t.node[2] - t.node[0]));
  return total;
}

/// How many triangles hold each edge, by the shared nodes; the sense of an edge as its sign.
std::map<std::pair<int, int>, int> edges(const WallSurface& surface, int& balance) {
  std::map<std::pair<int, int>, int> count;
  balance = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t.node_index[i], b = t.node_index[(i + 1) % 3];
      ++count[{std::min(a, b), std::max(a, b)}];
      balance += a < b ? 1 : -1;
    }
  return count;
}

/// The eight corners of a unit cube as 12 triangles with outward normals.
std::vector<std::array<Vec3, 3>> cube() {
  std::vector<std::array<Vec3, 3>> triangles;
  const auto corner = [](int i) { return Vec3{1.0 * (i & 1), 1.0 * (i >> 1 & 1), 1.0 * (i >> 2 & 1)}; };
  for (const auto& q : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    triangles.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
    triangles.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
  }
  return triangles;
}

std::string binary_stl(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::string bytes(84, ' ');
  const auto n = static_cast<std::uint32_t>(triangles.size());
  std::memcpy(bytes.data() + 80, &n, 4);
  for (const auto& triangle : triangles) {
    std::array<float, 12> values{};
    for (std::size_t i = 0; i < 9; ++i) values[3 + i] = static_cast<float>(triangle[i / 3][static_cast<int>(i % 3)]);
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof values).append(2, '\0');
  }
  return bytes;
}

std::string ascii_stl(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::string text = "solid cube\n";
  for (const auto& triangle : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : triangle) text += "vertex " + std::to_string(x.x) + " " + std::to_string(x.y) + " " + std::to_string(x.z) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

void fill(const test::TemporaryFile& file, const std::string& content) {
  if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(file.path(), std::ios::binary) << content;
  MPI_Barrier(MPI_COMM_WORLD);
}

// The walls of a box are a closed surface of shared nodes, with normals out of the fluid, in the same order on every rank and any number of
// ranks.
TEST(WallSurface, OfABoxIsClosedAndTheSameOnEveryRank) {
  const std::vector<std::string> all{"x0", "x1", "y0", "y1", "z0", "z1"};
  const WallSurface surface = wall_surface(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {2, 3, 5}, {2, 3, 5}), all);
  const WallSurface alone = wall_surface(structured_box(MPI_COMM_SELF, {0, 0, 0}, {2, 3, 5}, {2, 3, 5}), all);
  EXPECT_EQ(surface.parts, all);
  EXPECT_EQ(surface.triangles.size(), 2U * 62U);
  EXPECT_NEAR(area(surface), 62, 1e-12);
  int balance = 0;
  const auto count = edges(surface, balance);
  EXPECT_EQ(balance, 0);
  EXPECT_EQ(count.size(), 3U * 62U);
  for (const auto& [edge, n] : count) EXPECT_EQ(n, 2);
  ASSERT_EQ(surface.triangles.size(), alone.triangles.size());
  for (std::size_t i = 0; i < alone.triangles.size(); ++i) {
    const WallTriangle &a = surface.triangles[i], &b = alone.triangles[i];
    EXPECT_EQ(a.node, b.node);
    EXPECT_EQ(a.node_index, b.node_index);
    EXPECT_EQ(a.part, b.part);
    const Vec3 centre = (a.node[0] + a.node[1] + a.node[2]) / 3;
    EXPECT_GT(dot(a.normal, centre - Vec3{1, 1.5, 2.5}), 0);
    EXPECT_NEAR(norm(a.normal), 1, 1e-15);
  }
}

// Triangles of several patches know their part; an unknown patch is an error.
TEST(WallSurface, KnowsItsParts) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const WallSurface surface = wall_surface(mesh, {"z1", "x0"});
  for (const auto& t : surface.triangles) EXPECT_EQ(t.normal, t.part == 0 ? (Vec3{0, 0, 1}) : (Vec3{-1, 0, 0}));
  EXPECT_THROW(wall_surface(mesh, {"lid"}), Error);
}

// Values of faces find their triangles: the diagonal of each square meets in the centre of the face that the triangle names.
TEST(WallSurface, TrianglesNameTheirFaces) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {2, 3, 5}, {2, 3, 5});
  std::vector<Vec3> mine;
  for (const char* name : {"y1", "x0", "z0"}) {
    const Patch& patch = mesh.patches[static_cast<std::size_t>(mesh.patch_index(name))];
    for (int f = patch.first; f < patch.end(); ++f) mine.push_back(mesh.face_centre[f]);
  }
  const std::vector<Vec3> centre = gathered(mesh.comm, mine);
  for (const WallTriangle& t : wall_surface(mesh, {"y1", "x0", "z0"}).triangles) {
    double nearest = 1;
    for (const int i : {0, 1, 2})
      nearest = std::min(nearest, norm(0.5 * (t.node[i] + t.node[(i + 1) % 3]) - centre[static_cast<std::size_t>(t.face)]));
    EXPECT_LT(nearest, 1e-12);
  }
}

// Binary and ASCII STL give the same closed surface; corners written apart are joined, and the unit is scaled.
TEST(WallSurface, ReadsStl) {
  const test::TemporaryFile file(".stl");
  for (const std::string& content : {binary_stl(cube()), ascii_stl(cube())}) {
    fill(file, content);
    const WallSurface surface = read_stl(file.path(), "casing", 1e-3);
    EXPECT_EQ(surface.parts, std::vector<std::string>{"casing"});
    ASSERT_EQ(surface.triangles.size(), 12U);
    EXPECT_NEAR(area(surface), 6e-6, 1e-18);
    int balance = 0;
    const auto count = edges(surface, balance);
    EXPECT_EQ(count.size(), 18U);
    EXPECT_EQ(balance, 0);
    for (const auto& t : surface.triangles) EXPECT_GT(dot(t.normal, t.node[0] + t.node[1] + t.node[2] - Vec3{1.5e-3, 1.5e-3, 1.5e-3}), 0);
  }
}

// Files that are missing, cut off or something else are input errors on every rank.
TEST(WallSurface, RefusesBrokenStl) {
  const test::TemporaryFile file(".stl");
  const std::string whole = binary_stl(cube()), text = ascii_stl(cube());
  for (const std::string& content : {std::string("nothing"), whole.substr(0, 500), text.substr(0, text.size() / 2), std::string()}) {
    fill(file, content);
    EXPECT_THROW(read_stl(file.path(), "casing"), Error);
  }
  EXPECT_THROW(read_stl("no/such/file.stl", "casing"), Error);
}

std::string refusal_of(const test::TemporaryFile& file, const std::string& content) {
  fill(file, content);
  try {
    read_stl(file.path(), "casing");
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code, ExitCode::io);
    return refused.what();
  }
  return "";
}

// A corner that is not a number is refused with its triangle, and so is a file none of whose triangles has an area: the walls would be
// absent from the run.
TEST(WallSurface, RefusesStlWithoutTriangles) {
  const test::TemporaryFile file(".stl");
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), -1e35}) {
    auto triangles = cube();
    triangles[6][1].y = value;
    EXPECT_NE(refusal_of(file, binary_stl(triangles)).find("triangle 7 has the corner"), std::string::npos) << value;
  }
  auto flat = cube();
  for (auto& triangle : flat) triangle[2] = triangle[1];
  for (const std::string& content : {binary_stl(flat), ascii_stl(flat)})
    EXPECT_NE(refusal_of(file, content).find("none of its 12 triangles has an area"), std::string::npos);
}

}  // namespace
