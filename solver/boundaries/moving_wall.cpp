// Wall that slides along itself or turns:   u = U + omega a x (x - x_0)
// Nothing passes through it: the flux is the volume that the mesh face sweeps, whatever the rounding of the wall into flat faces.
#include "base/error.hpp"
#include "solver/boundary.hpp"

namespace snag {
namespace {

struct MovingWall final : Boundary {
  static constexpr const char* name = "moving_wall";
  Vec3 velocity, origin, axis{0, 0, 1};
  double speed = 0;

  Section section() override {
    return {.name = name,
            .meaning = "No slip on a wall that moves along itself: a velocity, a rotation, or both.",
            .parameters = {
                {"velocity", &velocity, "m/s", -infinity, infinity, Basis::assumed, "Velocity of the wall."},
                {"speed", &speed, "1/s", -infinity, infinity, Basis::assumed, "Speed of rotation (rad/s; \"1200 rpm\" is understood)."},
                {"axis", &axis, "1", -infinity, infinity, Basis::assumed, "Direction of the axis of rotation; any length."},
                {"origin", &origin, "m", -infinity, infinity, Basis::assumed, "A point on the axis of rotation."}}};
  }
  Fixes fixes() const override { return Fixes::velocity; }
  bool is_wall() const override { return true; }
  void prepare(const Mesh&, const Patch& patch) override {
    if (norm(axis) == 0)
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": axis (0, 0, 0) has no direction; give a vector along it");
  }
  void update(const Flow& flow, const Patch& patch, double, BoundaryValues& values) const override {
    const Vec3 omega = speed * unit(axis);
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - flow.mesh.n_interior;
      values.velocity[b] = velocity + cross(omega, flow.mesh.face_centre[f] - origin);
      values.flux[b] = flow.mesh_flux[f];
      values.acceleration[b] = cross(omega, cross(omega, flow.mesh.face_centre[f] - origin));
    }
  }
};
const bool registered = boundaries().add<MovingWall>();

}  // namespace
}  // namespace snag
