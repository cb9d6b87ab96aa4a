// Wall that slides along itself or turns about an axis of its own:   u = s(t) (U + omega a x (x - x_0))
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/words.hpp"
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
  void prepare(const Mesh& mesh, const Patch& patch, const std::vector<PatchBoundary>&) override {
    course.check("[[boundary]] \"" + patch.name + "\"");
    if (norm(axis) == 0)
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": axis (0, 0, 0) has no direction; give a vector along it");
    check_along_itself(mesh, patch);
  }
  /// A wall that moves across itself would push water away: a piston, which no mesh here can follow.
  void check_along_itself(const Mesh& mesh, const Patch& patch) const {
    constexpr double of_flat_faces = 0.2;  // on a curved wall
    std::array<double, 2> sums{};
    for (int f = patch.first; f < patch.end(); ++f) {
      const Vec3 &S = mesh.face_vector[f], u = velocity + cross(rotation_speed * unit(axis), mesh.face_centre[f] - origin);
      sums[0] += std::abs(dot(u, S)), sums[1] += norm(u) * norm(S);
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
    if (sums[0] > of_flat_faces * sums[1])
      throw Error(ExitCode::usage, "[[boundary]] \"" + patch.name + "\": moving_wall moves along itself, but " +
                                       number_text(std::round(100 * sums[0] / sums[1])) +
                                       " % of the given speed is across the wall; correct velocity, rotation_speed, axis or origin, or let "
                                       "water in with velocity_inlet");
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
