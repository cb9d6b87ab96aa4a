#include "base/words.hpp"

#include <gtest/gtest.h>

#include "base/parameter_text.hpp"

namespace {

using namespace snag;

// Small numbers keep their digits in messages, and are not printed as 0.000000.
TEST(Words, SmallNumbersKeepTheirDigits) {
  EXPECT_EQ(number_text(1.003e-6), "1.003e-06");
  EXPECT_EQ(number_text(0.25), "0.25");
  EXPECT_EQ(rounded(0.0012345), "0.00123");
  EXPECT_EQ(rounded(1234567), "1.23e+06");
  EXPECT_EQ(point_text({0.1, 0, -2e-7}), "(0.1, 0, -2e-07) m");
}

// Splitting keeps empty parts, so that a missing column does not go unnoticed.
TEST(Words, EmptyPartsAreKept) {
  EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string>{"a", "", "b", ""}));
  EXPECT_EQ(split("", ','), std::vector<std::string>{""});
}

// Numbered names sort in order of their numbers up to a million, and longer numbers are not cut.
TEST(Words, NumberedNamesSort) {
  EXPECT_EQ(numbered("water", 120), "water_000120");
  EXPECT_EQ(numbered("water", 1234567), "water_1234567");
  EXPECT_LT(numbered("water", 99), numbered("water", 100));
}

// Text from outside cannot become markup of a report or a VTK file.
TEST(Words, MarkupIsEscaped) { EXPECT_EQ(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;"); }

// A misspelt word finds its neighbour, a word that resembles none finds none.
TEST(Words, NearestNameIsNear) {
  EXPECT_EQ(nearest_name("gausian", {"cell", "gaussian", "wendland"}), "gaussian");
  EXPECT_EQ(nearest_name("xyz", {"cell", "gaussian"}), "");
}

// A number written to a case file reads back as the same number, and never as a whole number of another type.
TEST(ParameterText, NumbersReadBackExactly) {
  EXPECT_EQ(toml_text(1.0), "1.0");
  EXPECT_EQ(toml_text(0.1), "0.1");
  EXPECT_EQ(toml_text(1e-300), "1e-300");
  EXPECT_EQ(toml_text(-infinity), "-inf");
  std::optional<double> none;
  EXPECT_EQ(toml_text(&none), "");
  std::vector<std::string> list{"a", "b \"c\""};
  EXPECT_EQ(toml_text(&list, [](double) { return std::string(); }), R"(["a", "b \"c\""])");
}

}  // namespace
