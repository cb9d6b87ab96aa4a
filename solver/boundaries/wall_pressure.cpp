#include "solver/boundaries/wall_pressure.hpp"

#include <algorithm>

#include "mesh/geometry.hpp"
#include "solver/fields/face.hpp"

namespace snag {

std::vector<char> cells_at_walls(const Mesh& mesh, const BoundarySet& boundary) {
  std::vector<double> at_wall(static_cast<std::size_t>(mesh.n_all_cells()));
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    for (int f = mesh.patches[p].first; boundary.is_wall(p) && f < mesh.patches[p].end(); ++f) at_wall[mesh.owner[f]] = 1;
  mesh.halo.exchange(at_wall);
  return {at_wall.begin(), at_wall.end()};
}

Vec3 acceleration_at_wall(const Vec3& velocity, const BoundaryValues& values, int b, bool slips) {
  if (!slips) return values.acceleration[b];
  const Vec3& v = values.velocity[b];
  if (norm_squared(v) == 0) return {};
  const double carried = std::clamp(dot(velocity, v) / norm_squared(v), 0.0, 1.0);
  return carried * carried * values.acceleration[b];
}

double share_along_wall(const Vec3& relative_velocity, const Vec3& normal, double more) {
  constexpr double full = 0.25, none = 0.5;  // sines of 15 and 30 degrees
  const double speed = norm(relative_velocity), towards = dot(relative_velocity, normal);
  if (towards * more >= 0) return 1;  // a rising pressure brakes water that runs against the wall
  return std::clamp((none - std::abs(towards) / speed) / (none - full), 0.0, 1.0);
}

std::optional<Vec3> gradient_at_wall_function(const Mesh& mesh, std::span<const char> at_wall, std::span<const Vec3> pressure_gradient,
                                              std::span<const Vec3> held, int cell) {
  Vec3 total;
  double n = 0;
  for_each_neighbour(mesh, cell, [&](int other, double share) {
    if (at_wall[other] != 0) return;
    total += share * (pressure_gradient[other] - (held.empty() ? Vec3{} : held[other])), n += share;
  });
  if (n == 0) return {};
  return total / n;
}

}  // namespace snag
