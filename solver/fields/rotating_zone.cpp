#include "solver/fields/rotating_zone.hpp"

#include <algorithm>

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

double RotatingZone::speed(double time) const { return time < ramp_ ? speed_ * time / ramp_ : speed_; }

double RotatingZone::angle(double time) const {
  if (!slides_) return start_angle_;
  return start_angle_ + speed_ * (time < ramp_ ? 0.5 * time * time / ramp_ : time - 0.5 * ramp_);
}

std::unique_ptr<RotatingZone> read_rotating_zone(const Table& root, Mesh& mesh, const std::filesystem::path& gap_picture) {
  if (!root.has("rotating_zone")) return nullptr;
  RotatingZoneSettings settings;
  settings.gap_picture = gap_picture;
  root.table("rotating_zone").read(settings.section().parameters);
  return std::make_unique<RotatingZone>(mesh, settings);
}

}  // namespace snag
