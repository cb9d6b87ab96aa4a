#include "textile/textile_tests.hpp"

#include <cmath>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

using Records = std::vector<Parameter>;
constexpr double tiny = 1e-12;  // what must be positive

Parameter number(const char* key, double* target, const char* unit, const char* meaning, bool required = true, double minimum = tiny,
                 double maximum = infinity) {
  return {.key = key,
          .target = target,
          .unit = unit,
          .minimum = minimum,
          .maximum = maximum,
          .basis = Basis::measured,
          .meaning = meaning,
          .required = required};
}

constexpr double lightest = 0.01, heaviest = 100;  // kg/m2: below the thinnest tissue the motion takes days

/// A key that describes the laboratory's procedure and enters no computation.
Parameter noted(const char* key, double* target, const char* unit) { return number(key, target, unit, "For the record.", false, 0); }

Parameter count(int* target) {
  return {.key = "repetitions", .target = target, .minimum = 1, .basis = Basis::measured, .meaning = "Number of samples."};
}

/// Reads "<key>" as a list of the smallest and the largest value, which must hold `mean`.
MeasuredRange read_range(const Table& table, const char* key, const char* unit, double mean) {
  std::vector<double> values;
  table.read(
      {{.key = key, .target = &values, .unit = unit, .minimum = tiny, .basis = Basis::measured, .meaning = "Smallest and largest."}});
  if (values.empty()) return {};
  if (values.size() != 2 || values[0] > mean || mean > values[1])
    throw Error(ExitCode::usage, table.where() + " " + key + ": is no range that holds the mean of " + words(mean) + " " + unit +
                                     "; give [smallest, largest]");
  return {values[0], values[1]};
}

Table direction_of(const Table& test, int direction) {
  const Table table = test.table(direction_key[direction]);
  if (!table.present())
    throw Error(ExitCode::usage, test.where() + ": the test " + direction_name[direction] +
                                     " is missing; both directions are needed, add the table of " + direction_key[direction] +
                                     " with what was measured");
  return table;
}

void read_cloth(const Table& root, TextileTests& t) {
  double dry_mass = 0;
  const Table rag = root.table("rag");
  rag.read({setting("name", &t.name, "Name of the cloth."), setting("source", &t.source, "Source of the measurements."),
            number("length_lw", &t.length, "m", "Side of the cloth lengthwise."), number("length_cw", &t.width, "m", "Side crosswise."),
            number("thickness", &t.thickness, "m", "Thickness of the cloth."), noted("dry_mass_per_area", &dry_mass, "kg/m2")});
}

void read_elongation(const Table& root, TextileTests& t) {
  const Table test = root.table("elongation");
  double rate = 0;
  test.read({number("clamp_width", &t.clamp_width, "m", "Width of cloth that the clamps grip."),
             number("gauge_length", &t.gauge_length, "m", "Distance of the clamps at the start."), noted("rate", &rate, "m/s"),
             noted("rate_m_per_s", &rate, "1"),
             number("wet_density", &t.elongation_density, "kg/m3", "Density of the wet cloth, over its thickness.")});
  for (int d = 0; d < 2; ++d) {
    const Table table = direction_of(test, d);
    ElongationResult& r = t.elongation[d];
    double elongation = 0;
    table.read({number("max_force_mean", &r.max_force, "N", "Largest force, mean of the samples."),
                number("max_strain", &r.max_strain, "1", "Elongation over gauge length at the largest force."),
                number("max_elongation", &elongation, "m", "The same as a length.", false), count(&r.repetitions)});
    r.force_range = read_range(table, "max_force_range", "N", r.max_force);
    constexpr double rounding = 0.01;  // of a table
    if (elongation > 0 && std::abs(elongation / t.gauge_length / r.max_strain - 1) > rounding)
      throw Error(ExitCode::usage, table.where() + " max_elongation: is " + words(elongation) + " m, but max_strain of " +
                                       words(r.max_strain) + " on a gauge length of " + words(t.gauge_length) + " m is " +
                                       words(r.max_strain * t.gauge_length) + " m; correct one of them");
  }
}

void read_bending(const Table& root, TextileTests& t) {
  const Table test = root.table("bending");
  double width = 0, length = 0, density = 0;
  test.read({{.key = "plane_angle",
              .target = &t.plane_angle,
              .unit = "rad",
              .minimum = 0.05,
              .maximum = 1.5,
              .basis = Basis::measured,
              .meaning = "Angle of the plane below the horizontal.",
              .required = true},
             noted("strip_width", &width, "m"),
             noted("strip_total_length", &length, "m"),
             noted("wet_density", &density, "kg/m3")});
  for (int d = 0; d < 2; ++d) {
    const Table table = direction_of(test, d);
    BendingResult& r = t.bending[d];
    table.read({number("overhang_mean", &r.overhang, "m", "Length over the edge at which the tip touches the plane, mean."),
                number("mass_per_area", &r.mass_per_area, "kg/m2", "Mass of the tested strip per area.", true, lightest, heaviest),
                count(&r.repetitions)});
    r.overhang_range = read_range(table, "overhang_range", "m", r.overhang);
    if (length > 0 && r.overhang > length)
      throw Error(ExitCode::usage, table.where() + " overhang_mean: is " + words(r.overhang) + " m, longer than the strip of " +
                                       words(length) + " m: the rag cannot reach the plane; correct one of them");
  }
}

void read_drape(const Table& root, TextileTests& t) {
  const Table test = root.table("drape");
  DrapeResult& r = t.drape;
  double density = 0;
  test.read({number("sample_diameter", &r.sample_diameter, "m", "Diameter of the round sample."),
             number("disc_diameter", &r.disc_diameter, "m", "Diameter of the table below the sample."),
             number("mass_per_area", &r.mass_per_area, "kg/m2", "Mass of the tested sample per area.", true, lightest, heaviest),
             number("area_mean", &r.area, "m2", "Mean area of the draped sample seen from above."),
             number("wave_size_mean", &r.wave_size, "m", "From the centre to the outline at its peaks, mean."),
             number("wave_count_mean", &r.wave_count, "1", "Peaks of the outline, mean."), noted("wet_density", &density, "kg/m3"),
             count(&r.repetitions)});
  r.wave_size_range = read_range(test, "wave_size_range", "m", r.wave_size);
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, test.where() + " " + what); };
  const double disc = r.disc_diameter, sample = r.sample_diameter;
  if (disc >= sample) refuse("disc_diameter: is " + words(disc) + " m, must be smaller than the sample of " + words(sample) + " m");
  constexpr double quarter_pi = 0.785398163397448;
  if (r.area < quarter_pi * disc * disc || r.area > quarter_pi * sample * sample)
    refuse("area_mean: is " + words(r.area) + " m2, must lie between that of the disc and of the flat sample, " +
           words(quarter_pi * disc * disc) + " and " + words(quarter_pi * sample * sample) + " m2");
  if (r.wave_size > sample / 2)
    refuse("wave_size_mean: is " + words(r.wave_size) + " m, must be below the sample's radius of " + words(sample / 2) + " m");
}

void read_particles(const Table& root, TextileTests& t) {
  const auto value = [](const char* key, double* target, double minimum, double maximum, const char* unit = "1") {
    return number(key, target, unit, "Property of the particles of the model.", false, minimum, maximum);
  };
  root.table("particles")
      .read({value("contact_radius_over_radius", &t.contact_radius_ratio, 1, 10),
             value("shear_modulus", &t.shear_modulus, 1, infinity, "Pa"), value("restitution", &t.restitution, 1e-6, 1),
             value("static_friction", &t.static_friction, 0, 10), value("rolling_friction", &t.rolling_friction, 0, 1),
             value("bond_damping_coefficient", &t.bond_damping, 0, 10), value("bond_rotation_friction", &t.rotation_friction, 0, 10)});
}

void read_published(const Table& root, TextileTests& t) {
  const Table published = root.table("published");
  for (const Table& table : published.tables("bond")) {
    PublishedBond line;
    std::string direction;
    double density = 0;
    BondProperties& b = line.bond;
    table.read({setting("direction", &direction, "LW or CW.", {direction_key[0], direction_key[1]}),
                number("r_p", &line.radius, "m", "Particle radius."), noted("density", &density, "kg/m3"),
                number("sigma_c_n", &b.normal_strength, "Pa", "Critical stress.", false),
                number("S_n", &b.normal_stiffness, "1", "N/m3.", false), number("S_nb", &b.bending_stiffness, "1", "N/m3.", false),
                number("S_t", &b.tangential_stiffness, "1", "N/m3.", false)});
    line.direction = direction == direction_key[1] ? 1 : 0;
    t.published.push_back(line);
  }
  // The rest of the published record is for readers.
  std::vector<double> values;
  double time = 0;
  Records records{noted("settling_time", &time, "s")};
  for (const char* key : {"area_deviation_percent", "wave_size_deviation_percent", "wave_count_range"})
    records.push_back({.key = key, .target = &values, .meaning = "For the record."});
  records.push_back({.key = "r_p", .target = &values, .unit = "m", .meaning = "For the record."});
  published.table("drape").read(records);
  for (const char* key : {"circle_210mm", "rag_area_over_pi_r2"}) published.table("particles").table(key).numbers();
}

void check_contact_radius(const std::string& file, const TextileTests& t) {
  for (int d = 0; d < 2; ++d) {
    const ContactRadiusBounds bounds = contact_radius_bounds(t.elongation[d].max_strain);
    const double ratio = t.contact_radius_ratio;
    if (ratio < bounds.low)
      throw Error(ExitCode::usage,
                  file + ": [elongation." + direction_key[d] + "] max_strain: is " + words(t.elongation[d].max_strain) +
                      ", beyond the contact radius of " + words(ratio) + " r_p, which holds bonds up to a strain of " +
                      words((ratio - 1) / 2) +
                      (bounds.low <= bounds.high
                           ? "; give [particles] contact_radius_over_radius between " + words(bounds.low) + " and " + words(bounds.high)
                           : "; a lattice holds strains up to " + words((bounds.high - 1) / 2) + ", correct the strain"));
    if (ratio > bounds.high)
      throw Error(ExitCode::usage, file + ": [particles] contact_radius_over_radius: is " + words(ratio) + ", must be at most sqrt(5) = " +
                                       words(bounds.high) + ", or particles that are no neighbours are bonded; give a smaller one");
  }
}

}  // namespace

ContactRadiusBounds contact_radius_bounds(double max_strain) { return {1 + 2 * max_strain, std::sqrt(5.0)}; }

TextileTests read_textile_tests(const std::filesystem::path& path) {
  const CaseFile file = CaseFile::read(path);
  const Table root = file.root();
  TextileTests tests;
  tests.name = path.stem().string();
  read_cloth(root, tests), read_elongation(root, tests), read_bending(root, tests), read_drape(root, tests);
  read_particles(root, tests), read_published(root, tests);
  file.reject_unread();
  check_contact_radius(path.string(), tests);
  return tests;
}

}  // namespace snag
