// Along the quarter circle of the casing the columns are rays from its centre M, along the pipe they have one z. The ray at the angle p
// from the axis meets the hub's circle (centre H, radius R) at the distance s:  s = d . (H - M) + sqrt(R^2 - |H - M|^2 + (d . (H - M))^2).
#include "mesh/generate/axial_inlet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int fewest_rays = 4;

// Between the axis and a quarter circle of radius R about the radius a on the side of the axis: pi integral (a - sqrt(R^2 - x^2))^2 dx.
double about_quarter_circle(double a, double R) { return pi * (a * a * R - a * pi * R * R / 2 + 2 * R * R * R / 3); }

}  // namespace

std::vector<AxialInlet::Column> AxialInlet::columns(double size) const {
  const auto count = [size](double extent, int least) { return std::max(least, static_cast<int>(std::lround(extent / size))); };
  const auto hub_at = [&](double z) {
    const double x = z - hub_end();
    return x < 0 ? rod_radius() : hub_radius - std::sqrt(std::max(0.0, hub_fillet * hub_fillet - x * x));
  };
  const double dr = hub_radius - ring_radius, dz = hub_end() + casing_fillet;  // H - M
  std::vector<Column> columns;
  const int n_rays = count(pi / 2 * (casing_fillet + hub_fillet) / 2, fewest_rays);
  for (int k = 0; k < n_rays; ++k) {
    const double p = pi / 2 * k / n_rays, along = -std::sin(p) * dr + std::cos(p) * dz;
    double s = (span + casing_fillet) / std::cos(p);  // to the plane of the hub
    if (ring_radius - s * std::sin(p) < hub_radius) s = along + std::sqrt(hub_fillet * hub_fillet - dr * dr - dz * dz + along * along);
    columns.push_back({ring_radius - casing_fillet * std::sin(p), casing_fillet * (std::cos(p) - 1), ring_radius - s * std::sin(p),
                       s * std::cos(p) - casing_fillet});
  }
  const auto pipe = [&](double from, double to, bool closed) {
    const int n = count(from - to, 1);
    for (int k = 0; k < n + closed; ++k) {
      const double z = from + (to - from) * k / n;
      columns.push_back({pipe_radius(), z, hub_at(z), z});
    }
  };
  pipe(-casing_fillet, hub_end(), false);
  pipe(hub_end(), -length, true);
  return columns;
}

double AxialInlet::volume() const {
  const double pipe = pi * pipe_radius() * pipe_radius() * (length - casing_fillet),
               rod = pi * rod_radius() * rod_radius() * (length + hub_end());
  return pipe + about_quarter_circle(ring_radius, casing_fillet) + pi * ring_radius * ring_radius * span - rod -
         about_quarter_circle(hub_radius, hub_fillet);
}

void AxialInlet::add_to(SweptMesh& mesh, const std::string& volume, const std::vector<EdgeNodes>& circle, const std::vector<double>& levels,
                        double size) const {
  const auto lines = columns(size);
  const std::size_t n_levels = levels.size();
  std::map<Node, std::vector<Node>> made;  // by node of the circle: [column][level]
  for (const EdgeNodes& edge : circle)
    for (const Node start : edge) {
      auto& nodes = made[start];
      if (!nodes.empty()) continue;
      const Vec3 x = mesh.position_in_plane(start);
      const double c = x.x / std::hypot(x.x, x.y), s = x.y / std::hypot(x.x, x.y);
      for (std::size_t k = 0; k < n_levels; ++k) nodes.push_back(mesh.node(start, static_cast<int>(k)));
      for (std::size_t j = 1; j < lines.size(); ++j)
        for (const double z : levels) {
          const double t = z / span, r = (1 - t) * lines[j].casing_radius + t * lines[j].hub_radius;
          nodes.push_back(mesh.add_node({r * c, r * s, (1 - t) * lines[j].casing_z + t * lines[j].hub_z}));
        }
    }
  for (const auto& [first, second] : circle) {
    const auto &a = made[first], &b = made[second];
    for (std::size_t j = 0; j + 1 < lines.size(); ++j) {
      const auto quadrangle = [&](std::size_t k) {
        return FaceNodes{a[j * n_levels + k], b[j * n_levels + k], b[(j + 1) * n_levels + k], a[(j + 1) * n_levels + k]};
      };
      for (std::size_t k = 0; k + 1 < n_levels; ++k) {
        const auto low = quadrangle(k), high = quadrangle(k + 1);
        mesh.add_cell(volume, {low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]});
      }
      mesh.add_face("casing", quadrangle(0));
      mesh.add_face(lines[j].hub_z > hub_end() * (1 + 1e-9) && lines[j + 1].hub_z >= hub_end() ? "hub" : "rod", quadrangle(n_levels - 1));
    }
    const std::size_t last = (lines.size() - 1) * n_levels;
    for (std::size_t k = last; k + 1 < last + n_levels; ++k) mesh.add_face("inlet", {a[k], b[k], b[k + 1], a[k + 1]});
  }
}

}  // namespace snag::generate
