// ranks: 1
// The difference in time of a velocity in a zone that slides.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "mesh/import/import.hpp"
#include "solver/fields/rotating_zone.hpp"
#include "tests/unit/mesh/sliding_shells.hpp"

using namespace snag;

namespace {

struct Steps {
  double begun, dt, dt_old;  // s
};

/// du/dt at the end of a step.
Vec3 difference(const RotatingZone& zone, const Steps& steps, const std::function<Vec3(double)>& u) {
  const TimeScheme time = bdf(steps.dt, steps.dt_old);
  const Vec3 now = u(steps.begun + steps.dt), old = u(steps.begun), older = u(steps.begun - steps.dt_old);
  const Vec3 second = second_difference(time, now, old, older);
  return (time.now * now + time.old * old + time.older * older + zone.turning_difference(steps.begun, time) * second) / steps.dt;
}

/// A zone about an oblique axis, 20 rad/s, and its mesh.
struct Turning {
  test::Shells shape{.origin = {0.3, -0.2, 0.1}, .axis = {1, -2, 0.5}};
  test::TemporaryFile file{test::sample_of(shape), test::Format::ascii22};
  Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD, {});
  RotatingZone zone;
  explicit Turning(double ramp, const std::string& motion = "sliding") : zone(mesh, settings(ramp, motion)) {}
  RotatingZoneSettings settings(double ramp, const std::string& motion) const {
    RotatingZoneSettings chosen;
    chosen.zone = "rotor", chosen.motion.choose(motion), chosen.origin = shape.origin, chosen.axis = shape.axis;
    chosen.speed = 20, chosen.ramp = ramp;
    return chosen;
  }
};

// 0.1 rad a step, longer and shorter than the step before; while the zone speeds up, and from its first step on.
const std::vector<Steps> some_steps{{1, 0.005, 0.005}, {1, 0.005, 0.002}, {1, 0.002, 0.005}, {0.1, 0.005, 0.005}, {0.005, 0.005, 0.005}};

}  // namespace

TEST(TurningDifference, is_exact_for_what_stands_grows_or_turns_with_the_zone) {
  const Turning turning(0.4);
  const RotatingZone& zone = turning.zone;
  const Vec3 v{3, 1, -2}, w{-1, 4, 2};
  for (const Steps& steps : some_steps) {
    const double now = steps.begun + steps.dt;
    EXPECT_LT(norm(difference(zone, steps, [&](double t) { return v + t * w; }) - w), 1e-9) << now;
    const auto turned_with = [&](double t) { return turned(v, zone.axis(), zone.angle(t)); };
    const Vec3 exact = cross(zone.rotation_speed(now), turned_with(now));
    EXPECT_LT(norm(difference(zone, steps, turned_with) - exact), 1e-9 * std::max(1.0, norm(exact))) << now;
  }
}

// What turns at another rate has the error of BDF2 or less, of second order.
TEST(TurningDifference, is_of_second_order) {
  const Turning turning(0);
  const Vec3 v{3, 1, -2};
  const auto u = [&](double t) { return turned(v, turning.zone.axis(), 7 * t); };
  const auto error = [&](double dt) { return norm(difference(turning.zone, {1, dt, dt}, u) - 7 * cross(turning.zone.axis(), u(1 + dt))); };
  EXPECT_NEAR(error(2e-3) / error(1e-3), 4, 0.1);
}

TEST(TurningDifference, is_nothing_in_a_frame_without_history_and_in_steps_beyond_a_radian) {
  EXPECT_EQ(Turning(0, "frame").zone.turning_difference(1, bdf(0.005, 0.005)), Mat3{});
  const Turning turning(0);
  EXPECT_EQ(turning.zone.turning_difference(1, {.dt = 0.005}), Mat3{});
  EXPECT_EQ(turning.zone.turning_difference(1, bdf(0.06, 0.06)), Mat3{});
  EXPECT_NE(turning.zone.turning_difference(1, bdf(0.04, 0.04)), Mat3{});
}

// A run that continues another has a past before its time 0: at full speed without a ramp, at rest with one.
TEST(TurningDifference, the_zone_has_a_past) {
  EXPECT_NEAR(Turning(0).zone.angle(-0.01), -0.2, 1e-15);
  EXPECT_EQ(Turning(0).zone.speed(-0.01), 20);
  EXPECT_EQ(Turning(0.4).zone.angle(-0.01), 0);
  EXPECT_EQ(Turning(0.4).zone.speed(-0.01), 0);
}
