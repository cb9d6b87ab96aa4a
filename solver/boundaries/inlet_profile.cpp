#include "solver/boundaries/inlet_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "parallel/rows.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

struct Edge {
  std::int64_t a, b;  // node ids, a < b
  Vec3 x, y;          // ends, m
};

std::vector<Edge> edges_of_all_ranks(const Mesh& mesh, const Patch& patch) {
  std::vector<Edge> mine;
  for (int f = patch.first; f < patch.end(); ++f) {
    const int begin = mesh.face_node_start[f], end = mesh.face_node_start[f + 1];
    for (int i = begin; i < end; ++i) {
      int n = mesh.face_node[i], m = mesh.face_node[i + 1 < end ? i + 1 : begin];
      if (mesh.node_id[n] > mesh.node_id[m]) std::swap(n, m);
      mine.push_back({mesh.node_id[n], mesh.node_id[m], mesh.node[n], mesh.node[m]});
    }
  }
  return gathered(mesh.comm, mine);
}

/// Edges that belong to one face of the patch only.
std::vector<Edge> rim_of(const Mesh& mesh, const Patch& patch) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<Edge, int>> found;
  for (const Edge& edge : edges_of_all_ranks(mesh, patch)) ++found.try_emplace({edge.a, edge.b}, edge, 0).first->second.second;
  std::vector<Edge> rim;
  for (const auto& [ends, entry] : found) {
    if (entry.second == 1) rim.push_back(entry.first);
  }
  return rim;
}

double distance(const Vec3& point, const Edge& edge) {
  const Vec3 along = edge.y - edge.x;
  const double t = std::clamp(dot(point - edge.x, along) / norm_squared(along), 0.0, 1.0);
  return norm(point - edge.x - t * along);
}

}  // namespace

std::vector<double> inlet_profile(const Mesh& mesh, const Patch& patch, Profile profile) {
  std::vector<double> speed(patch.count, 1.0);
  if (profile == Profile::uniform) return speed;
  const std::vector<Edge> rim = rim_of(mesh, patch);
  double largest = 0;
  for (int i = 0; i < patch.count; ++i) {
    speed[i] = std::numeric_limits<double>::infinity();
    for (const Edge& edge : rim) speed[i] = std::min(speed[i], distance(mesh.face_centre[patch.first + i], edge));
    largest = std::max(largest, speed[i]);
  }
  largest = maximum(mesh.comm, largest);
  std::vector<double> flow(patch.count), area(patch.count);
  for (int i = 0; i < patch.count; ++i) {
    const double s = speed[i] / largest;
    speed[i] = profile == Profile::laminar ? s * (2 - s) : std::pow(s, 1.0 / 7);
    area[i] = norm(mesh.face_vector[patch.first + i]);
    flow[i] = speed[i] * area[i];
  }
  const double mean = sum(mesh.comm, flow) / sum(mesh.comm, area);
  for (double& value : speed) value /= mean;
  return speed;
}

}  // namespace snag
