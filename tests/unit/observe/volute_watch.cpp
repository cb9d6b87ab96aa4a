// A rag's way through the volute, read off pictures.
#include "observe/passage/volute_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "base/error.hpp"

using namespace snag;

namespace {

/// The shaft in the middle of 400 x 400 pixels of 1 mm, the tongue 100 mm to the right of it, the outlet upwards.
Camera camera(const std::string& seen_from, const std::string& impeller_turns) {
  Camera c;
  c.pixels = {400, 400}, c.pixel = 1e-3;
  c.volute = VoluteView{.axis = {200, 200},
                        .tongue = {300, 200},
                        .outlet = {340, 40},
                        .outlet_direction = {0, 1},
                        .outlet_radius = 0.06,
                        .tongue_reach = 0.012,
                        .impeller_radius = 0.06,
                        .seen_from = seen_from,
                        .impeller_turns = impeller_turns};
  return c;
}

/// A square of 20 pixels about a point, m from the middle to the right and up.
std::vector<Blob> square(double x, double y) {
  Blob blob;
  blob.coverage = Coverage(x - 0.01, y - 0.01, x + 0.0095, y + 0.0095, 1e-3);
  std::fill(blob.coverage.covered.begin(), blob.coverage.covered.end(), 1);
  blob.seen = moments(blob.coverage);
  return {blob};
}

/// Round the shaft at 80 mm from one angle in the picture (deg, counter-clockwise from the tongue) to another, 10 degrees a picture of 20
/// ms.
VoluteHistogram arc(const Camera& c, double from, double to) {
  VoluteWatch watch(c);
  const int n = static_cast<int>(std::lround(std::abs(to - from) / 10));
  for (int k = 0; k <= n; ++k) {
    const double angle = (from + (to - from) * k / n) * std::numbers::pi / 180;
    watch.add(square(0.08 * std::cos(angle), 0.08 * std::sin(angle)), 0.02 * (k + 1), 0.02);
  }
  return watch.histogram();
}

}  // namespace

TEST(VoluteWatch, BothSidesSeeTheSameAngle) {
  // Requirement: seen from the motor's side, angles grow clockwise: what passes 45 to 435 degrees seen from the inlet passes -45 to -435 in
  // the picture, and recirculates once either way.
  const VoluteHistogram inlet = arc(camera("inlet", "counter_clockwise"), 45, 435);
  const VoluteHistogram motor = arc(camera("motor", "clockwise"), -45, -435);
  EXPECT_NEAR(inlet.time(), 40 * 0.02, 1e-12);
  for (int bin = 0; bin < n_volute_bins; ++bin) {
    EXPECT_NEAR(inlet.time(bin), motor.time(bin), 1e-12) << bin;
    EXPECT_NEAR(inlet.time(bin), bin == 2 || bin == 3 ? 0.08 : 0.04, 1e-12) << bin;  // 45 to 75 degrees were passed twice
    EXPECT_NEAR(inlet.radius(bin), 0.08, 1e-5) << bin;
  }
  EXPECT_EQ(inlet.n_events(PassageEvent::recirculated, 1), 1);
  EXPECT_EQ(motor.n_events(PassageEvent::recirculated, 1), 1);
  EXPECT_EQ(arc(camera("inlet", "clockwise"), 45, 435).n_events(PassageEvent::recirculated, 1), 0) << "against the impeller";
}

TEST(VoluteWatch, StuckOnTheTongueAndOut) {
  // Requirement: cloth seen at the tongue for more than 1 s is stuck there; what was in the discharge and is seen no more is out, what is
  // hidden elsewhere is not.
  VoluteWatch watch(camera("inlet", "counter_clockwise"));
  double time = 0;
  for (int k = 0; k < 60; ++k) watch.add(square(0.09, -0.012), time += 0.02, 0.02);
  for (int k = 0; k < 3; ++k) watch.add({}, time += 0.02, 0.02);
  const VoluteHistogram hidden = watch.histogram();
  EXPECT_EQ(hidden.n_events(PassageEvent::stuck_on_tongue, 17), 1);
  EXPECT_NEAR(hidden.share(17), 1, 1e-12);
  for (int bin = 0; bin < n_volute_bins; ++bin) EXPECT_EQ(hidden.n_events(PassageEvent::exited, bin), 0);
  watch.add(square(0.14, 0.10), time += 0.02, 0.02);
  for (int k = 0; k < 3; ++k) watch.add({}, time += 0.02, 0.02);
  EXPECT_EQ(watch.histogram().n_events(PassageEvent::tongue_passed, 1), 1);
  EXPECT_EQ(watch.histogram().n_events(PassageEvent::exited, 1), 1);
  EXPECT_NEAR(watch.histogram().time(), 1.2, 1e-9) << "the discharge is not the volute";
}

TEST(VoluteWatch, ViewsAndSummariesThatCannotBe) {
  Camera none = camera("inlet", "clockwise");
  none.volute->tongue = none.volute->axis;
  EXPECT_THROW(VoluteWatch{none}, Error);
  EXPECT_EQ(VoluteWatch(camera("inlet", "clockwise")).histogram().n_rags(), 0) << "nothing was seen";
  none.volute->axis = {1, 2, 3};
  EXPECT_THROW(check_volute_view(*none.volute, "camera"), Error);

  const auto folder = std::filesystem::temp_directory_path() / ("snag-summary-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  EXPECT_EQ(volute_of_run(folder).n_rags(), 0);
  std::ofstream(folder / "summary.json") << R"({"rags": [{"volute": []}]})";
  EXPECT_EQ(volute_of_run(folder).n_rags(), 0) << "a case without a pump";
  std::ofstream(folder / "summary.json") << R"({"rags": 3})";
  EXPECT_THROW(volute_of_run(folder), Error);
  std::filesystem::remove_all(folder);
}
