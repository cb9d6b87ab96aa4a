#include "base/units.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"

using namespace snag;

// Units of the texts that users write reach the program in SI.
TEST(Units, ConvertToSi) {
  EXPECT_DOUBLE_EQ(quantity("12 mm", "m", "k"), 0.012);
  EXPECT_DOUBLE_EQ(quantity("1200 rpm", "rad/s", "k"), 1200 * 2 * std::numbers::pi / 60);
  EXPECT_DOUBLE_EQ(quantity("26.8 L/s", "m3/s", "k"), 0.0268);
  EXPECT_DOUBLE_EQ(quantity("96.48 m3/h", "m3/s", "k"), 96.48 / 3600);
  EXPECT_DOUBLE_EQ(quantity("9.81 m/s^2", "m/s2", "k"), 9.81);
  EXPECT_DOUBLE_EQ(quantity("1.2e3 kg m-3", "kg/m3", "k"), 1200);
  EXPECT_DOUBLE_EQ(quantity("45 deg", "rad", "k"), std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(quantity("3 N m", "N m", "k"), 3);
  EXPECT_DOUBLE_EQ(quantity("5 %", "1", "k"), 0.05);
  EXPECT_DOUBLE_EQ(quantity("2 kg/(m3 s)", "kg/(m3 s)", "k"), 2);
}

// A wrong dimension, an unknown unit or no unit at all is refused.
TEST(Units, RefuseWrongDimension) {
  for (const char* text : {"12 s", "12", "12 furlong", "mm", "nan m", "1/2/3 m", ""}) EXPECT_THROW(quantity(text, "m", "k"), Error) << text;
}

// The unit in a key and the unit of a record are two spellings of the same.
TEST(Units, SuffixesAreInverse) {
  for (const char* unit : {"kg/m3", "m/s2", "1/s", "m2/s", "N/m3", "rad/s", "Pa", "m", "kg/(m3 s)", "N s/m"}) {
    const auto there = parse_unit(unit), back = parse_unit(unit_of_suffix(suffix_of_unit(unit)));
    ASSERT_TRUE(there && back) << unit;
    if (std::string(unit) != "N s/m") {
      EXPECT_EQ(there->exponents, back->exponents) << unit << " -> " << suffix_of_unit(unit);
    }
  }
  EXPECT_EQ(suffix_of_unit("1"), "");
  EXPECT_EQ(unit_of_suffix("per_s"), "1/s");
}
