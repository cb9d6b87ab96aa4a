#pragma once
// What a laboratory measured on a cloth: the file that `snag calibrate` reads. Directions: 0 lengthwise (LW), 1 crosswise (CW).
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

inline constexpr std::array<const char*, 2> direction_key{"LW", "CW"};
inline constexpr std::array<const char*, 2> direction_name{"lengthwise", "crosswise"};

/// Smallest and largest of the repetitions; both zero if not given.
struct MeasuredRange {
  double low = 0, high = 0;
  bool given() const { return high > 0; }
};

struct ElongationResult {
  double max_force = 0;  // N, mean of the repetitions
  MeasuredRange force_range;
  double max_strain = 0;  // at the largest force
  int repetitions = 0;
};

struct BendingResult {
  double overhang = 0;  // m, mean
  MeasuredRange overhang_range;
  double mass_per_area = 0;  // kg/m2, of the strip as it was tested
  int repetitions = 0;
};

struct DrapeResult {
  double sample_diameter = 0.210, disc_diameter = 0.100;  // m
  double mass_per_area = 0;                               // kg/m2
  double area = 0;                                        // m2, seen from above, mean
  double wave_size = 0;                                   // m, from the centre to the outline at the peaks, mean
  MeasuredRange wave_size_range;
  double wave_count = 0;  // mean
  int repetitions = 0;
};

/// A line of a published calibration, for comparison.
struct PublishedBond {
  int direction = 0;
  double radius = 0;  // m
  BondProperties bond;
};

struct TextileTests {
  std::string name;                          // of the cloth
  std::string source;                        // of the measurements
  double length = 0, width = 0;              // of the cloth, m
  double thickness = 0;                      // m
  double clamp_width = 0, gauge_length = 0;  // of the elongation test, m
  double elongation_density = 0;             // of the wet cloth in that test, kg/m3
  std::array<ElongationResult, 2> elongation;
  double plane_angle = 0;  // of the bending test, rad
  std::array<BendingResult, 2> bending;
  DrapeResult drape;
  // particles
  double contact_radius_ratio = 2.2;  // r_c/r_p
  double shear_modulus = 1e6;         // Pa
  double restitution = 0.01, static_friction = 0.5, rolling_friction = 0.01;
  double bond_damping = 0.5, rotation_friction = 0.001;
  std::vector<PublishedBond> published;
};

/// Reads and checks the file. Throws Error(usage, io) that names file, key, value and rule.
TextileTests read_textile_tests(const std::filesystem::path& file);
TextileTests read_textile_tests(const CaseFile& file);
/// Tables of that file, for the manual.
std::vector<Section> textile_tests_sections();

/// Smallest and largest contact radius over r_p that lets a bond stretch to `max_strain` and still leaves the lattice without bonds
/// between particles that are no neighbours: 1 + 2 strain and sqrt(5), Jensen (2018) Eqs. 3.21, 3.22.
struct ContactRadiusBounds {
  double low = 0, high = 0;
};
ContactRadiusBounds contact_radius_bounds(double max_strain);

}  // namespace snag
