#include "dem/poses/pipe_wall.hpp"

#include <algorithm>
#include <cmath>

#include "dem/particles/tile_particles.hpp"

namespace snag {

PipeContact pipe_contact(const PipeShape& shape, const Vec3& centre, double radius) {
  const double depth = dot(centre, shape.axis);  // below the mouth
  const Vec3 across = centre - depth * shape.axis;
  const double secant = std::sqrt(1 + shape.hopper_slope * shape.hopper_slope);
  const double room = shape.radius - radius * secant - std::min(0.0, depth) * shape.hopper_slope;
  if (room > 0 && norm_squared(across) < room * room) return {};  // most particles
  const double rho = norm(across);
  const Vec3 outward = rho > 0 ? across / rho : Vec3{};
  if (shape.hopper_slope <= 0) return {rho + radius - shape.radius, -outward, shape.closing_speed};

  // In the plane of the particle and the axis, from the mouth's edge: (outwards, upwards).
  struct Place {
    double out, up;
  };
  const Place at{rho - shape.radius, -depth}, side{shape.hopper_slope / secant, 1 / secant};
  const double up_side = std::max(0.0, at.out * side.out + at.up * side.up), down_pipe = std::max(0.0, -at.up);
  const Place from_side{at.out - up_side * side.out, at.up - up_side * side.up}, from_pipe{at.out, at.up + down_pipe};
  const double to_side = std::hypot(from_side.out, from_side.up), to_pipe = std::hypot(from_pipe.out, from_pipe.up);
  const Place from = to_side < to_pipe ? from_side : from_pipe;
  const double distance = std::min(to_side, to_pipe);
  const bool behind = at.out * side.up > std::max(0.0, at.up) * side.out;
  if (distance <= 0) return {radius, -outward, 0};
  const Vec3 away = (from.out / distance) * outward - (from.up / distance) * shape.axis;
  return behind ? PipeContact{radius + distance, -away, 0} : PipeContact{radius - distance, away, 0};
}

PipeContact end_contact(const PipeShape& shape, const Vec3& centre, double radius) {
  const double along = dot(centre, shape.axis);
  return {std::abs(along) + radius - shape.half_length, along > 0 ? -shape.axis : shape.axis, shape.end_speed};
}

void PipeWall::add(std::size_t index, Tile& tile, double step) {
  if (index == 0) shape_.radius -= step * shape_.closing_speed, shape_.half_length -= step * shape_.end_speed;
  for_particles(tile, [&](int k, int, int) {
    const Vec3 x = tile.vector(Tile::x, k), v = tile.vector(Tile::vx, k);
    Vec3 force = (-law_.rate * rag_.mass) * v;
    for (const auto contact : {pipe_contact, end_contact}) {
      const PipeContact c = contact(shape_, x, rag_.radius);
      if (!(c.overlap > 0)) continue;
      max_overlap_ = std::max(max_overlap_, c.overlap);
      force += std::max(0.0, law_.stiffness * c.overlap - law_.damping * (dot(v, c.normal) - c.wall_speed)) * c.normal;
    }
    tile.set_vector(Tile::fx, k, tile.vector(Tile::fx, k) + force);
    tile.set_vector(Tile::tx, k, tile.vector(Tile::tx, k) - (law_.rate * rag_.inertia) * tile.vector(Tile::wx, k));
  });
}

}  // namespace snag
