#include "simulation/setup/speed_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"
#include "mesh/bounding_box.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

/// Fastest point of a wall, m/s; of a plane, which has no end, the point that the case gives.
double wall_speed(const WallBody& body) {
  double reach = 0;
  for (const WallTriangle& triangle : body.triangles)
    for (const Vec3& corner : triangle.node) reach = std::max(reach, norm(corner - body.motion.origin));
  for (const WallPlane& plane : body.planes) reach = std::max(reach, norm(plane.point - body.motion.origin));
  return norm(body.motion.velocity) + std::abs(body.motion.speed) * reach;
}

/// Fastest water at the particles of a prescribed flow, m/s.
double prescribed_speed(const PrescribedFlow& flow, const RagSystem& rags) {
  double reach = 0, gradient = 0;
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int, int) { reach = std::max(reach, norm(tile.vector(Tile::x, k))); });
  for (const Vec3& row : flow.gradient) gradient += norm_squared(row);
  return (1 + flow.pipe.largest_share()) * norm(flow.velocity) + norm(flow.amplitude) + std::sqrt(gradient) * maximum(rags.comm(), reach);
}

}  // namespace

SpeedBounds::SpeedBounds(double gravity, const Mesh* mesh, const WallSet& walls, const std::vector<RagPiece>& pieces, double impact_speed)
    : gravity_(gravity), impact_speed_(impact_speed), falls_freely_(!mesh) {
  for (const WallBody& body : walls.bodies()) widen(wall_speed(body), "wall " + body.name);
  for (const RagPiece& piece : pieces) {
    const double size = piece.rag.radius * 2 * std::hypot(piece.rag.n_columns, piece.rag.n_rows);
    widen(norm(piece.velocity) + norm(piece.spin) * size, "start of " + piece.rag.name);
  }
  if (mesh) widen(std::sqrt(2 * gravity_ * bounding_box(*mesh).diagonal()), "fall through the mesh");
}

void SpeedBounds::widen(double speed, const std::string& source) {
  if (speed > speed_) speed_ = speed, source_ = source;
}

SpeedBound SpeedBounds::at(double time, const FlowSolver* water, const PrescribedFlow* prescribed, const RagSystem& rags) const {
  SpeedBounds now = *this;
  if (falls_freely_) now.widen(speed_ + gravity_ * time, "fall since the start");
  if (water) now.widen(water->watch().speed(), water->watch().source());
  if (prescribed) now.widen(prescribed_speed(*prescribed, rags), "prescribed flow");
  const double speed = DivergenceBounds::speed * now.speed_;
  if (speed < impact_speed_) return {.speed = impact_speed_, .reason = "[contact] impact_speed, that of the fastest contact"};
  return {
      .speed = speed,
      .reason = number_text(DivergenceBounds::speed) + " times the speed of the case, " + number_text(now.speed_) + " m/s: " + now.source_};
}

namespace {

/// Of equal speeds that of the lowest id.
struct Fastest {
  double speed = -1;  // m/s
  std::int64_t id = -1;
  Vec3 place{};  // m
  int rag = 0;

  void see(const Fastest& other) {
    if (other.speed > speed || (other.speed == speed && other.id < id)) *this = other;
  }
};

}  // namespace

void check_speeds(const RagSystem& rags, const SpeedBound& bound) {
  Fastest found;
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int i, int j) {
      const double speed = norm(tile.vector(Tile::vx, k));
      if (speed > found.speed) found = {speed, particle_id(rags.rags()[tile.rag], tile, i, j), tile.vector(Tile::x, k), tile.rag};
    });
  std::vector<Fastest> all(static_cast<std::size_t>(size_of(rags.comm())));
  MPI_Allgather(&found, sizeof(Fastest), MPI_BYTE, all.data(), sizeof(Fastest), MPI_BYTE, rags.comm());
  for (const Fastest& other : all) found.see(other);
  if (found.speed <= bound.speed) return;
  throw Error(ExitCode::diverged, rags.rags()[static_cast<std::size_t>(found.rag)].name + " diverged: particle " +
                                      std::to_string(found.id) + " moves with " + number_text(found.speed) + " m/s at " +
                                      point_text(found.place) + ", t = " + number_text(rags.time()) + " s, must not exceed " +
                                      number_text(bound.speed) + " m/s (" + bound.reason +
                                      "); use a shorter [time] step, or [dem] step or safety where contacts throw it");
}

}  // namespace snag
