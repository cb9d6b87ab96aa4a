// The blind benchmark's own rules: what is planned, that the truth stays sealed, what counts as a hit.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.hpp"
#include "diagnosis/score/score.hpp"
#include "diagnosis/score/sealed_set.hpp"

namespace snag {
namespace {

const std::vector<std::string> effects{"added_mass", "drag_magnitude", "lift"}, unmodelled{"periodic"}, subsets{"all", "picture"};

Truth single(const std::string& effect, double detectability = 10) {
  Truth truth;
  truth.kind = "single", truth.theta = {{effect, 0.5}}, truth.strength = 0.5, truth.detectability = detectability, truth.gap_over_floor = 3;
  return truth;
}

Verdict says(VerdictKind kind, std::vector<std::string> named, std::map<std::string, double> probability,
             Wording wording = Wording::attributed) {
  Verdict verdict;
  verdict.verdict = kind, verdict.effects = std::move(named), verdict.probability = std::move(probability), verdict.wording = wording;
  return verdict;
}

/// Requirement: sets are the same for the same seed, others for another, and of all kinds; pairs have two effects.
TEST(TwinPlan, IsDeterministicAndComplete) {
  std::map<std::string, int> kinds;
  std::set<double> strengths;
  bool differs = false;
  for (int number = 0; number < 300; ++number) {
    const Truth a = planned_set(number, 1, effects, effects, unmodelled, subsets),
                b = planned_set(number, 1, effects, effects, unmodelled, subsets);
    EXPECT_EQ(a.theta, b.theta);
    differs = differs || a.theta != planned_set(number, 2, effects, effects, unmodelled, subsets).theta;
    ++kinds[a.kind];
    if (a.kind == "single") strengths.insert(a.strength);
    EXPECT_EQ(a.theta.size(), a.kind == "single" ? 1u : a.kind == "pair" ? 2u : 0u) << a.kind;
    EXPECT_EQ(a.unmodelled.empty(), a.kind != "outside");
  }
  EXPECT_TRUE(differs);
  EXPECT_EQ(strengths, (std::set<double>{0.125, 0.25, 0.5, 1}));
  EXPECT_EQ(kinds["single"], 150);
  EXPECT_EQ(kinds["pair"], 60);
  EXPECT_EQ(kinds["outside"], 30);
  EXPECT_EQ(kinds["null"] + kinds["null_off"], 60);
  EXPECT_NEAR(kinds["null_off"], 20, 5);
}

/// Requirement: a truth is read back as it was sealed, and refused if a byte of it is another.
TEST(TwinPlan, SealHolds) {
  const auto file = std::filesystem::temp_directory_path() / "snag-sealed" / "truth.json";
  const std::string fingerprint = seal(single("lift"), file);
  EXPECT_EQ(opened(file, fingerprint).name(), "lift");
  EXPECT_EQ(opened(file, fingerprint).theta.at("lift"), 0.5);
  std::ofstream(file, std::ios::app) << " ";
  EXPECT_THROW(opened(file, fingerprint), Error);
  std::filesystem::remove_all(file.parent_path());
}

/// Requirement: a row says what was named, with which probability, and is the same after it was written and read.
TEST(TwinScore, RowOfASet) {
  const ScoreRow row =
      scored(single("lift"), says(VerdictKind::effects, {"lift"}, {{"lift", 0.7}, {"none", 0.2}, {"outside", 0.1}}, Wording::suspected),
             2.5, "abc");
  EXPECT_EQ(row.first, "lift");
  EXPECT_TRUE(row.in_first_three);
  EXPECT_NEAR(row.brier, 0.09 + 0.04 + 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(row.shrinkage));
  const ScoreRow again = score_row(score_line(row));
  EXPECT_EQ(score_line(again), score_line(row));
  EXPECT_THROW(score_row("1,2,3"), Error);
}

/// Requirement: hits, false attributions and abstentions are counted where they belong.
TEST(TwinScore, Card) {
  Truth null, other, pair = single("lift");
  null.kind = "null", other.kind = "outside", other.unmodelled = "periodic", other.detectability = 9;
  pair.kind = "pair", pair.theta["added_mass"] = 0.4;
  const std::vector<ScoreRow> rows{
      scored(single("lift"), says(VerdictKind::effects, {"lift"}, {{"lift", 0.95}, {"none", 0.05}}), 1, ""),
      scored(single("lift"), says(VerdictKind::effects, {"added_mass"}, {{"added_mass", 0.92}, {"lift", 0.08}}), 1, ""),
      scored(single("lift", 1), says(VerdictKind::none, {}, {{"none", 0.9}, {"lift", 0.1}}, Wording::no_gap), 1,
             ""),  // could not be seen: does not count
      scored(null, says(VerdictKind::none, {}, {{"none", 1.0}}, Wording::no_gap), 1, ""),
      scored(null, says(VerdictKind::effects, {"lift"}, {{"lift", 0.6}, {"none", 0.4}}, Wording::suspected), 1, ""),
      scored(other, says(VerdictKind::outside, {"lift"}, {{"outside", 0.99}, {"lift", 0.01}}, Wording::outside), 1, ""),
      scored(pair, says(VerdictKind::effects, {"lift", "added_mass"}, {{"added_mass+lift", 1.0}}), 1, ""),
      scored(pair, says(VerdictKind::effects, {"lift"}, {{"lift", 1.0}}), 1, "")};
  const ScoreCard card = score_card(rows, true);
  const auto found = [&](std::size_t i) { return std::pair{card.scores[i].hits, card.scores[i].n}; };
  EXPECT_EQ(found(0), (std::pair{1, 2}));  // named first
  EXPECT_EQ(found(1), (std::pair{2, 2}));  // among three
  EXPECT_EQ(found(2), (std::pair{0, 2}));  // attributed on null
  EXPECT_EQ(found(3), (std::pair{1, 2}));  // named on null
  EXPECT_EQ(found(4), (std::pair{1, 1}));  // outside
  EXPECT_EQ(found(5), (std::pair{0, 5}));
  EXPECT_EQ(found(6), (std::pair{1, 2}));  // pairs: both
  EXPECT_EQ(found(7), (std::pair{2, 2}));
  EXPECT_EQ(found(8), (std::pair{2, 8}));  // attributed and wrong: added_mass for lift, lift alone for the pair
  EXPECT_EQ(card.confusion.at("none").at("lift"), 1);
  EXPECT_FALSE(card.scores[0].met());
  EXPECT_TRUE(card.scores[4].met());
  for (const Score& score : score_card({}, true).scores) EXPECT_FALSE(score.met()) << score.name << " of no sets";
  ASSERT_EQ(card.measures.size(), 7u);
  EXPECT_FALSE(card.measures[0].met());  // calibration error
  EXPECT_FALSE(card.measures[2].met());  // no shrinkage was told
  EXPECT_FALSE(card.measures[4].met());  // too few sets for a limit of detection
}

}  // namespace
}  // namespace snag
