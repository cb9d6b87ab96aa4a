#include "solver/boundaries/wall_pressure.hpp"

#include <algorithm>

#include "mesh/geometry.hpp"
#include "solver/fields/face.hpp"

namespace snag {

std::vector<WallCell> wall_cells(const Mesh& mesh, const BoundarySet& boundary) {
  std::vector<std::uint8_t> is_wall(static_cast<std::size_t>(mesh.n_faces));
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    std::fill_n(is_wall.begin() + mesh.patches[p].first, mesh.patches[p].count, static_cast<std::uint8_t>(boundary.is_wall(p)));
  std::vector<double> kind(static_cast<std::size_t>(mesh.n_all_cells()));
  for (int c = 0; c < mesh.n_cells; ++c) {
    std::optional<Vec3> first;
    for (const int f : row(mesh.cell_face_start, mesh.cell_face, c)) {
      if (is_wall[f] == 0) continue;
      const Vec3 normal = unit(mesh.face_vector[f]);
      const bool is_opposite = first && dot(*first, normal) < -0.5;
      kind[c] = std::max(kind[c], static_cast<double>(is_opposite ? WallCell::between_walls : WallCell::at_wall));
      if (!first) first = normal;
    }
  }
  mesh.halo.exchange(kind);
  std::vector<WallCell> all;
  for (const double k : kind) all.push_back(static_cast<WallCell>(static_cast<int>(k)));
  return all;
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

std::optional<Vec3> gradient_at_wall_function(const Mesh& mesh, std::span<const WallCell> wall_cell,
                                              std::span<const Vec3> pressure_gradient, std::span<const Vec3> held, int cell) {
  if (wall_cell[cell] == WallCell::between_walls) return {};
  Vec3 total, of_inner;
  double n = 0, n_inner = 0;
  for_each_neighbour(mesh, cell, [&](int other, double share) {
    if (wall_cell[other] == WallCell::between_walls) return;
    const Vec3 gradient = share * (pressure_gradient[other] - (held.empty() ? Vec3{} : held[other]));
    total += gradient, n += share;
    if (wall_cell[other] == WallCell::inner) of_inner += gradient, n_inner += share;
  });
  if (n_inner > 0) return of_inner / n_inner;
  if (n > 0) return total / n;
  return {};
}

}  // namespace snag
