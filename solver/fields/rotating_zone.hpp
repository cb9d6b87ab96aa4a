#pragma once
// The turning part of the water: a zone of the mesh that slides past the rest, or stands and is computed in the frame that turns with it.
//
//   motion = "sliding":  the zone turns;     d/dt|_cell (rho V u) + sum rho (F - F_mesh) u = ...
//   motion = "frame":    the zone stands;    d/dt (rho V u) + sum rho (F - F_mesh) u = ... - rho V omega x u      (multiple reference
//   frame)
//
// u is the absolute velocity in both. F_mesh, the flux swept by the faces of the zone, is the same at every angle. A frame gives the steady
// flow for one position of the rotor, a start for the sliding run.
#include <filesystem>
#include <memory>
#include <string>

#include "base/choice.hpp"
#include "base/parameter.hpp"
#include "mesh/sliding/turning_mesh.hpp"
#include "solver/fields/time_scheme.hpp"

namespace snag {

class Table;

struct RotatingZoneSettings {
  enum class Motion { sliding, frame };
  std::string zone;
  Choice<Motion> motion{Motion::sliding, {"sliding", "frame"}};
  std::string rotor_patch = "interface_rotor", stator_patch = "interface_stator";
  Vec3 origin{}, axis{0, 0, 1};
  double speed = 0, ramp = 0, start_angle = 0;  // rad/s, s, rad
  std::filesystem::path gap_picture;            // for an error, see SlidingDescription

  /// The table [rotating_zone]; its records point into this object.
  Section section();
};

class RotatingZone {
 public:
  /// Joins the zones of the mesh. Collective; throws Error(usage, mesh).
  RotatingZone(Mesh& mesh, const RotatingZoneSettings& settings);

  /// True if the mesh moves.
  bool slides() const { return slides_; }
  int zone() const { return mesh_.zone(); }
  /// rad/s, with its ramp from zero: omega min(t/T, 1); zero before t = 0, omega without a ramp.
  double speed(double time) const;
  /// The same at the end of the ramp; and the ramp, s.
  double full_speed() const { return speed_; }
  double ramp() const { return ramp_; }
  /// omega as a vector, rad/s.
  Vec3 rotation_speed(double time) const { return speed(time) * axis_; }
  /// Angle of the rotor from where the mesh file has it, rad, not reduced; that of the start in a frame.
  double angle(double time) const;
  /// What BDF2 lacks for a velocity that turns with a sliding zone: the matrix K for which
  ///   du/dt ~ (now u + old u_old + older u_older + K s)/dt,   s = (u - u_old) - ratio (u_old - u_older)
  /// is exact for velocities that stand, that grow linearly in time, and that turn with the zone, for any speed of it from step to step.
  /// BDF2 alone turns a velocity that turns by theta in a step too fast by theta^2/3 of its rate, and damps it by theta^3/4 in a radian.
  /// Zero in a frame, without a history, and at more than one radian a step. `begun`: the time at the begin of the step, s.
  Mat3 turning_difference(double begun, const TimeScheme& time) const;
  /// Unit vector of the axis and a point on it.
  const Vec3& axis() const { return axis_; }
  const Vec3& origin() const { return origin_; }

  TurningMesh& mesh() { return mesh_; }
  const TurningMesh& mesh() const { return mesh_; }

 private:
  TurningMesh mesh_;
  Vec3 origin_, axis_;
  double speed_, ramp_, start_angle_;
  bool slides_;
};

/// The table [rotating_zone], null if the case has none. `gap_picture`: where an error draws faces that do not meet.
std::unique_ptr<RotatingZone> read_rotating_zone(const Table& root, Mesh& mesh, const std::filesystem::path& gap_picture);

}  // namespace snag
