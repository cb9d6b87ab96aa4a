#include "solver/boundaries/inlet_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "mesh/geometry.hpp"
#include "parallel/rows.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

using Ends = std::array<std::int64_t, 2>;  // node ids, rising

struct Edge {
  Ends ends;
  Vec3 x, y;  // of the ends, m
};

std::vector<Edge> edges_of(const Mesh& mesh, const Patch& patch) {
  std::vector<Edge> edges;
  for (int f = patch.first; f < patch.end(); ++f) {
    const int begin = mesh.face_node_start[f], end = mesh.face_node_start[f + 1];
    for (int i = begin; i < end; ++i) {
      int n = mesh.face_node[i], m = mesh.face_node[i + 1 < end ? i + 1 : begin];
      if (mesh.node_id[n] > mesh.node_id[m]) std::swap(n, m);
      edges.push_back({{mesh.node_id[n], mesh.node_id[m]}, mesh.node[n], mesh.node[m]});
    }
  }
  return edges;
}

/// Edges of all ranks that belong to one face of the patch only, in the order of their ends.
std::vector<Edge> rim_of(const Mesh& mesh, const Patch& patch) {
  std::map<Ends, std::pair<Edge, int>> found;
  for (const Edge& edge : gathered(mesh.comm, edges_of(mesh, patch))) ++found.try_emplace(edge.ends, edge, 0).first->second.second;
  std::vector<Edge> rim;
  for (const auto& [ends, entry] : found) {
    if (entry.second == 1) rim.push_back(entry.first);
  }
  return rim;
}

/// The edges of a rim that some patch of walls has, too.
std::vector<Edge> edges_at_walls(const Mesh& mesh, const std::vector<Edge>& rim, const std::vector<Patch>& walls) {
  std::vector<int> at_wall(rim.size(), 0);
  for (const Patch& wall : walls)
    for (const Edge& edge : edges_of(mesh, wall)) {
      const auto found = std::ranges::lower_bound(rim, edge.ends, {}, &Edge::ends);
      if (found != rim.end() && found->ends == edge.ends) at_wall[found - rim.begin()] = 1;
    }
  MPI_Allreduce(MPI_IN_PLACE, at_wall.data(), static_cast<int>(at_wall.size()), MPI_INT, MPI_MAX, mesh.comm);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < rim.size(); ++i)
    if (at_wall[i]) edges.push_back(rim[i]);
  return edges;
}

double distance(const Vec3& point, const Edge& edge) {
  const Vec3 along = edge.y - edge.x;
  const double t = std::clamp(dot(point - edge.x, along) / norm_squared(along), 0.0, 1.0);
  return norm(point - edge.x - t * along);
}

double distance(const Vec3& point, const std::vector<Edge>& edges) {
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges) least = std::min(least, distance(point, edge));
  return least;
}

using Triangle = std::array<Vec3, 3>;

std::vector<Triangle> triangles_of(const Mesh& mesh, int f) {
  std::array<Vec3, 8> points;
  std::vector<Triangle> triangles;
  for_each_triangle(positions(mesh.node, row(mesh.face_node_start, mesh.face_node, f), points),
                    [&](const Vec3& a, const Vec3& b, const Vec3& m) {
                      triangles.push_back({a, b, m});
                    });
  return triangles;
}

/// The largest distance in the triangles from the edges, or `known` if that is larger, within 0.1 %. The distance changes by less than the
/// way: a triangle whose middle is nearer than `known` by more than the way to its corners has nothing to give, others are divided in four.
double largest_distance(std::vector<Triangle> triangles, const std::vector<Edge>& edges, double known) {
  constexpr double tolerance = 1e-3;
  while (!triangles.empty()) {
    const auto [a, b, c] = triangles.back();
    triangles.pop_back();
    const Vec3 middle = (a + b + c) / 3;
    const double here = distance(middle, edges), reach = std::max({norm(a - middle), norm(b - middle), norm(c - middle)});
    known = std::max(known, here);
    if (here + reach <= (1 + tolerance) * known) continue;
    const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
      triangles.push_back(part);
  }
  return known;
}

/// Of a developed flow at a point, over its largest: s = d/D.
double speed_at(double s, Profile profile) { return profile == Profile::laminar ? s * (2 - s) : std::pow(s, 1.0 / 7); }

}  // namespace

std::vector<double> inlet_profile(const Mesh& mesh, const Patch& patch, const std::vector<Patch>& walls, Profile profile) {
  std::vector<double> speed(patch.count, 1.0);
  if (profile == Profile::uniform) return speed;
  const std::vector<Edge> edges = edges_at_walls(mesh, rim_of(mesh, patch), walls);
  if (edges.empty())
    throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name +
                                     "\": no edge of the patch lies at a wall, so that the profile of a developed flow is not known; write "
                                     "profile = \"uniform\"");
  double largest = 0;
  for (int f = patch.first; f < patch.end(); ++f) largest = std::max(largest, distance(mesh.face_centre[f], edges));
  largest = maximum(mesh.comm, largest);
  for (int f = patch.first; f < patch.end(); ++f) largest = largest_distance(triangles_of(mesh, f), edges, largest);
  largest = maximum(mesh.comm, largest);
  std::vector<double> flow(patch.count), area(patch.count);
  for (int i = 0; i < patch.count; ++i) {
    for (const auto& [a, b, c] : triangles_of(mesh, patch.first + i)) {
      const double part = norm(cross(b - a, c - a)) / 2;
      area[i] += part;
      for (const Vec3& corner : {a, b, c})  // exact for a velocity that is quadratic in the triangle
        flow[i] += part / 3 * speed_at(distance((a + b + c + 3 * corner) / 6, edges) / largest, profile);
    }
    speed[i] = flow[i] / area[i];
  }
  const double mean = sum(mesh.comm, flow) / sum(mesh.comm, area);
  for (double& value : speed) value /= mean;
  return speed;
}

}  // namespace snag
