#include "diagnosis/score/score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string named_effects(const Verdict& verdict) {
  std::vector<std::string> effects = verdict.effects;
  std::sort(effects.begin(), effects.end());
  std::string all;
  for (const std::string& effect : effects) all += (all.empty() ? "" : "+") + effect;
  return all;
}

/// What the verdict comes to: the effects it names, or its own word.
std::string said(const ScoreRow& row) { return row.verdict == VerdictKind::effects ? row.named : word(row.verdict); }

bool hit(const ScoreRow& row) { return said(row) == row.truth; }

bool names_one_of(const ScoreRow& row) {
  if (row.verdict != VerdictKind::effects) return false;
  const auto named = split(row.named, '+'), truth = split(row.truth, '+');
  return std::any_of(named.begin(), named.end(), [&](const auto& n) { return std::find(truth.begin(), truth.end(), n) != truth.end(); });
}

template <class Of, class Is>
Score score(const std::vector<ScoreRow>& rows, std::string name, bool at_least, double limit, const Of& of, const Is& is) {
  Score s{.name = std::move(name), .target = (at_least ? ">= " : "<= ") + number_text(limit), .at_least = at_least, .limit = limit};
  for (const ScoreRow& row : rows)
    if (of(row)) ++s.n, s.hits += is(row);
  if (s.n > 0) s.interval = clopper_pearson(s.hits, s.n);
  return s;
}

std::vector<ScoreCard::Bin> reliability_of(const std::vector<ScoreRow>& rows) {
  std::vector<ScoreCard::Bin> bins(10);
  for (const ScoreRow& row : rows) {
    ScoreCard::Bin& bin = bins[static_cast<std::size_t>(std::clamp(static_cast<int>(10 * row.p_first), 0, 9))];
    bin.stated += row.p_first, bin.right += row.first == row.truth, ++bin.n;
  }
  for (ScoreCard::Bin& bin : bins)
    if (bin.n > 0) bin.stated /= bin.n, bin.right /= bin.n;
  return bins;
}

/// Mean distance between the probability stated for what is likeliest and how often that is right.
double calibration_error(const std::vector<ScoreRow>& rows) {
  double error = 0;
  for (const auto& bin : reliability_of(rows))
    if (!rows.empty()) error += std::abs(bin.stated - bin.right) * bin.n / static_cast<double>(rows.size());
  return error;
}

/// What the calibration error of so few sets is on average where the probabilities are right.
double calibration_error_by_chance(std::vector<ScoreRow> rows) {
  constexpr int draws = 200;
  NormalNumbers random(1);
  double sum = 0;
  for (int k = 0; k < draws; ++k) {
    for (ScoreRow& row : rows) row.first = random.uniform() < row.p_first ? row.truth : row.truth + " not";
    sum += calibration_error(rows) / draws;
  }
  return sum;
}

/// Gap over floor at which four of five single effects are named, by a logistic curve in its logarithm, P = 1/(1 + exp(-a - b log g)), of
/// greatest likelihood under a weak prior on a and b (N(0, 10^2)); infinite where that lies beyond every set, or where the curve falls.
double limit_of_detection(const std::vector<ScoreRow>& rows) {
  std::vector<std::pair<double, bool>> sets;
  for (const ScoreRow& row : rows)
    if (row.kind == "single" && row.gap_over_floor > 0 && std::isfinite(row.gap_over_floor))
      sets.emplace_back(std::log(row.gap_over_floor), hit(row));
  constexpr std::size_t least = 10;
  if (sets.size() < least) return std::numeric_limits<double>::infinity();
  double a = 0, b = 0;
  constexpr double precision = 1e-2;
  for (int i = 0; i < 100; ++i) {
    double ga = -precision * a, gb = -precision * b, haa = precision, hab = 0, hbb = precision;
    for (const auto& [x, is_hit] : sets) {
      const double p = 1 / (1 + std::exp(-a - b * x)), w = p * (1 - p);
      ga += is_hit - p, gb += (is_hit - p) * x, haa += w, hab += w * x, hbb += w * x * x;
    }
    const double det = haa * hbb - hab * hab;
    const double da = (hbb * ga - hab * gb) / det, db = (haa * gb - hab * ga) / det;
    const double shorter = 1 / std::max(1.0, std::hypot(da, db));
    a += shorter * da, b += shorter * db;
  }
  double largest = -std::numeric_limits<double>::infinity();
  for (const auto& [x, is_hit] : sets) largest = std::max(largest, x);
  const double limit = (std::log(4.0) - a) / b;
  return b > 0 && limit <= largest ? std::exp(limit) : std::numeric_limits<double>::infinity();
}

}  // namespace

ScoreRow scored(const Truth& truth, const Verdict& verdict, double seconds, const std::string& truth_sha256) {
  ScoreRow row;
  row.number = truth.number, row.replicates = truth.replicates, row.runs = verdict.runs;
  row.kind = truth.kind, row.truth = truth.name(), row.subset = truth.subset;
  row.verdict = verdict.verdict, row.named = named_effects(verdict), row.wording = verdict.wording;
  row.strength = truth.strength, row.detectability = truth.detectability, row.gap_over_floor = truth.gap_over_floor;
  std::vector<std::pair<double, std::string>> order;
  bool listed = false;
  for (const auto& [name, p] : verdict.probability) {
    order.emplace_back(p, name);
    const double is = name == row.truth ? 1 : 0;
    row.brier += (p - is) * (p - is);
    if (is > 0) row.p_truth = p, listed = true;
  }
  if (!listed) row.brier += 1;  // the truth had no probability at all
  std::sort(order.rbegin(), order.rend());
  if (!order.empty()) row.p_first = order.front().first, row.first = order.front().second;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()); ++i) row.in_first_three |= order[i].second == row.truth;
  const auto found = verdict.shrinkage.find(row.named);
  row.shrinkage = row.shrinkage_low = row.shrinkage_high = nan;
  if (found != verdict.shrinkage.end() && verdict.gap.computable)
    row.shrinkage = found->second.mean, row.shrinkage_low = found->second.low, row.shrinkage_high = found->second.high;
  row.seconds = seconds, row.truth_sha256 = truth_sha256;
  return row;
}

std::string score_header() {
  return "number,kind,truth,strength,subset,replicates,detectability,gap_over_floor,verdict,named,wording,first,p_first,p_truth,brier,in_"
         "first_three,"
         "shrinkage,shrinkage_low,shrinkage_high,runs,seconds,truth_sha256";
}

std::string score_line(const ScoreRow& r) {
  std::ostringstream out;
  out.precision(10);
  out << r.number << ',' << r.kind << ',' << r.truth << ',' << r.strength << ',' << r.subset << ',' << r.replicates << ','
      << r.detectability << ',' << r.gap_over_floor << ',' << r.verdict << ',' << r.named << ',' << r.wording << ',' << r.first << ','
      << r.p_first << ',' << r.p_truth << ',' << r.brier << ',' << r.in_first_three << ',' << r.shrinkage << ',' << r.shrinkage_low << ','
      << r.shrinkage_high << ',' << r.runs << ',' << r.seconds << ',' << r.truth_sha256;
  return out.str();
}

ScoreRow score_row(const std::string& line) {
  const std::vector<std::string> t = split(line, ',');
  if (t.size() != 22) throw Error(ExitCode::io, "\"" + line + "\" has " + std::to_string(t.size()) + " fields, a row of scores has 22");
  const auto verdict = verdict_named(t[8]);
  const auto wording = wording_named(t[10]);
  if (!verdict || !wording)
    throw Error(ExitCode::io, "\"" + line + "\": \"" + (verdict ? t[10] : t[8]) + "\" is not a " + (verdict ? "wording" : "verdict") +
                                  "; known: " +
                                  (verdict ? joined({wording_words.begin(), wording_words.end()})
                                           : joined({verdict_kind_words.begin(), verdict_kind_words.end()})));
  const auto number = [&](std::size_t i) { return std::strtod(t[i].c_str(), nullptr); };
  const auto whole = [&](std::size_t i) { return static_cast<int>(std::strtol(t[i].c_str(), nullptr, 10)); };
  ScoreRow r;
  r.number = whole(0), r.kind = t[1], r.truth = t[2], r.strength = number(3), r.subset = t[4], r.replicates = whole(5);
  r.detectability = number(6), r.gap_over_floor = number(7), r.verdict = *verdict, r.named = t[9], r.wording = *wording, r.first = t[11];
  r.p_first = number(12), r.p_truth = number(13), r.brier = number(14), r.in_first_three = whole(15) != 0;
  r.shrinkage = number(16), r.shrinkage_low = number(17), r.shrinkage_high = number(18), r.runs = whole(19), r.seconds = number(20);
  r.truth_sha256 = t[21];
  return r;
}

double Score::share() const { return n > 0 ? static_cast<double>(hits) / n : nan; }
bool Score::met() const { return n > 0 && (at_least ? share() >= limit : share() <= limit); }

namespace {

bool is_null(const ScoreRow& row) { return row.kind.starts_with("null"); }

std::vector<Score> scores_of(const std::vector<ScoreRow>& rows, bool sphere) {
  const auto clear_single = [](const ScoreRow& row) { return row.kind == "single" && row.strength >= 0.5 && row.detectability >= 3; };
  const auto in_library = [](const ScoreRow& row) { return row.kind == "single" || row.kind == "pair"; };
  const auto says_outside = [](const ScoreRow& row) { return row.verdict == VerdictKind::outside; };
  const auto attributes = [](const ScoreRow& row) { return row.verdict == VerdictKind::effects && row.wording == Wording::attributed; };
  const auto clear_pair = [](const ScoreRow& row) { return row.kind == "pair" && row.detectability >= 3; };
  return {score(rows, "single effect at strength >= 1/2, detectable: named first", true, sphere ? 0.85 : 0.80, clear_single, hit),
          score(rows, "the same: among the first three", true, 0.97, clear_single, [](const ScoreRow& row) { return row.in_first_three; }),
          score(rows, "null: an effect is attributed", false, 0.05, is_null, attributes),
          score(rows, "null: an effect is named at all", false, 0.10, is_null,
                [](const ScoreRow& row) { return row.verdict == VerdictKind::effects; }),
          score(
              rows, "outside, gap over 3 u: says outside", true, 0.90,
              [](const ScoreRow& row) { return row.kind == "outside" && row.detectability > 3; }, says_outside),
          score(rows, "effects of the library: says outside", false, 0.05, in_library, says_outside),
          score(rows, "pairs, detectable: both right", true, 0.75, clear_pair, hit),
          score(rows, "pairs, detectable: at least one", true, 0.95, clear_pair, names_one_of),
          score(
              rows, "attributed and wrong, all sets", false, 0.05, [](const ScoreRow&) { return true; },
              [&](const ScoreRow& row) { return attributes(row) && !hit(row); })};
}

}  // namespace

ScoreCard score_card(const std::vector<ScoreRow>& rows, bool sphere) {
  constexpr double ideal = 1, rounding = 1e-9;  // shrinkage
  ScoreCard card;
  card.scores = scores_of(rows, sphere);
  card.reliability = reliability_of(rows);
  card.ece = calibration_error(rows), card.ece_by_chance = calibration_error_by_chance(rows);
  // Of effects that cannot be seen a diagnosis cannot know more than its prior.
  std::vector<ScoreRow> telling = rows;
  std::erase_if(telling, [&](const ScoreRow& row) { return !is_null(row) && row.detectability < 3; });
  double brier_of_telling = 0;
  for (const ScoreRow& row : telling) brier_of_telling += row.brier / static_cast<double>(telling.size());
  std::vector<double> shrunk;
  int covered = 0;
  for (const ScoreRow& row : rows) {
    card.brier += row.brier / static_cast<double>(rows.size());
    ++card.confusion[row.truth][said(row)];
    // What is said of a gap that no effect causes is no shrinkage by a cause.
    if (row.verdict == VerdictKind::effects && hit(row) && std::isfinite(row.shrinkage) && row.detectability >= 3)
      shrunk.push_back(row.shrinkage), covered += row.shrinkage_low <= ideal && row.shrinkage_high >= ideal - rounding;
  }
  std::sort(shrunk.begin(), shrunk.end());
  card.shrinkage_median = shrunk.empty() ? nan : shrunk[shrunk.size() / 2];
  card.interval_coverage = shrunk.empty() ? nan : covered / static_cast<double>(shrunk.size());
  card.detection_limit = limit_of_detection(rows);
  const int n = static_cast<int>(rows.size()), n_telling = static_cast<int>(telling.size()), n_shrunk = static_cast<int>(shrunk.size());
  const auto singles = std::count_if(rows.begin(), rows.end(), [](const ScoreRow& row) { return row.kind == "single"; });
  card.measures = {{"expected calibration error", "<= 0.08", card.ece, 0, 0.08, n},
                   {"Brier score", "<= 0.25", card.brier, 0, 0.25, n},
                   {"shrinkage over ideal, median of right verdicts", ">= 0.9", card.shrinkage_median, 0.9, 1e9, n_shrunk},
                   {"95 % intervals of the shrinkage that hold the ideal", "0.9 to 0.98", card.interval_coverage, 0.9, 0.98, n_shrunk},
                   {"detection limit, gap over floor", "<= 2", card.detection_limit, 0, 2, static_cast<int>(singles)},
                   {"calibration error of sets that can be distinguished", "<= 0.08", calibration_error(telling), 0, 0.08, n_telling},
                   {"Brier score of sets that can be distinguished", "<= 0.25", brier_of_telling, 0, 0.25, n_telling}};
  return card;
}

std::string score_json(const ScoreCard& card) {
  nlohmann::ordered_json json;
  const auto number = [](double value) -> nlohmann::ordered_json { return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr; };
  for (const Score& s : card.scores)
    json["scores"].push_back({{"name", s.name},
                              {"hits", s.hits},
                              {"n", s.n},
                              {"share", number(s.share())},
                              {"low", s.interval[0]},
                              {"high", s.interval[1]},
                              {"target", s.target},
                              {"met", s.met()}});
  for (const Measure& m : card.measures)
    json["measures"].push_back({{"name", m.name}, {"value", number(m.value)}, {"n", m.n}, {"target", m.target}, {"met", m.met()}});
  json["strengths"] = Truth::strengths;
  json["ece"] = card.ece, json["ece_by_chance"] = card.ece_by_chance, json["brier"] = card.brier;
  json["shrinkage_median"] = number(card.shrinkage_median), json["detection_limit"] = number(card.detection_limit);
  json["confusion"] = card.confusion;
  for (const auto& bin : card.reliability) json["reliability"].push_back({{"stated", bin.stated}, {"right", bin.right}, {"n", bin.n}});
  return json.dump(2) + "\n";
}

}  // namespace snag
