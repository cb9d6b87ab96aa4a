#include "textile/textile_tests.hpp"

#include <cmath>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

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
Parameter noted(const char* key, ParameterTarget target, const char* unit, const std::string& meaning) {
  return {.key = key, .target = target, .unit = unit, .minimum = 0, .basis = Basis::measured, .meaning = meaning + " For the record only."};
}

Parameter count(int* target) {
  return {.key = "repetitions", .target = target, .minimum = 1, .basis = Basis::measured, .meaning = "Number of samples."};
}

Parameter range_of(const char* key, std::vector<double>* target, const char* unit) {
  return {.key = key,
          .target = target,
          .unit = unit,
          .minimum = tiny,
          .basis = Basis::measured,
          .meaning = "Smallest and largest value of the samples; the mean lies between them."};
}

/// The smallest and the largest value, between which `mean` must lie.
MeasuredRange checked_range(const Table& table, const Parameter& range, double mean) {
  const std::vector<double>& values = *std::get<std::vector<double>*>(range.target);
  if (values.empty()) return {};
  if (values.size() != 2 || values[0] > mean || mean > values[1])
    throw Error(ExitCode::usage, table.where() + " " + range.key + ": must be a range about the mean of " + number_text(mean) + " " +
                                     range.unit + "; give [smallest, largest]");
  return {values[0], values[1]};
}

Table direction_of(const Table& test, int direction) {
  Table table = test.table(direction_key[direction]);
  if (!table.present())
    throw Error(ExitCode::usage, test.where() + ": the test " + direction_name[direction] +
                                     " is missing; both directions are needed, add the table of " + direction_key[direction] +
                                     " with what was measured");
  return table;
}

struct ClothTable {
  double dry_mass = 0;

  Section section(TextileTests& t) {
    return {
        "rag",
        "The cloth.",
        {setting("name", &t.name, "Name of the cloth; by default that of the file."),
         setting("source", &t.source, "Source of the measurements."), number("length_lw", &t.length, "m", "Side of the cloth lengthwise."),
         number("length_cw", &t.width, "m", "Side of the cloth crosswise."),
         number("thickness", &t.thickness, "m", "Thickness of the cloth."),
         noted("dry_mass_per_area", &dry_mass, "kg/m2", "Mass of the dry cloth per area.")}};
  }
};

struct ElongationTable {
  double rate = 0;

  Section section(TextileTests& t) {
    return {"elongation",
            "The elongation test (grab test): two clamps pull a wet sample apart.",
            {number("clamp_width", &t.clamp_width, "m", "Width of cloth that the clamps grip."),
             number("gauge_length", &t.gauge_length, "m", "Distance of the clamps at the start."),
             noted("rate", &rate, "m/s", "Speed of the moving clamp."),
             number("wet_density", &t.elongation_density, "kg/m3", "Mass of the wet cloth per area over its thickness.")}};
  }
};

struct ElongationDirection {
  ElongationResult result;
  double elongation = 0;
  std::vector<double> force_range;

  Section section(int direction) {
    return {std::string("elongation.") + direction_key[direction],
            std::string("Results of the elongation test ") + direction_name[direction] + ".",
            {number("max_force_mean", &result.max_force, "N", "Largest force, mean of the samples."),
             range_of("max_force_range", &force_range, "N"),
             number("max_strain", &result.max_strain, "1", "Elongation over gauge length at the largest force, mean of the samples."),
             number("max_elongation", &elongation, "m", "max_strain times gauge_length, as a check of both; 0: no check.", false, 0),
             count(&result.repetitions)}};
  }
};

struct BendingTable {
  double width = 0, length = 0, density = 0;

  Section section(TextileTests& t) {
    return {"bending",
            "The bending test (DIN 53362): a wet strip is pushed over an edge until its tip touches an inclined plane.",
            {{.key = "plane_angle",
              .target = &t.plane_angle,
              .unit = "rad",
              .minimum = 0.05,
              .maximum = 1.5,
              .basis = Basis::measured,
              .meaning = "Angle of the plane below the horizontal.",
              .required = true},
             noted("strip_width", &width, "m", "Width of the strip."),
             number("strip_total_length", &length, "m", "Length of the strip, which the overhang cannot exceed; 0: no check.", false, 0),
             noted("wet_density", &density, "kg/m3", "Density of the wet cloth.")}};
  }
};

struct BendingDirection {
  BendingResult result;
  std::vector<double> overhang_range;

  Section section(int direction) {
    return {
        std::string("bending.") + direction_key[direction],
        std::string("Results of the bending test ") + direction_name[direction] + ".",
        {number("overhang_mean", &result.overhang, "m", "Length over the edge at which the tip touches the plane, mean of the samples."),
         range_of("overhang_range", &overhang_range, "m"),
         number("mass_per_area", &result.mass_per_area, "kg/m2", "Mass of the tested strip per area.", true, lightest, heaviest),
         count(&result.repetitions)}};
  }
};

struct DrapeTable {
  DrapeResult result;
  double density = 0;
  std::vector<double> wave_size_range;

  Section section() {
    DrapeResult& r = result;
    return {"drape",
            "The drape test (like ISO 9073-9): a round wet sample hangs over a smaller disc and forms waves.",
            {number("sample_diameter", &r.sample_diameter, "m", "Diameter of the round sample."),
             number("disc_diameter", &r.disc_diameter, "m", "Diameter of the disc below the sample."),
             number("mass_per_area", &r.mass_per_area, "kg/m2", "Mass of the tested sample per area.", true, lightest, heaviest),
             number("area_mean", &r.area, "m2", "Area of the draped sample seen from above, mean of the samples."),
             number("wave_size_mean", &r.wave_size, "m", "Distance from the centre to the outline at its peaks, mean of the samples."),
             range_of("wave_size_range", &wave_size_range, "m"),
             number("wave_count_mean", &r.wave_count, "1", "Number of peaks of the outline, mean of the samples.", true, 1, 100),
             noted("wet_density", &density, "kg/m3", "Density of the wet cloth."), count(&r.repetitions)}};
  }
};

Section particles_section(TextileTests& t) {
  const auto value = [](const char* key, double* target, double minimum, double maximum, const char* meaning, const char* unit = "1") {
    Parameter parameter = number(key, target, unit, meaning, false, minimum, maximum);
    parameter.basis = Basis::literature;
    return parameter;
  };
  return {"particles",
          "Properties of the particles of the model; they go into the passport as they are.",
          {value("contact_radius_over_radius", &t.contact_radius_ratio, 1, 10, "Contact radius over particle radius."),
           value("shear_modulus", &t.shear_modulus, 1, infinity, "Shear modulus of the contacts.", "Pa"),
           value("restitution", &t.restitution, 1e-6, 1, "Coefficient of restitution."),
           value("static_friction", &t.static_friction, 0, 10, "Coefficient of static friction."),
           value("rolling_friction", &t.rolling_friction, 0, 1, "Coefficient of rolling friction between particles."),
           value("bond_damping_coefficient", &t.bond_damping, 0, 10, "c_d: damping ratio of the shortest wave along a row of bonds."),
           value("bond_rotation_friction", &t.rotation_friction, 0, 10,
                 "c_r: moment against relative rotation of bonded particles over normal bond force and radius.")}};
}

struct PublishedBondTable {
  PublishedBond line;
  std::string direction = direction_key[0];
  double density = 0;

  Section section() {
    BondProperties& b = line.bond;
    return {"published.bond",
            "Bond properties that others found for this cloth; `calibration.html` compares them with the result.",
            {setting("direction", &direction, "Direction of the cloth: lengthwise (LW) or crosswise (CW).",
                     {direction_key[0], direction_key[1]}),
             number("r_p", &line.radius, "m", "Particle radius."),
             noted("density", &density, "kg/m3", "Density of the particles in the bending simulation."),
             number("sigma_c_n", &b.normal_strength, "Pa", "Critical normal stress of a bond.", false, 0),
             number("S_n", &b.normal_stiffness, "1", "Normal stiffness per area, N/m3.", false, 0),
             number("S_nb", &b.bending_stiffness, "1", "Bending stiffness per area, N/m3.", false, 0),
             number("S_t", &b.tangential_stiffness, "1", "Tangential stiffness per area, N/m3.", false, 0)},
            true};
  }
};

struct PublishedDrapeTable {
  double settling_time = 0;
  std::vector<double> radii, area_deviation, wave_size_deviation, wave_counts;

  Section section() {
    const auto deviation = [](const char* key, std::vector<double>* target, const char* meaning) {
      Parameter parameter = noted(key, target, "1", meaning);
      parameter.minimum = -infinity;
      return parameter;
    };
    return {"published.drape",
            "Deviation of drape simulations that others published, for readers of the file.",
            {noted("r_p", &radii, "m", "Particle radii."),
             deviation("area_deviation_percent", &area_deviation, "Deviation of the area at each radius, percent."),
             deviation("wave_size_deviation_percent", &wave_size_deviation, "Deviation of the wave size at each radius, percent."),
             noted("wave_count_range", &wave_counts, "1", "Smallest and largest number of waves."),
             noted("settling_time", &settling_time, "s", "Time until the simulated sample was at rest.")}};
  }
};

void read_elongation(const Table& root, TextileTests& t) {
  const Table test = root.table("elongation");
  test.read(ElongationTable().section(t).parameters);
  for (int d = 0; d < 2; ++d) {
    const Table table = direction_of(test, d);
    ElongationDirection keys;
    ElongationResult& r = keys.result;
    table.read(keys.section(d).parameters);
    r.force_range = checked_range(table, range_of("max_force_range", &keys.force_range, "N"), r.max_force);
    constexpr double rounding = 0.01;  // of a table
    if (keys.elongation > 0 && std::abs(keys.elongation / t.gauge_length / r.max_strain - 1) > rounding)
      throw Error(ExitCode::usage, table.where() + " max_elongation: is " + number_text(keys.elongation) + " m, but max_strain of " +
                                       number_text(r.max_strain) + " on a gauge length of " + number_text(t.gauge_length) + " m is " +
                                       number_text(r.max_strain * t.gauge_length) + " m; correct one of them");
    t.elongation[d] = r;
  }
}

void read_bending(const Table& root, TextileTests& t) {
  const Table test = root.table("bending");
  BendingTable procedure;
  test.read(procedure.section(t).parameters);
  for (int d = 0; d < 2; ++d) {
    const Table table = direction_of(test, d);
    BendingDirection keys;
    BendingResult& r = keys.result;
    table.read(keys.section(d).parameters);
    r.overhang_range = checked_range(table, range_of("overhang_range", &keys.overhang_range, "m"), r.overhang);
    if (procedure.length > 0 && r.overhang > procedure.length)
      throw Error(ExitCode::usage, table.where() + " overhang_mean: is " + number_text(r.overhang) + " m, longer than the strip of " +
                                       number_text(procedure.length) + " m: the rag cannot reach the plane; correct one of them");
    t.bending[d] = r;
  }
}

void read_drape(const Table& root, TextileTests& t) {
  const Table test = root.table("drape");
  DrapeTable keys;
  DrapeResult& r = keys.result;
  test.read(keys.section().parameters);
  r.wave_size_range = checked_range(test, range_of("wave_size_range", &keys.wave_size_range, "m"), r.wave_size);
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, test.where() + " " + what); };
  const double disc = r.disc_diameter, sample = r.sample_diameter;
  if (disc >= sample)
    refuse("disc_diameter: is " + number_text(disc) + " m, must be smaller than the sample of " + number_text(sample) + " m");
  constexpr double quarter_pi = 0.785398163397448;
  if (r.area < quarter_pi * disc * disc || r.area > quarter_pi * sample * sample)
    refuse("area_mean: is " + number_text(r.area) + " m2, must lie between that of the disc and of the flat sample, " +
           number_text(quarter_pi * disc * disc) + " and " + number_text(quarter_pi * sample * sample) + " m2");
  if (r.wave_size > sample / 2)
    refuse("wave_size_mean: is " + number_text(r.wave_size) + " m, must be below the sample's radius of " + number_text(sample / 2) + " m");
  t.drape = r;
}

void read_published(const Table& root, TextileTests& t) {
  const Table published = root.table("published");
  for (const Table& table : published.tables("bond")) {
    PublishedBondTable keys;
    table.read(keys.section().parameters);
    keys.line.direction = keys.direction == direction_key[1] ? 1 : 0;
    t.published.push_back(keys.line);
  }
  PublishedDrapeTable drape;
  published.table("drape").read(drape.section().parameters);
}

/// The thickness against the weighed samples, which may be wetter or drier than the cloth of the elongation test.
void check_thickness(const std::string& file, const TextileTests& t) {
  constexpr double alike = 5;
  const double of_thickness = t.thickness * t.elongation_density;
  const double weighed = (t.bending[0].mass_per_area + t.bending[1].mass_per_area + t.drape.mass_per_area) / 3;
  if (std::max(of_thickness / weighed, weighed / of_thickness) > alike)
    throw Error(ExitCode::usage, file + ": [rag] thickness: is " + number_text(t.thickness) +
                                     " m, which with [elongation] wet_density makes " + number_text(of_thickness) +
                                     " kg/m2, but the samples of [bending] and [drape] have " + number_text(weighed) +
                                     " kg/m2 on average; correct the thickness, or its unit");
}

void check_contact_radius(const std::string& file, const TextileTests& t) {
  for (int d = 0; d < 2; ++d) {
    const ContactRadiusBounds bounds = contact_radius_bounds(t.elongation[d].max_strain);
    const double ratio = t.contact_radius_ratio;
    if (ratio < bounds.low)
      throw Error(
          ExitCode::usage,
          file + ": [elongation." + direction_key[d] + "] max_strain: is " + number_text(t.elongation[d].max_strain) +
              ", beyond the contact radius of " + number_text(ratio) + " r_p, with which bonds reach a strain of " +
              number_text((ratio - 1) / 2) +
              (bounds.low <= bounds.high
                   ? "; give [particles] contact_radius_over_radius between " + number_text(bounds.low) + " and " + number_text(bounds.high)
                   : "; a lattice allows strains up to " + number_text((bounds.high - 1) / 2) + ", correct the strain"));
    if (ratio > bounds.high)
      throw Error(ExitCode::usage, file + ": [particles] contact_radius_over_radius: is " + number_text(ratio) +
                                       ", must be at most sqrt(5) = " + number_text(bounds.high) +
                                       ", or particles that are no neighbours are bonded; give a smaller one");
  }
}

}  // namespace

ContactRadiusBounds contact_radius_bounds(double max_strain) { return {1 + 2 * max_strain, std::sqrt(5.0)}; }

std::vector<Section> textile_tests_sections() {
  // The records point into these.
  static TextileTests tests;
  static ClothTable cloth;
  static ElongationTable elongation;
  static ElongationDirection elongations[2];
  static BendingTable bending;
  static BendingDirection bendings[2];
  static DrapeTable drape;
  static PublishedBondTable bond;
  static PublishedDrapeTable published_drape;
  std::vector<Section> all{cloth.section(tests), elongation.section(tests)};
  for (int d = 0; d < 2; ++d) all.push_back(elongations[d].section(d));
  all.push_back(bending.section(tests));
  for (int d = 0; d < 2; ++d) all.push_back(bendings[d].section(d));
  for (Section section : {drape.section(), particles_section(tests), bond.section(), published_drape.section()})
    all.push_back(std::move(section));
  return all;
}

TextileTests read_textile_tests(const CaseFile& file) {
  const Table root = file.root();
  TextileTests tests;
  tests.name = file.file().stem().string();
  root.table("rag").read(ClothTable().section(tests).parameters);
  read_elongation(root, tests), read_bending(root, tests), read_drape(root, tests);
  root.table("particles").read(particles_section(tests).parameters);
  read_published(root, tests);
  file.reject_unread();
  check_thickness(file.file().string(), tests);
  check_contact_radius(file.file().string(), tests);
  return tests;
}

TextileTests read_textile_tests(const std::filesystem::path& path) { return read_textile_tests(CaseFile::read(path)); }

}  // namespace snag
