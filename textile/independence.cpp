#include "textile/independence.hpp"

#include <algorithm>

#include "base/words.hpp"

namespace snag {

namespace {

constexpr double radius_ratios[] = {1.0 / 3, 2.0 / 3, 1, 4.0 / 3, 5.0 / 3};  // 0.5 to 2.5 mm about 1.5 mm, as published
constexpr double step_shares[] = {0.02, 0.05, 0.1, 0.2, 0.4, 0.8};
constexpr double dampings[] = {0, 0.25, 0.5, 1}, frictions[] = {0, 0.001, 0.01, 0.05};  // Figs. 1.12, 1.13
constexpr double strip_duration = 1.5, strip_air = 30;                                  // s, 1/s: at rest to 0.02 mm
constexpr double drape_air = 3;                                                         // 1/s: takes out the swing, never the folds

RadiusPoint at_radius(const TextileTests& tests, const Calibration& c, double radius) {
  CalibrationSettings settings = c.settings;
  settings.radius = radius;
  const double ratio = c.settings.radius / radius;
  RadiusPoint point{radius, bonds_at(tests, settings, c.bond[0].tangential_stiffness * ratio * ratio), {}, {}, {}};
  for (int d = 0; d < 2; ++d) {
    point.grab[d] = simulated_grab_test(tests, d, radius, {point.bond[d], point.bond[1 - d]});
    point.strip[d] = hanging_strip(strip_of(tests, d, radius, point.bond[d]));
    point.height[d] = height_above_plane(point.strip[d].tip, tests.plane_angle);
  }
  return point;
}

template <class Points, class Value>
double spread(const Points& points, const Value& value) {
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
  return value(*high) / value(*low) - 1;
}

}  // namespace

double Independence::strain_spread(int direction) const {
  return spread(radii, [&](const RadiusPoint& point) { return point.grab[direction].strain_at_max; });
}

double Independence::force_spread(int direction) const {
  return spread(radii, [&](const RadiusPoint& point) { return point.grab[direction].max_force; });
}

double Independence::tip_spread() const {
  double farthest = 0;
  for (const StepPoint& a : steps)
    for (const StepPoint& b : steps) farthest = std::max(farthest, norm(a.strip.tip - b.strip.tip));
  return farthest / norm(steps.front().strip.tip);
}

Independence independence_of_size_and_step(const TextileTests& tests, const Calibration& c) {
  Independence found;
  const double radius = c.settings.radius;
  for (const double ratio : radius_ratios) {
    found.radii.push_back(at_radius(tests, c, ratio * radius));
    const RadiusPoint& point = found.radii.back();
    c.settings.report_progress("radius " + number_text(1e3 * point.radius) + " mm: grab test " + number_text(point.grab[0].max_force) +
                               " N at a strain of " + number_text(point.grab[0].strain_at_max) + " lengthwise, " +
                               number_text(point.grab[1].max_force) + " N at " + number_text(point.grab[1].strain_at_max) + " crosswise");
  }
  for (const double share : step_shares) {
    const Strip strip = strip_of(tests, 0, radius, c.bond[0]);
    found.steps.push_back({share, simulated_grab_test(tests, 0, radius, {c.bond[0], c.bond[1]}, share),
                           moved_strip(strip, tests.bond_damping, strip_duration, strip_air, share)});
    const StepPoint& point = found.steps.back();
    c.settings.report_progress("step of " + number_text(share) + " of the stable one: grab test " + number_text(point.grab.max_force) +
                               " N at a strain of " + number_text(point.grab.strain_at_max) + ", tip of the strip " +
                               number_text(1e3 * height_above_plane(point.strip.tip, tests.plane_angle)) + " mm above the plane");
  }
  return found;
}

Independence independence(MPI_Comm comm, const TextileTests& tests, const Calibration& c) {
  Independence found = independence_of_size_and_step(tests, c);
  const double radius = c.settings.radius;
  for (const double damping : dampings) found.dampings.push_back({damping, tests.rotation_friction, {}});
  for (const double friction : frictions) found.frictions.push_back({tests.bond_damping, friction, {}});
  std::vector<DampingPoint*> points;
  for (auto* list : {&found.dampings, &found.frictions})
    for (DampingPoint& point : *list) points.push_back(&point);
  const std::vector<DrapeSample> samples = drape_samples(comm, points.size(), [&](std::size_t i) {
    DrapeCloth cloth = drape_cloth(tests, radius, c.bond);
    cloth.bond_damping = points[i]->bond_damping, cloth.rotation_friction = points[i]->rotation_friction;
    const Drape drape = moved_drape(drape_test(tests), cloth, 1, drape_duration, drape_air);
    return DrapeSample{1, outline_from_above(drape.sheet, radius), drape.cost};
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i]->outline = samples[i].outline;
    c.settings.report_progress("drape with damping " + number_text(points[i]->bond_damping) + " and rotation friction " +
                               number_text(points[i]->rotation_friction) + ": area " + number_text(1e4 * samples[i].outline.area) +
                               " cm2, " + std::to_string(samples[i].outline.waves.size()) + " waves of " +
                               number_text(1e3 * samples[i].outline.mean_wave_size()) + " mm");
  }
  return found;
}

}  // namespace snag
