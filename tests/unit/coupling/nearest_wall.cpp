// The nearest wall of triangles: the same as by looking at every triangle, however the particles and the wall move, and that of the plane
// or box that the triangles make up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random_numbers.hpp"
#include "coupling/nearest_wall.hpp"
#include "dem/particles/tile_particles.hpp"
#include "tests/unit/dem/wall_pieces.hpp"

namespace snag {
namespace {

constexpr double pi = std::numbers::pi, radius = 2e-3;

double uniform(std::uint64_t seed) { return static_cast<double>(mixed(seed) >> 11) * 0x1p-53; }

/// Forty unbonded places for particles, of which NearestWall reads the positions.
struct Places {
  Places() {
    rag.radius = radius, rag.hydrodynamic_diameter = 2 * radius, rag.n_columns = 8, rag.n_rows = 5;
    tile.allocate(8, 5);
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) tile.exists[tile.index(i, j)] = 1;
    distance.resize(tile.exists.size());
    for (auto& component : normal) component.resize(tile.exists.size());
  }
  template <class Place>
  void put(const Place& place) {
    std::uint64_t n = 0;
    for_particles(tile, [&](int k, int, int) { tile.set_vector(Tile::x, k, place(n++)); });
  }
  void find(const NearestWall& walls, double time) {
    const Particles particles(rag, tile);
    walls.find(particles, time, distance.data(), {normal[0].data(), normal[1].data(), normal[2].data()});
  }
  Rag rag;
  Tile tile;
  std::vector<double> distance;
  std::array<std::vector<double>, 3> normal;
};

/// Requirement: in a pipe that turns and moves, particles that wander through it, sometimes far in one step, have the distance and normal
/// that the search through all triangles gives.
TEST(NearestWall, IsThatOfAllTriangles) {
  const WallSurface pipe = test::sheet(
      24, 10,
      [](double u, double v) {
        return Vec3{0.05 * std::cos(2 * pi * u), 0.05 * std::sin(2 * pi * u), 0.2 * v};
      },
      true);
  WallSet walls;
  const WallMotion motion{.axis = {0, 0, 1}, .origin = {0.01, 0, 0}, .speed = 30, .velocity = {0.1, 0.2, 0}};
  walls.add_surface("pipe", pipe, motion);
  const TriangleSurface all(walls.bodies()[0].triangles);
  Places places;
  const NearestWall nearest(walls, {places.rag});
  const double reach = 20 * radius;
  int found = 0, far = 0;
  for (int step = 0; step < 60; ++step) {
    const double time = 1e-3 * step;
    const WallPose pose = wall_pose(motion, time);
    places.put([&](std::uint64_t n) {
      const std::uint64_t jump = step / 20;  // wander for twenty steps, then be elsewhere
      const double r = 0.056 * std::sqrt(uniform(7 * n + 1000 * jump)), angle = 2 * pi * uniform(7 * n + 1 + 1000 * jump) + 0.02 * step;
      return pose.in_space({r * std::cos(angle), r * std::sin(angle), 0.2 * uniform(7 * n + 2 + 1000 * jump) + 1e-4 * step});
    });
    places.find(nearest, time);
    for_particles(places.tile, [&](int k, int, int) {
      const Vec3 x = pose.in_wall(places.tile.vector(Tile::x, k));
      TriangleDistance least;
      least.distance = reach;
      for (int t = 0; t < static_cast<int>(pipe.triangles.size()); ++t)
        if (const auto one = all.distance(t, x); std::abs(one.distance) < std::abs(least.distance)) least = one;
      if (least.distance == reach) {
        ++far;
        EXPECT_EQ(places.distance[k], 1e9);
        return;
      }
      ++found;
      EXPECT_EQ(places.distance[k], least.distance);
      const Vec3 n = pose.turned(least.direction);
      EXPECT_EQ((Vec3{places.normal[0][k], places.normal[1][k], places.normal[2][k]}), n);
    });
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(far, 50);
}

/// Requirement: a plane as triangles acts as the plane.
TEST(NearestWall, TrianglesOfAPlaneAreThePlane) {
  WallSet of_triangles, plane;
  of_triangles.add_surface("sheet", test::sheet(7, 9, [](double u, double v) { return Vec3{0.2 * v, 0.2 * u, 0}; }));
  const Vec3 into_fluid = -of_triangles.bodies()[0].triangles[0].normal;
  plane.add_plane("plane", {0, 0, 0}, into_fluid);
  Places a, b;
  const auto place = [&](std::uint64_t n) {
    return Vec3{0.05 + 0.1 * uniform(3 * n), 0.05 + 0.1 * uniform(3 * n + 1), into_fluid.z * 9 * radius * (uniform(3 * n + 2) + 0.01)};
  };
  a.put(place), b.put(place);
  a.find(NearestWall(of_triangles, {a.rag}), 0), b.find(NearestWall(plane, {b.rag}), 0);
  for_particles(a.tile, [&](int k, int, int) {
    EXPECT_NEAR(a.distance[k], b.distance[k], 1e-15);
    EXPECT_NEAR(a.normal[2][k], into_fluid.z, 1e-15);
  });
}

}  // namespace
}  // namespace snag
