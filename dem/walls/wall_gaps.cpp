#include "dem/walls/wall_gaps.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "dem/walls/wall_triangles.hpp"

namespace snag {

namespace {

constexpr double facing_cosine = -0.70710678118654752;  // of 135 degrees

struct Sample {
  Vec3 place, normal;  // fixed frame, m; into the fluid
  int body, triangle, part;
};

std::array<Vec3, 4> samples_of(const WallTriangle& t) {
  const Vec3 middle = (t.node[0] + t.node[1] + t.node[2]) / 3;
  return {middle, 0.5 * (middle + t.node[0]), 0.5 * (middle + t.node[1]), 0.5 * (middle + t.node[2])};
}

class Gaps {
 public:
  void see(int a, int b, double width, const Vec3& place) {
    WallGap& gap = narrowest_.try_emplace(std::minmax(a, b), WallGap{std::min(a, b), std::max(a, b), infinity, {}}).first->second;
    if (width < gap.width) gap.width = width, gap.place = place;
  }
  std::vector<WallGap> sorted() const {
    std::vector<WallGap> all;
    for (const auto& [parts, gap] : narrowest_) all.push_back(gap);
    std::stable_sort(all.begin(), all.end(), [](const WallGap& a, const WallGap& b) { return a.width < b.width; });
    return all;
  }

 private:
  std::map<std::pair<int, int>, WallGap> narrowest_;
};

void see_planes(const Sample& sample, const WallBody& body, const WallPose& pose, double widest, Gaps& gaps) {
  for (const WallPlane& plane : body.planes) {
    const Vec3 normal = pose.turned(plane.normal);
    const double distance = dot(sample.place - pose.in_space(plane.point), normal);
    if (distance > 0 && distance < widest && dot(normal, sample.normal) < facing_cosine)
      gaps.see(sample.part, plane.part, distance, sample.place);
  }
}

void see_triangles(const Sample& sample, int b, const TriangleSurface& surface, const WallPose& pose, double widest, Gaps& gaps) {
  const Vec3 X = pose.in_wall(sample.place);
  for (const int t : surface.near(X)) {
    if ((b == sample.body && t == sample.triangle) || !surface.within(t, X, widest)) continue;
    const TriangleDistance seen = surface.distance(t, X);
    if (seen.distance > 0 && seen.distance < widest && dot(pose.turned(seen.direction), sample.normal) < facing_cosine)
      gaps.see(sample.part, surface.part(t), seen.distance, sample.place);
  }
}

}  // namespace

std::vector<WallGap> narrow_gaps(const WallSet& walls, double time, double widest) {
  std::vector<WallPose> poses;
  std::vector<TriangleSurface> surfaces;
  for (const WallBody& body : walls.bodies()) {
    poses.push_back(wall_pose(body.motion, time));
    surfaces.push_back(body.triangles.empty() ? TriangleSurface() : TriangleSurface(body.triangles, widest, widest));
  }
  const int n = static_cast<int>(poses.size());
  Gaps gaps;
  for (int a = 0; a < n; ++a) {
    const WallBody& body = walls.bodies()[static_cast<std::size_t>(a)];
    const WallPose& pose = poses[static_cast<std::size_t>(a)];
    for (std::size_t t = 0; t < body.triangles.size(); ++t)
      for (const Vec3& point : samples_of(body.triangles[t])) {
        const Sample sample{pose.in_space(point), -pose.turned(body.triangles[t].normal), a, static_cast<int>(t), body.triangles[t].part};
        for (int b = 0; b < n; ++b) {
          see_planes(sample, walls.bodies()[static_cast<std::size_t>(b)], poses[static_cast<std::size_t>(b)], widest, gaps);
          see_triangles(sample, b, surfaces[static_cast<std::size_t>(b)], poses[static_cast<std::size_t>(b)], widest, gaps);
        }
      }
    for (const WallPlane& plane : body.planes)
      for (int b = a; b < n; ++b)
        for (const WallPlane& other : walls.bodies()[static_cast<std::size_t>(b)].planes) {
          const Vec3 normal = pose.turned(plane.normal), place = pose.in_space(plane.point);
          const double distance = dot(poses[static_cast<std::size_t>(b)].in_space(other.point) - place, normal);
          const bool parallel = dot(normal, poses[static_cast<std::size_t>(b)].turned(other.normal)) < -1 + 1e-12;
          if (parallel && distance > 0 && distance < widest) gaps.see(plane.part, other.part, distance, place);
        }
  }
  return gaps.sorted();
}

}  // namespace snag
