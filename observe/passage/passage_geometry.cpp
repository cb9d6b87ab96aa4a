#include "observe/passage/passage_geometry.hpp"

#include <cmath>
#include <numbers>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

// Of a unit vector: below it a direction is taken for perpendicular, or a point to lie on the axis.
constexpr double least_part = 1e-3;

Parameter required(Parameter parameter) {
  parameter.required = true;
  return parameter;
}

Parameter point(const std::string& key, Vec3* target, const std::string& meaning) {
  return required({key, target, "m", -infinity, infinity, Basis::assumed, meaning});
}

Parameter length(const std::string& key, double* target, const std::string& meaning) {
  return required({key, target, "m", 0, infinity, Basis::assumed, meaning});
}

Vec3 direction_of(const Vec3& v, const std::string& where, const char* key) {
  if (norm(v) > 0) return unit(v);
  throw Error(ExitCode::usage, where + ": " + key + " = (0, 0, 0) has no direction; give a vector of any length");
}

Vec3 across(const Vec3& v, const Vec3& n) { return v - dot(v, n) * n; }

}  // namespace

Section PassageSettings::section() {
  return {"rag_passage",
          "Geometry that defines when a rag enters the pump, recirculates, is stuck and leaves: two flange planes and the tongue. Angles "
          "are about the axis of [rotating_zone], zero at the tongue, counter-clockwise positive seen from the inlet. Without this table a "
          "rag has left when it is beyond a patch by which water leaves: an outlet, or an inlet that draws water out.",
          {point("inlet_flange", &inlet_flange, "Centre of the plane where the casing begins."),
           required({"inlet_normal", &inlet_normal, "1", -infinity, infinity, Basis::assumed,
                     "Normal of the inlet plane into the casing, a vector of any length."}),
           length("inlet_radius", &inlet_radius,
                  "Radius of the pipe or tank in front of the inlet plane; a particle in front of the plane and within 1.5 radii of its "
                  "axis is upstream."),
           point("outlet_flange", &outlet_flange, "Centre of the plane where the casing ends."),
           required({"outlet_normal", &outlet_normal, "1", -infinity, infinity, Basis::assumed,
                     "Normal of the outlet plane out of the casing, a vector of any length."}),
           length("outlet_radius", &outlet_radius,
                  "Radius of the outlet; a particle beyond the plane and within 1.5 radii of its axis has left."),
           point("tongue", &tongue, "Middle of the nose of the tongue."),
           length("tongue_reach", &tongue_reach,
                  "Distance from the line through the tongue along the axis; contact with a stationary wall within it counts as contact "
                  "with the tongue."),
           length("impeller_radius", &impeller_radius, "Outer radius of the impeller; a particle further from the axis is in the volute.")},
          false,
          "passage"};
}
const bool passage_table = add_case_table<PassageSettings>(110);

PassageGeometry::PassageGeometry(const PassageSettings& s, const Vec3& origin, const Vec3& axis, double speed, const std::string& where)
    : origin_(origin), tongue_(s.tongue), tongue_reach_(s.tongue_reach), impeller_radius_(s.impeller_radius) {
  for (const auto& [value, key] :
       {std::pair{s.inlet_radius, "inlet_radius"}, {s.outlet_radius, "outlet_radius"}, {s.impeller_radius, "impeller_radius"}})
    if (value <= 0) throw Error(ExitCode::usage, where + ": " + key + " = " + number_text(value) + " m must be above 0; give the radius");
  const Vec3 into = direction_of(s.inlet_normal, where, "inlet_normal"), out = direction_of(s.outlet_normal, where, "outlet_normal");
  if (std::abs(dot(into, axis)) < least_part)
    throw Error(ExitCode::usage, where +
                                     ": inlet_normal is perpendicular to the axis of [rotating_zone], so that no side of the impeller "
                                     "is that of the inlet; give a direction into the casing along the axis");
  up_ = dot(into, axis) < 0 ? unit(axis) : -unit(axis);
  inlet_ = {"inlet", s.inlet_flange, -into, s.inlet_radius, false};
  outlet_ = {"outlet", s.outlet_flange, out, s.outlet_radius, true};
  const Vec3 arm = across(s.tongue - origin, up_);
  if (norm(arm) < least_part * s.impeller_radius)
    throw Error(ExitCode::usage, where + ": tongue = " + point_text(s.tongue) +
                                     " lies on the axis of [rotating_zone], where no angle begins; "
                                     "give the middle of its nose");
  first_ = unit(arm), second_ = cross(up_, first_);
  speed_ = speed * dot(axis, up_);
  const Vec3 side = across(arm, out);
  away_from_shaft_ = norm(side) > least_part * norm(arm) ? unit(side) : Vec3{};  // an outlet along the radius: the plane alone decides
}

bool PassageGeometry::is_in_discharge(const Vec3& x) const {
  const Vec3 past = x - tongue_;
  return is_out(x) || (dot(past, outlet_.normal) > 0 && dot(past, away_from_shaft_) >= 0);
}

PlaceInPump PassageGeometry::place_of(const Vec3& x) const {
  const double past = sense() * angle(x);
  return {.upstream = is_upstream(x),
          .out = is_out(x),
          .in_discharge = is_in_discharge(x),
          .outside_impeller = radius(x) > impeller_radius_,
          .just_past_tongue = past > 0 && past < std::numbers::pi / 2};
}

double PassageGeometry::angle(const Vec3& x) const {
  const Vec3 arm = x - origin_;
  constexpr double on_axis = 1e-9;  // of the impeller's radius: there the arm is rounding, and so would be its angle
  if (radius(x) < on_axis * impeller_radius_) return 0;
  const double a = std::atan2(dot(arm, second_), dot(arm, first_));
  return a == -std::numbers::pi ? std::numbers::pi : a;
}

double PassageGeometry::radius(const Vec3& x) const { return norm(across(x - origin_, up_)); }

std::optional<PassageGeometry> read_passage(const Table& root, const std::optional<Shaft>& shaft) {
  PassageSettings settings;
  const Section section = settings.section();
  if (!root.has(section)) return {};
  const Table table = root.table(section);
  table.read(section.parameters);
  if (!shaft)
    throw Error(ExitCode::usage, table.where() +
                                     " needs the axis of [rotating_zone], which the case lacks; add [rotating_zone], or remove "
                                     "[rag_passage]");
  return PassageGeometry(settings, shaft->origin, shaft->axis, shaft->speed, table.where());
}

}  // namespace snag
