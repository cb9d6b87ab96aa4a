#include "dem/templates/passport.hpp"

#include <algorithm>
#include <cmath>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

constexpr double slack = 1e-9;  // of a radius, relative: units convert with round-off

bool same_radius(double a, double b) { return std::abs(a - b) <= slack * b; }

double between(double from, double to, double t) {
  if (from == to || t == 0) return from;
  if (t == 1) return to;
  return from > 0 && to > 0 ? from * std::pow(to / from, t) : 0;
}

BondProperties between(const BondProperties& a, const BondProperties& b, double t) {
  return {.normal_stiffness = between(a.normal_stiffness, b.normal_stiffness, t),
          .tangential_stiffness = between(a.tangential_stiffness, b.tangential_stiffness, t),
          .bending_stiffness = between(a.bending_stiffness, b.bending_stiffness, t),
          .normal_strength = between(a.normal_strength, b.normal_strength, t),
          .shear_strength = between(a.shear_strength, b.shear_strength, t)};
}

std::string millimetres(double length) { return number_text(1e3 * length); }

/// One [[bond]]; keys beside the properties are the record of the calibration.
void read_bond(const Table& table, Passport& passport, std::array<std::vector<double>, 2>& seen) {
  PassportEntry entry;
  std::string direction;
  BondProperties bond;
  const auto number = [](const char* key, double* target, const char* unit, bool required) {
    return Parameter{.key = key,
                     .target = target,
                     .unit = unit,
                     .minimum = required ? 1e-12 : 0,
                     .basis = Basis::calibrated,
                     .meaning = "Property of the bonds.",
                     .required = required};
  };
  std::vector<double> range;
  const auto noted = [&](const char* key, const char* unit) {
    return Parameter{.key = key, .target = &range, .unit = unit, .meaning = "Scatter."};
  };
  Parameter direction_key = setting("direction", &direction, "LW or CW.", {"LW", "CW"});
  direction_key.required = true;
  table.read({number("radius", &entry.radius, "m", true), direction_key, number("normal_stiffness", &bond.normal_stiffness, "N/m3", true),
              number("tangential_stiffness", &bond.tangential_stiffness, "N/m3", true),
              number("bending_stiffness", &bond.bending_stiffness, "N/m3", true),
              number("normal_strength", &bond.normal_strength, "Pa", false), number("shear_strength", &bond.shear_strength, "Pa", false),
              noted("normal_stiffness_range", "N/m3"), noted("tangential_stiffness_range", "N/m3"),
              noted("bending_stiffness_range", "N/m3"), noted("normal_strength_range", "Pa")});
  const int d = direction == "CW" ? 1 : 0;
  for (const double radius : seen[d])
    if (same_radius(radius, entry.radius))
      throw Error(ExitCode::usage, table.where() + ": radius " + millimetres(radius) + " mm " + direction + " is given twice; keep one");
  seen[d].push_back(entry.radius);
  const auto at = std::find_if(passport.entries.begin(), passport.entries.end(),
                               [&](const PassportEntry& e) { return same_radius(e.radius, entry.radius); });
  if (at != passport.entries.end()) {
    at->bond[d] = bond;
    return;
  }
  entry.bond[d] = bond;
  passport.entries.push_back(entry);
}

/// Tables that tell where the passport comes from; a simulation needs none of them.
void read_record(const Table& root) {
  std::string text;
  std::vector<std::string> pictures;
  double value = 0;
  std::vector<double> values;
  const auto noted = [&](const char* key, const char* unit) {
    return Parameter{.key = key, .target = &value, .unit = unit, .meaning = "For the record."};
  };
  const auto noted_list = [&](const char* key, const char* unit) {
    return Parameter{.key = key, .target = &values, .unit = unit, .meaning = "For the record."};
  };
  root.table("textile").read({setting("name", &text, "Name of the cloth."), setting("source", &text, "Source of the measurements."),
                              setting("tests", &text, "File of the measurements."), setting("clamps", &text, "How they were counted."),
                              setting("pictures", &pictures, "Pictures of the calibration."), noted("thickness", "m"),
                              noted("contact_radius_over_radius", "1")});
  for (const Table& table : root.tables("check"))
    table.read({noted("radius", "m"), setting("direction", &text, "LW or CW."), noted("grab_force", "N"),
                noted("grab_force_deviation", "1"), noted("grab_strain_deviation", "1"), noted("tip_above_plane", "m")});
  for (const Table& table : root.tables("drape"))
    table.read({noted("radius", "m"), noted("area", "m2"), noted("area_deviation", "1"), noted("area_spread", "m2"),
                noted("wave_size", "m"), noted("wave_size_deviation", "1"), noted("wave_size_spread", "m"), noted("waves", "1"),
                noted_list("waves_range", "1"), noted("seeds", "1")});
}

}  // namespace

BondProperties Passport::bond(double radius, int direction) const {
  const std::size_t n = entries.size();
  if (radius < entries.front().radius * (1 - slack) || radius > entries.back().radius * (1 + slack)) {
    std::string radii;
    for (const PassportEntry& entry : entries) radii += (radii.empty() ? "" : ", ") + millimetres(entry.radius);
    throw Error(ExitCode::usage, name + ": radius of " + millimetres(radius) + " mm is outside the calibrated radii " + radii +
                                     " mm; use a radius between them, or calibrate the cloth for it (snag calibrate)");
  }
  std::size_t i = 0;
  while (i + 2 < n && radius >= entries[i + 1].radius * (1 - slack)) ++i;
  if (same_radius(radius, entries[i].radius)) return entries[i].bond[direction];
  const double t = std::log(radius / entries[i].radius) / std::log(entries[i + 1].radius / entries[i].radius);
  return between(entries[i].bond[direction], entries[i + 1].bond[direction], same_radius(radius, entries[i + 1].radius) ? 1 : t);
}

Passport read_passport(const std::filesystem::path& path) {
  const CaseFile file = CaseFile::read(path);
  Passport passport;
  passport.name = path.string();
  std::array<std::vector<double>, 2> seen;
  for (const Table& table : file.root().tables("bond")) read_bond(table, passport, seen);
  read_record(file.root());
  file.reject_unread();
  if (passport.entries.empty())
    throw Error(ExitCode::usage, path.string() + ": has no [[bond]], must have two for each radius; make one by snag calibrate");
  for (const PassportEntry& entry : passport.entries)
    for (int d = 0; d < 2; ++d)
      if (entry.bond[d].normal_stiffness <= 0)
        throw Error(ExitCode::usage, path.string() + ": radius " + millimetres(entry.radius) + " mm has no [[bond]] of direction " +
                                         (d == 0 ? "LW" : "CW") + "; both directions are needed");
  std::sort(passport.entries.begin(), passport.entries.end(),
            [](const PassportEntry& a, const PassportEntry& b) { return a.radius < b.radius; });
  return passport;
}

}  // namespace snag
