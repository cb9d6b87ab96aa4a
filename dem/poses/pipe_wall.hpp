#pragma once
// The wall that crumples a sheet: a smooth pipe about an axis through the origin, without friction, that closes in, or that stands still
// below a hopper. It pushes a particle of radius r whose centre is nearer than r with
//
//   F = max(0, k d - c u) n      d: overlap, n: unit normal into the space, u: velocity of the particle along n less that of the wall
//
// and everything is slowed by the air: F = -rate m v, T = -rate i w.
//
// The wall is a spring in every direction from its nearest point, so the edge between hopper and pipe is round to a particle; a particle
// whose centre got behind it is pushed back.
#include "base/vec3.hpp"
#include "dem/rag_system.hpp"

namespace snag {

struct PipeShape {
  Vec3 axis;                 // unit vector; out of the hopper into the pipe
  double radius = 0;         // m
  double half_length = 0;    // of a pipe between two plane ends; infinity: none, m
  double hopper_slope = 0;   // of the hopper's side, tangent of its angle to the axis; 0: the pipe goes on for ever
  double closing_speed = 0;  // -d radius/dt, m/s
  double end_speed = 0;      // -d half_length/dt, m/s
};

/// What the wall does to a particle, its velocity left out.
struct PipeContact {
  double overlap = 0;     // m; not positive: none
  Vec3 normal;            // into the space
  double wall_speed = 0;  // of the wall along the normal, m/s
};

/// Contact of a sphere with the pipe or the hopper, whichever is nearer; the hopper's mouth is at the origin, the pipe on the side to which
/// the axis points.
PipeContact pipe_contact(const PipeShape& shape, const Vec3& centre, double radius);
/// The same with the nearer of the two ends.
PipeContact end_contact(const PipeShape& shape, const Vec3& centre, double radius);

class PipeWall : public TileForce {
 public:
  struct Law {
    double stiffness = 0;  // k, N/m
    double damping = 0;    // c, N s/m
    double rate = 0;       // 1/s
  };
  PipeWall(const PipeShape& shape, const Rag& rag, const Law& law) : shape_(shape), rag_(rag), law_(law) {}

  void add(std::size_t index, Tile& tile, double step) override;
  const PipeShape& shape() const { return shape_; }
  /// Where it stands and how it closes from now on.
  void set_shape(const PipeShape& shape) { shape_ = shape; }
  void set_rate(double rate) { law_.rate = rate; }
  double max_overlap() const { return max_overlap_; }  // since the last reset, m
  void reset_overlap() { max_overlap_ = 0; }

 private:
  PipeShape shape_;
  Rag rag_;
  Law law_;
  double max_overlap_ = 0;
};

}  // namespace snag
