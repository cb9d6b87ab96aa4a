#include "benchmark/blind/twin_unmodelled.hpp"

#include <cmath>

#include "base/vec3.hpp"

namespace snag {

std::vector<std::string> unmodelled_truths(const std::string& twin) {
  std::vector<std::string> names{"periodic", "stratified", "gust", "profile", "camera"};
  if (twin != "sphere") names.push_back("curved");
  return names;
}

UnmodelledTruth unmodelled_truth(const std::string& name, double strength, const TwinExperiment& experiment, NormalNumbers& random) {
  const double end = experiment.times.back(), path = experiment.path;
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  UnmodelledTruth truth;
  if (name == "periodic") {
    const double a = strength * between(0.5, 1.5), omega = between(15, 40), phase = between(0, 6);
    const Vec3 direction = unit(Vec3{between(-1, 1), between(-0.3, 0.3), between(-1, 1)});
    truth.force = [=](double t, const LatticePosition&) { return a * std::sin(omega * t + phase) * direction; };
  } else if (name == "stratified") {
    const double rate = strength * between(10, 30);  // N^2, 1/s2
    truth.force = [=](double, const LatticePosition& p) { return Vec3{0, 0, -rate * p.x.z}; };
  } else if (name == "gust") {
    const double a = strength * between(1, 3), begin = between(0.2, 0.5) * end, length = between(0.1, 0.2) * end;
    const Vec3 direction = unit(Vec3{between(-1, 1), 0, between(-1, 1)});
    truth.force = [=](double t, const LatticePosition&) { return t > begin && t < begin + length ? a * direction : Vec3{}; };
  } else if (name == "profile") {
    const double a = strength * between(0.5, 1.5) * (random.uniform() < 0.5 ? -1 : 1);  // of the drag by the flow's curved part at `path`
    truth.force = [=](double, const LatticePosition& p) { return Vec3{a * (p.x.z / path) * (p.x.z / path), 0, 0}; };
  } else if (name == "curved") {
    // Ends against the middle, along the piece's own normal: no net force, no net torque, and it turns with the piece.
    const double a = strength * between(0.5, 1.5) * experiment.tip_acceleration;
    truth.force = [=](double, const LatticePosition& p) { return (a * (std::abs(p.along) - p.mean_abs_along)) * p.normal; };
  } else if (name == "camera") {
    truth.pixel_ratio = 1 + strength * between(0.04, 0.1) * (random.uniform() < 0.5 ? -1 : 1);
  }
  return truth;
}

}  // namespace snag
