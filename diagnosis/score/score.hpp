#pragma once
// Scores of the blind benchmark: one row a set, and the card of all rows.
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/score/sealed_set.hpp"

namespace snag {

/// Verdict on one set and its truth.
struct ScoreRow {
  int number = 0, replicates = 1, runs = 0;
  std::string kind, truth, subset, named;  // named: the effects of the verdict, "a+b"
  VerdictKind verdict = VerdictKind::none;
  Wording wording = Wording::no_gap;
  double strength = 0, detectability = 0, gap_over_floor = 0;
  std::string first;  // most probable hypothesis
  double p_first = 0, p_truth = 0, brier = 0;
  bool in_first_three = false;                                  // the truth among the three most probable
  double shrinkage = 0, shrinkage_low = 0, shrinkage_high = 0;  // of the effects named; nan if not computable
  double seconds = 0;
  std::string truth_sha256;
};

ScoreRow scored(const Truth& truth, const Verdict& verdict, double seconds, const std::string& truth_sha256);

/// Header and line of the file of rows; reading gives the same row.
std::string score_header();
std::string score_line(const ScoreRow& row);
/// Throws Error(io) on a line that is none.
ScoreRow score_row(const std::string& line);

/// A share with its 95 % interval (Clopper-Pearson), with its target.
struct Score {
  std::string name, target;
  int hits = 0, n = 0;
  std::array<double, 2> interval{0, 1};
  bool at_least = true;  // the target is a least share; false: a largest one
  double limit = 0;
  bool met() const;  // of the share itself; of no sets: false
  double share() const;
};

/// A number that is not a fraction of sets, with its target.
struct Measure {
  std::string name, target;
  double value = 0, least = 0, largest = 0;  // the value; the range of the target
  int n = 0;                                 // sets it stands on
  bool met() const { return n > 0 && value >= least && value <= largest; }
};

/// What all rows say.
struct ScoreCard {
  std::vector<Score> scores;
  std::vector<Measure> measures;  // of the numbers below
  double ece = 0, brier = 0;      // expected calibration error of the first probability (10 bins); mean Brier score
  double ece_by_chance = 0;       // mean calibration error if each first hypothesis is right as often as its probability says
  double shrinkage_median = 0;    // of right verdicts, over the ideal: a model that is the truth leaves the noise only, which is 1
  double interval_coverage = 0;   // share of their 95 % intervals that hold the ideal
  double detection_limit = 0;     // gap over floor from which P(hit) >= 0.8 by a logistic curve; inf: nowhere
  std::map<std::string, std::map<std::string, int>> confusion;  // truth -> said -> sets
  struct Bin {
    double stated = 0, right = 0;  // means
    int n = 0;
  };
  std::vector<Bin> reliability;
};
/// `sphere`: with the targets of the sphere; those of fibre and rag are lower.
ScoreCard score_card(const std::vector<ScoreRow>& rows, bool sphere);
std::string score_json(const ScoreCard& card);

}  // namespace snag
