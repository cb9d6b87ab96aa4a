#include "solver/fields/rotating_zone.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/case_file.hpp"
#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

Section RotatingZoneSettings::section() {
  Parameter name = setting("zone", &zone, "Physical volume of the rotor.");
  name.required = true;
  return {.name = "rotating_zone",
          .meaning =
              "A zone of the mesh that turns: it slides past the rest, or is computed in a turning frame for a steady start. Its walls "
              "(kind = \"wall\") turn with it.",
          .parameters = {
              name,
              setting("motion", &motion,
                      "sliding: the mesh turns in every step. frame: multiple reference frame, the mesh stays at start_angle and the flow "
                      "is that of this rotor position."),
              setting("rotor_patch", &rotor_patch, "Sliding interface on the side of the rotor."),
              setting("stator_patch", &stator_patch, "Sliding interface on the side of the stator."),
              {"origin", &origin, "m", -infinity, infinity, Basis::assumed, "A point on the axis."},
              {"axis", &axis, "1", -infinity, infinity, Basis::assumed,
               "Direction of the axis, a vector of any length; rotation is positive in the right-handed sense."},
              renamed({"rotation_speed", &speed, "rad/s", -infinity, infinity, Basis::assumed,
                       "Speed of rotation; \"1200 rpm\" is understood."},
                      {.key = "speed"}),
              {"ramp", &ramp, "s", 0, infinity, Basis::assumed, "Time in which the speed grows linearly from zero to its full value."},
              {"start_angle", &start_angle, "rad", -infinity, infinity, Basis::assumed,
               "Angle of the rotor at the start relative to its position in the mesh file; \"90 deg\" is understood."}}};
}
const bool rotating_zone_table = add_case_table<RotatingZoneSettings>(70);

namespace {

SlidingDescription description(const Mesh& mesh, const RotatingZoneSettings& settings) {
  if (std::find(mesh.zones.begin(), mesh.zones.end(), settings.zone) == mesh.zones.end())
    throw Error(ExitCode::usage,
                "[rotating_zone] zone = \"" + settings.zone + "\": the mesh has no such volume; it has: " + joined(mesh.zones));
  if (norm(settings.axis) == 0) throw Error(ExitCode::usage, "[rotating_zone] axis (0, 0, 0) has no direction; give a vector along it");
  return {.origin = settings.origin,
          .axis = settings.axis,
          .rotor_zone = settings.zone,
          .rotor_patch = settings.rotor_patch,
          .stator_patch = settings.stator_patch,
          .gap_picture = settings.gap_picture};
}

}  // namespace

RotatingZone::RotatingZone(Mesh& mesh, const RotatingZoneSettings& settings)
    : mesh_(mesh, description(mesh, settings), settings.start_angle),
      origin_(settings.origin),
      axis_(unit(settings.axis)),
      speed_(settings.speed),
      ramp_(settings.ramp),
      start_angle_(settings.start_angle),
      slides_(settings.motion == RotatingZoneSettings::Motion::sliding) {}

double RotatingZone::speed(double time) const {
  if (time >= ramp_ || ramp_ == 0) return speed_;
  return speed_ * std::max(time, 0.0) / ramp_;
}

double RotatingZone::angle(double time) const {
  if (!slides_) return start_angle_;
  if (time >= ramp_ || ramp_ == 0) return start_angle_ + speed_ * (time - 0.5 * ramp_);
  return start_angle_ + speed_ * 0.5 * std::max(time, 0.0) * time / ramp_;
}

// In the plane across the axis as that of complex numbers, where a velocity that turns is w = exp(i theta(t)): with one complex b,
//   dw/dt ~ ((w - w_old) + b ((w - w_old) - ratio (w_old - w_older)))/dt
// is exact for what stands and grows linearly whatever b is, which is ratio/(1 + ratio) in BDF2.
Mat3 RotatingZone::turning_difference(double begun, const TimeScheme& time) const {
  constexpr double least = 1e-7, most = 1;  // rad a step: below it is round-off
  if (!slides_ || time.ratio == 0) return {};
  const double now = begun + time.dt, step = angle(now) - angle(begun), two_steps = angle(now) - angle(begun - time.dt / time.ratio);
  if (std::abs(step) < least || std::abs(step) > most) return {};
  const auto change = [](double theta) { return std::complex(2 * std::sin(theta / 2) * std::sin(theta / 2), std::sin(theta)); };  // 1 - w
  const std::complex<double> rate(0, speed(now) * time.dt), old = change(step), older = change(two_steps);
  const std::complex<double> b = (rate - old) / (old - time.ratio * (older - old)) - time.ratio / (1 + time.ratio);
  const auto row = [&](const Vec3& e) { return b.real() * (e - dot(axis_, e) * axis_) + b.imag() * cross(e, axis_); };
  return {row({1, 0, 0}), row({0, 1, 0}), row({0, 0, 1})};
}

std::unique_ptr<RotatingZone> read_rotating_zone(const Table& root, Mesh& mesh, const std::filesystem::path& gap_picture) {
  if (!root.has("rotating_zone")) return nullptr;
  RotatingZoneSettings settings;
  settings.gap_picture = gap_picture;
  root.table("rotating_zone").read(settings.section().parameters);
  return std::make_unique<RotatingZone>(mesh, settings);
}

}  // namespace snag
