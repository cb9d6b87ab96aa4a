// Wall that slides along itself or turns about an axis of its own:   u = s(t) (U + omega a x (x - x_0))
#include "base/error.hpp"
#include "solver/boundaries/time_course.hpp"
#include "solver/boundaries/turning_wall.hpp"

namespace snag {
namespace {

struct MovingWall final : Boundary {
  static constexpr const char* name = "moving_wall";
  Vec3 velocity, origin, axis{0, 0, 1};
  double rotation_speed = 0, roughness_height = 0;  // rad/s, m
  TimeCourse course;

  Section section() override {
    Section section{
        .name = name,
        .meaning = "No slip on a wall that moves along itself: a velocity, a rotation, or both.",
        .parameters = {{"velocity", &velocity, "m/s", -infinity, infinity, Basis::assumed, "Velocity of the wall."},
                       renamed({"rotation_speed", &rotation_speed, "rad/s", -infinity, infinity, Basis::assumed,
                                "Speed of rotation; \"1200 rpm\" is understood."},
                               {.key = "speed", .unit = "1/s"}),
                       {"axis", &axis, "1", -infinity, infinity, Basis::assumed, "Direction of the axis of rotation; any length."},
                       {"origin", &origin, "m", -infinity, infinity, Basis::assumed, "A point on the axis of rotation."},
                       roughness_parameter(&roughness_height)}};
    course.add_keys(section, "motion");
    return section;
  }
  std::vector<double> knots() const override { return course.knots(); }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  bool is_wall() const override { return true; }
  double roughness() const override { return roughness_height; }
  void prepare(const Mesh&, const Patch& patch, const std::vector<PatchBoundary>&) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
    if (norm(axis) == 0)
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": axis (0, 0, 0) has no direction; give a vector along it");
  }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    const double factor = course.at(time);
    const Vec3 omega = rotation_speed * unit(axis);
    const auto turning = Turning::over_step(flow, time, origin, factor * omega, course.at(flow.time) * omega);
    for (int f = patch.first; f < patch.end(); ++f) set_turning_wall(turning, factor * velocity, flow, f, values);
  }
};
const bool registered = boundaries().add<MovingWall>();

}  // namespace
}  // namespace snag
