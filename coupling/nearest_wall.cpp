#include "coupling/nearest_wall.hpp"

#include <algorithm>
#include <cmath>

#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {
constexpr double far_away = 1e9;            // m
constexpr double reach_over_diameter = 10;  // drag along a wall is then 3 % above that of free fluid
constexpr double skin_over_reach = 0.025;   // a quarter of a diameter
}  // namespace

NearestWall::NearestWall(const WallSet& walls, const std::vector<Rag>& rags) : walls_(walls) {
  for (const Rag& rag : rags) reach_ = std::max(reach_, reach_over_diameter * rag.hydrodynamic_diameter);
  for (std::size_t b = 0; b < walls.bodies().size(); ++b)
    if (const auto& triangles = walls.bodies()[b].triangles; !triangles.empty())
      surfaces_.emplace(b, Surface{NearTriangles(triangles, reach_, skin_over_reach * reach_), {}});
}

void NearestWall::find(const Particles& particles, double time, double* distance, const VectorSum& normal) const {
  for (int p = particles.begin; p < particles.end; ++p) distance[p] = far_away, normal.x[p] = 0, normal.y[p] = 0, normal.z[p] = 1;
  for (std::size_t b = 0; b < walls_.bodies().size(); ++b) {
    const WallBody& body = walls_.bodies()[b];
    const WallPose pose = wall_pose(body.motion, time);
    for (const WallPlane& plane : body.planes) find_plane(particles, plane, pose, distance, normal);
    if (!body.triangles.empty()) find_triangle(particles, b, pose, distance, normal);
  }
}

void NearestWall::find_plane(const Particles& particles, const WallPlane& plane, const WallPose& pose, double* distance,
                             const VectorSum& normal) const {
  const Vec3 point = pose.in_space(plane.point), n = pose.turned(plane.normal);
  const VectorArray x = particles.position;
#pragma omp simd
  for (int p = particles.begin; p < particles.end; ++p) {
    const double h = (x.x[p] - point.x) * n.x + (x.y[p] - point.y) * n.y + (x.z[p] - point.z) * n.z;
    const bool nearer = h < distance[p];
    distance[p] = nearer ? h : distance[p];
    normal.x[p] = nearer ? n.x : normal.x[p], normal.y[p] = nearer ? n.y : normal.y[p], normal.z[p] = nearer ? n.z : normal.z[p];
  }
}

void NearestWall::find_triangle(const Particles& particles, std::size_t body, const WallPose& pose, double* distance,
                                const VectorSum& normal) const {
  auto& [triangles, all_known] = surfaces_.at(body);
  const TriangleSurface& surface = triangles.surface();
  std::vector<Known>& known = all_known[&particles.tile];
  if (known.size() < particles.tile.exists.size()) known.resize(particles.tile.exists.size());
  for_particles(particles.tile, [&](int p, int, int) {
    const Vec3 x = pose.in_wall(particles.position[p]);
    if (!(norm(x - known[p].place) < triangles.skin())) known[p].place = x, triangles.around(x, known[p].triangles);
    double nearest = std::min(std::abs(distance[p]), reach_);
    for (const int t : known[p].triangles) {
      if (!surface.within(t, x, nearest)) continue;
      const TriangleDistance found = surface.distance(t, x);
      if (std::abs(found.distance) >= nearest) continue;
      nearest = std::abs(found.distance), distance[p] = found.distance;
      const Vec3 n = pose.turned(found.direction);
      normal.x[p] = n.x, normal.y[p] = n.y, normal.z[p] = n.z;
    }
  });
}

}  // namespace snag
