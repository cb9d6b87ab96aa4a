// Reading tests of a cloth, stiffness from the elongation test, textile passports.
#include "textile/calibration.hpp"
#include "tests/sources.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "dem/templates/passport.hpp"
#include "dem/templates/rag_settings.hpp"
#include "tests/keys_of_sections.hpp"
#include "textile/passport_text.hpp"

namespace snag {
namespace {

TextileTests aro() { return read_textile_tests(in_sources("cases/textile-aro/tests.toml")); }

/// To three digits, as a table prints it.
double printed(double value) {
  const double scale = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / scale) * scale;
}

TEST(Calibration, ClampsCountedTwiceGiveThePublishedTables) {
  // Requirement: S_n and the critical stress of Jensen (2018) Tables 3.3 and 3.4 to the printed digits, for 1.0, 1.5 and 2.0 mm.
  const TextileTests tests = aro();
  ASSERT_EQ(tests.published.size(), 6u);
  for (const PublishedBond& line : tests.published) {
    const BondProperties bond = elongation_bond(tests, line.direction, line.radius, true);
    EXPECT_NEAR(printed(bond.normal_stiffness), line.bond.normal_stiffness, 1e-6 * line.bond.normal_stiffness);
    EXPECT_NEAR(printed(bond.normal_strength), line.bond.normal_strength, 1e-6 * line.bond.normal_strength);
  }
}

TEST(Calibration, ClampsCountedOnceGiveTwiceThat) {
  // Requirement: by default the bonds of one clamp's width carry the measured force at the measured strain.
  const TextileTests tests = aro();
  for (int d = 0; d < 2; ++d) {
    const double r = 1.3e-3, area = M_PI * r * r, n = 0.1 / (2 * r);
    const BondProperties bond = elongation_bond(tests, d, r, false);
    EXPECT_NEAR(bond.normal_strength * area * n / tests.elongation[d].max_force, 1, 1e-12);
    EXPECT_NEAR(bond.normal_stiffness * area * 2 * r * tests.elongation[d].max_strain * n / tests.elongation[d].max_force, 1, 1e-12);
  }
}

TEST(Calibration, ContactRadiusHoldsTheStrainOfTheTests) {
  // Requirement: Jensen (2018) Eqs. 3.21, 3.22: 1.72 and sqrt(5) for a strain of 0.358.
  const ContactRadiusBounds bounds = contact_radius_bounds(0.358);
  EXPECT_NEAR(bounds.low, 1.716, 1e-12);
  EXPECT_NEAR(bounds.high, 2.236068, 1e-6);
}

struct PassportFile {
  explicit PassportFile(const std::string& text) : path(std::filesystem::temp_directory_path() / "snag_passport_test.toml") {
    std::ofstream(path) << text;
  }
  ~PassportFile() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

std::string bond(const std::string& radius, const std::string& direction, const std::string& stiffness) {
  return "[[bond]]\nradius_mm = " + radius + "\ndirection = \"" + direction + "\"\nnormal_stiffness_N_m3 = " + stiffness +
         "\ntangential_stiffness_N_m3 = 1e6\nbending_stiffness_N_m3 = 2e6\nnormal_strength_Pa = 3e5\n";
}

TEST(Passport, IsInterpolatedInTheLogarithms) {
  // Requirement: as it stands at its radii, straight lines in the logarithms between, an error that names the radii outside.
  const PassportFile file(bond("2.0", "LW", "1e8") + bond("1.0", "CW", "3e8") + bond("1.0", "LW", "4e8") + bond("2.0", "CW", "3e8"));
  const Passport passport = read_passport(file.path);
  EXPECT_EQ(passport.bond(1e-3, 0).normal_stiffness, 4e8);
  EXPECT_EQ(passport.bond(2e-3, 0).normal_stiffness, 1e8);
  EXPECT_NEAR(passport.bond(1.5e-3, 0).normal_stiffness, 4e8 / 2.25, 1);
  EXPECT_EQ(passport.bond(1.5e-3, 1).normal_stiffness, 3e8);
  try {
    passport.bond(2.5e-3, 0);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("1, 2 mm"), std::string::npos) << error.what();
  }
}

TEST(Passport, GivesARagItsBonds) {
  // Requirement: [[rag]] passport sets the bonds; together with given ones it is refused.
  const PassportFile file(bond("1.5", "LW", "1e8") + bond("1.5", "CW", "2e8"));
  const auto piece_of = [&](const std::string& more) {
    const CaseFile text =
        CaseFile::parse("[[rag]]\nlength_mm = 30\nwidth_mm = 30\nradius_mm = 1.5\npassport = \"" + file.path.string() + "\"\n" + more);
    return read_pieces(text).at(0);
  };
  EXPECT_EQ(piece_of("").rag.bond[0].normal_stiffness, 1e8);
  EXPECT_EQ(piece_of("").rag.bond[1].normal_stiffness, 2e8);
  EXPECT_EQ(piece_of("").rag.bond[1].normal_strength, 3e5);
  EXPECT_THROW(piece_of("properties = \"custom\"\nnormal_stiffness_lengthwise_N_m3 = 1\nnormal_stiffness_crosswise_N_m3 = 1\n"), Error);
}

TEST(Passport, LacksNoDirection) {
  // Requirement: a radius with one direction only is refused, and so is one that stands twice.
  EXPECT_THROW(read_passport(PassportFile(bond("1.5", "LW", "1e8")).path), Error);
  EXPECT_THROW(read_passport(PassportFile(bond("1.5", "LW", "1e8") + bond("1.5", "LW", "1e8") + bond("1.5", "CW", "1e8")).path), Error);
  EXPECT_THROW(read_passport(PassportFile("[textile]\nname = \"none\"\n").path), Error);
}

TEST(Passport, OfACalibrationReadsBack) {
  // Requirement: what the calibration writes is what a case reads, to the digits written.
  Calibration c;
  c.settings.radius = 1.5e-3;
  c.bond = {BondProperties{1e8, 2e5, 3e6, 4e5, 0}, BondProperties{5e7, 2e5, 6e5, 7e4, 0}};
  c.drapes = {{}};
  c.drapes[0].samples = {{1, {}, {}}};
  const TextileTests tests = aro();
  const PassportFile file(passport_text(tests, {c}, "tests.toml", {"pictures/a.svg"}));
  const Passport passport = read_passport(file.path);
  EXPECT_EQ(passport.bond(1.5e-3, 0).bending_stiffness, 3e6);
  EXPECT_EQ(passport.bond(1.5e-3, 1).normal_strength, 7e4);
}

TEST(Calibration, EveryKeyOfTheTestsIsInTheManual) {
  // Requirement: what the reader reads, the manual has; a key of its own would be read and nowhere explained.
  const CaseFile file = CaseFile::read(in_sources("cases/textile-aro/tests.toml"));
  read_textile_tests(file);
  EXPECT_EQ(keys_without_section(file, textile_tests_sections()), std::vector<std::string>{});
  EXPECT_FALSE(keys_without_section(file, {}).empty());
}

}  // namespace
}  // namespace snag
