#pragma once
// Where in a pump a point is, in the frame of the casing: upstream, in the casing, beyond the outlet; and by angle and radius about the
// shaft.
//
//   upstream    behind the plane of the inlet flange and within 1.5 inlet radii of its axis
//   out         beyond the plane of the outlet flange and within 1.5 outlet radii of its axis
//   casing      anywhere else
//   discharge   what lies past the tongue on the outlet's side: past the tongue along the outlet's normal, and on the far side of the
//               tongue from the shaft; everything out is in it too
//   angle       about the shaft, zero at the tongue, counter-clockwise positive seen from the inlet
#include <optional>
#include <string>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "base/shaft.hpp"
#include "observe/passage/opening.hpp"

namespace snag {

/// The table [rag_passage].
struct PassageSettings {
  Vec3 inlet_flange, inlet_normal, outlet_flange, outlet_normal;  // m; any length: into the casing, out of it
  double inlet_radius = 0, outlet_radius = 0;                     // m
  Vec3 tongue;                                                    // m
  double tongue_reach = 0, impeller_radius = 0;                   // m

  /// Its records point into this object.
  Section section();
};

/// Regions of the pump that a point lies in, for the passage of a rag (observe/passage/passage_tracker.hpp).
struct PlaceInPump {
  bool upstream = false, out = false, in_discharge = false, outside_impeller = false;
  bool just_past_tongue = false;  // within a quarter turn past its angle in the sense of rotation
};

class PassageGeometry {
 public:
  /// `axis` and `origin` (m) of the shaft, `speed` of it (right-handed about the axis; the sign counts). `where` stands in messages. Throws
  /// Error(usage).
  PassageGeometry(const PassageSettings& settings, const Vec3& origin, const Vec3& axis, double speed, const std::string& where);

  bool is_upstream(const Vec3& x) const { return inlet_.beyond(x) > 0; }
  bool is_out(const Vec3& x) const { return outlet_.beyond(x) > 0; }
  bool is_in_discharge(const Vec3& x) const;
  PlaceInPump place_of(const Vec3& x) const;
  /// rad, in (-pi, pi]; 0 on the axis.
  double angle(const Vec3& x) const;
  /// Distance from the axis, m.
  double radius(const Vec3& x) const;
  /// Along the axis from its origin, towards the inlet, m.
  double height(const Vec3& x) const { return dot(x - origin_, up_); }
  /// +1 where the impeller turns towards larger angles, -1 towards smaller ones.
  int sense() const { return speed_ < 0 ? -1 : 1; }
  /// Of the impeller, towards larger angles, rad/s.
  double speed() const { return speed_; }

  /// The nose of the tongue: a line along the axis.
  const Vec3& tongue() const { return tongue_; }
  const Vec3& direction() const { return up_; }
  double tongue_reach() const { return tongue_reach_; }

 private:
  Vec3 origin_, up_, first_, second_;  // unit: along the shaft towards the inlet; to the tongue; a quarter turn further
  Opening inlet_, outlet_;
  Vec3 tongue_, away_from_shaft_;  // unit, across the discharge
  double tongue_reach_, impeller_radius_, speed_;
};

/// The table [rag_passage], none if the case has none; `shaft` with its full speed. Throws Error(usage), also where the table is given and
/// nothing turns.
std::optional<PassageGeometry> read_passage(const Table& root, const std::optional<Shaft>& shaft);

}  // namespace snag
