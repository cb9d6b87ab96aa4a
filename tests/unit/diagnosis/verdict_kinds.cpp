// Requirement: each kind of verdict and each wording has the word that verdict.json and scores.csv have always held, and is found by it.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "diagnosis/data/verdict.hpp"
#include "diagnosis/score/score.hpp"

namespace snag {
namespace {

TEST(VerdictKinds, WordsOfFiles) {
  EXPECT_STREQ(word(VerdictKind::none), "none");
  EXPECT_STREQ(word(VerdictKind::effects), "effects");
  EXPECT_STREQ(word(VerdictKind::outside), "outside");
  EXPECT_STREQ(word(VerdictKind::tie), "tie");
  EXPECT_STREQ(word(VerdictKind::blind), "blind");
  EXPECT_STREQ(word(Wording::no_gap), "no gap beyond u_val");
  EXPECT_STREQ(word(Wording::blind), "blind");
  EXPECT_STREQ(word(CellTest::energy_distance), "energy_distance");
  EXPECT_STREQ(word(GapOrigin::undecided), "undecided");
  for (const char* text : verdict_kind_words) EXPECT_STREQ(word(verdict_named(text).value()), text);
  for (const char* text : wording_words) EXPECT_STREQ(word(wording_named(text).value()), text);
  EXPECT_FALSE(verdict_named("effect"));
}

TEST(VerdictKinds, RowOfScores) {
  ScoreRow row;
  row.verdict = VerdictKind::tie, row.wording = Wording::undecided;
  const ScoreRow again = score_row(score_line(row));
  EXPECT_EQ(again.verdict, VerdictKind::tie);
  EXPECT_EQ(again.wording, Wording::undecided);
  std::string line = score_line(row);
  line.replace(line.find("tie"), 3, "tied");
  try {
    score_row(line);
    FAIL() << "an unknown verdict was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"tied\" is not a verdict; known: none"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace snag
