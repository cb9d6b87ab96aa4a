#include "textile/passport_text.hpp"

#include <algorithm>
#include <cstdio>

#include "base/parameter_text.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

std::string line(const std::string& key, double value) { return key + " = " + number_text(value) + "\n"; }

std::string range(const std::string& key, const MeasuredRange& range) {
  return range.given() ? key + " = [" + number_text(range.low) + ", " + number_text(range.high) + "]\n" : "";
}

/// What the scatter of a measured force makes of a property in proportion to it.
MeasuredRange scaled(const ElongationResult& measured, double value) {
  if (!measured.force_range.given()) return {};
  return {value * measured.force_range.low / measured.max_force, value * measured.force_range.high / measured.max_force};
}

std::string bond_text(const TextileTests& tests, const Calibration& c, int d) {
  const BondProperties& bond = c.bond[d];
  std::string text =
      "\n[[bond]]\n" + line("radius_m", c.settings.radius) + "direction = " + toml_text(std::string(direction_key[d])) + "\n";
  text += line("normal_stiffness_N_m3", bond.normal_stiffness) +
          range("normal_stiffness_range_N_m3", scaled(tests.elongation[d], bond.normal_stiffness));
  text += line("tangential_stiffness_N_m3", bond.tangential_stiffness) + range("tangential_stiffness_range_N_m3", c.tangential_range);
  text += line("bending_stiffness_N_m3", bond.bending_stiffness) + range("bending_stiffness_range_N_m3", c.bending[d].stiffness);
  text += line("normal_strength_Pa", bond.normal_strength) +
          range("normal_strength_range_Pa", scaled(tests.elongation[d], bond.normal_strength));
  return text;
}

/// The tests as simulated with the bonds that were found.
std::string check_text(const TextileTests& tests, const Calibration& c, int d) {
  const ElongationResult& measured = tests.elongation[d];
  return "\n[[check]]\n" + line("radius_m", c.settings.radius) + "direction = " + toml_text(std::string(direction_key[d])) + "\n" +
         line("grab_force_N", c.grab[d].max_force) + line("grab_force_deviation", c.grab[d].max_force / measured.max_force - 1) +
         line("grab_strain_deviation", c.grab[d].strain_at_max / measured.max_strain - 1) + line("tip_above_plane_m", c.bending[d].height);
}

std::string drape_text(const TextileTests& tests, const Calibration& c) {
  const DrapePoint& drape = c.drapes[c.chosen];
  std::size_t fewest = drape.samples[0].outline.waves.size(), most = fewest;
  for (const DrapeSample& s : drape.samples)
    fewest = std::min(fewest, s.outline.waves.size()), most = std::max(most, s.outline.waves.size());
  return "\n[[drape]]\n" + line("radius_m", c.settings.radius) + line("area_m2", drape.area) +
         line("area_deviation", drape.area / tests.drape.area - 1) + line("area_spread_m2", drape.area_spread) +
         line("wave_size_m", drape.wave_size) + line("wave_size_deviation", drape.wave_size / tests.drape.wave_size - 1) +
         line("wave_size_spread_m", drape.wave_size_spread) + line("waves", drape.wave_count) + "waves_range = [" + std::to_string(fewest) +
         ", " + std::to_string(most) + "]\n" + line("seeds", static_cast<double>(drape.samples.size()));
}

}  // namespace

std::string passport_text(const TextileTests& tests, const std::vector<Calibration>& calibrations, const std::string& tests_file,
                          const std::vector<std::string>& pictures) {
  std::string text =
      "# Textile passport by snag calibrate: bonds of this cloth for each particle radius, per unit area of the bond (pi r_p^2).\n"
      "# A range is what the scatter of the tests leaves open; that of the tangential stiffness is what the drape accepts of those tried.\n"
      "[textile]\n";
  text += "name = " + toml_text(tests.name) + "\nsource = " + toml_text(tests.source) + "\ntests = " + toml_text(tests_file) + "\n";
  text +=
      std::string("clamps = ") + (calibrations[0].settings.as_published ? "\"counted twice, as published\"" : "\"counted once\"") + "\n";
  text += line("thickness_m", tests.thickness) + line("contact_radius_over_radius", tests.contact_radius_ratio);
  std::string list;
  for (const std::string& picture : pictures) list += (list.empty() ? "" : ", ") + toml_text(picture);
  text += "pictures = [" + list + "]\n";
  for (const Calibration& c : calibrations)
    text += bond_text(tests, c, 0) + bond_text(tests, c, 1) + check_text(tests, c, 0) + check_text(tests, c, 1) + drape_text(tests, c);
  return text;
}

}  // namespace snag
