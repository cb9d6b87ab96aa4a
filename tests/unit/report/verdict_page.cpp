// Requirement: the page of a verdict begins with what was found and what to do about it; it states no certainty, proposes no repeats of
// what is decided, and shows the draws of the strengths in pairs.
#include "report/verdict_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "report/verdict_words.hpp"

namespace snag {
namespace {

Verdict of(VerdictKind verdict, Wording wording, const std::vector<std::string>& effects, double p) {
  Verdict v;
  v.name = "falling spheres", v.verdict = verdict, v.wording = wording, v.effects = effects, v.p_effects = p;
  v.probability = {{"none", 1e-5}, {"outside", 1e-4}};
  for (const std::string& name : effects) {
    v.acts[name] = p, v.probability[name] = p;
    v.parameters[name] = {.mean = 0.48, .sd = 0.02};
    v.causes.push_back({.effect = name, .share = 1.0 / static_cast<double>(effects.size()), .nats = 30});
  }
  v.identifiability.next_experiment = "327 more repeats are enough.";
  v.where.push_back({.observable = "z", .point = "A", .window = {0.1, 0.2}, .z = 5});
  return v;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(VerdictPage, AttributedCauseIsOnHand) {
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"added_mass"}, 0.9999999);
  v.improved.files = {"case_with_effects.toml"};
  EXPECT_EQ(verdict_sentence(v), "The gap comes from added_mass: attributed, probability over 99 %.");
  EXPECT_EQ(verdict_advice(v), "Go on with case_with_effects.toml; it contains added_mass = 0.48 ± 0.02.");
  const std::string page = verdict_page(v);
  EXPECT_TRUE(holds(page, verdict_advice(v)));
  EXPECT_FALSE(holds(page, "100 %</text>"));
  EXPECT_FALSE(holds(page, "more repeats"));
}

// Requirement: the advice gives the strength that the improved case contains. If the estimate differs from it, the advice gives both.
TEST(VerdictPage, StrengthIsThatOfTheImprovedCase) {
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"added_mass"}, 0.999);
  v.improved.files = {"case_with_effects.toml"}, v.improved.runs.resize(1);
  double& strength = v.improved.runs[0].effects["added_mass"];
  strength = 0.465;
  EXPECT_EQ(verdict_advice(v), "Go on with case_with_effects.toml; it contains added_mass = 0.465 (estimate 0.48 ± 0.02).");
  strength = 0.481;
  EXPECT_EQ(verdict_advice(v), "Go on with case_with_effects.toml; it contains added_mass = 0.48 ± 0.02.");
}

TEST(VerdictPage, WaterOfAPipeInWords) {
  EXPECT_EQ(verdict_sentence(of(VerdictKind::effects, Wording::attributed, {"swirl"}, 0.999)),
            "The gap comes from swirl: the water swirls by 0.48 ± 0.02 of its mean speed at the wall of the pipe: attributed, probability "
            "over 99 %.");
}

/// Labels of the bars that stand out.
std::vector<std::string> strong_bars(const std::string& page) {
  std::vector<std::string> labels;
  const std::string bars = page.substr(0, page.find("</svg>")), blue = "fill=\"#0072b2\"/>", label = "text-anchor=\"end\">";
  for (std::size_t at = bars.find(blue); at != std::string::npos; at = bars.find(blue, at + 1)) {
    const std::size_t begin = bars.rfind(label, at) + label.size();
    labels.push_back(bars.substr(begin, bars.find('<', begin) - begin));
  }
  std::sort(labels.begin(), labels.end());
  return labels;
}

TEST(VerdictPage, BarsOfWhatIsNamedStandOut) {
  using Names = std::vector<std::string>;
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"added_mass", "lift"}, 0.99);
  v.acts["wall"] = 0.995;
  EXPECT_EQ(strong_bars(verdict_page(v)), (Names{"added_mass", "lift"}));
  v.verdict = VerdictKind::tie, v.wording = Wording::undecided, v.tie = {"added_mass+wall", "outside"};
  EXPECT_EQ(strong_bars(verdict_page(v)), (Names{"added_mass", "outside", "wall"}));
  v.verdict = VerdictKind::outside, v.wording = Wording::outside;
  EXPECT_EQ(strong_bars(verdict_page(v)), Names{"outside"});
  v.verdict = VerdictKind::none, v.wording = Wording::no_gap;
  EXPECT_EQ(strong_bars(verdict_page(v)), Names{"none"});
}

TEST(VerdictPage, SuspectedCauseIsCheckedFirst) {
  Verdict v = of(VerdictKind::effects, Wording::suspected, {"lift"}, 0.999);
  v.improved.files = {"case_with_effects_A.toml", "case_with_effects_B.toml"};
  EXPECT_FALSE(holds(verdict_sentence(v), "%"));
  EXPECT_EQ(verdict_advice(v),
            "Check the cause first; then go on with case_with_effects_A.toml (and the files of the other points); it contains lift = 0.48 "
            "± 0.02.");
  EXPECT_TRUE(holds(verdict_page(v), "more repeats"));
}

TEST(VerdictPage, MistakesAreCorrectedWhereTheyWereMade) {
  EXPECT_EQ(verdict_advice(of(VerdictKind::effects, Wording::attributed, {"unit:mm"}, 0.99)),
            "Correct the unit of the data that are stated in mm.");
  EXPECT_EQ(verdict_advice(of(VerdictKind::effects, Wording::attributed, {"scale:high"}, 0.99)),
            "Calibrate the points high again: relative error = 0.48 ± 0.02.");
  EXPECT_EQ(verdict_advice(of(VerdictKind::effects, Wording::attributed, {"input:particle.density_kg_m3@A, C"}, 0.99)),
            "Look up or measure particle.density_kg_m3 at A, C again: relative error of the case's value = 0.48 ± 0.02.");
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"input:particle.density_kg_m3"}, 0.99);
  v.improved.files = {"case_with_effects.toml"};
  EXPECT_EQ(verdict_advice(v),
            "Look up or measure particle.density_kg_m3 again: relative error of the case's value = 0.48 ± 0.02. Go on with "
            "case_with_effects.toml, where it is as fitted.");
}

TEST(VerdictPage, NothingIsChangedWithoutACause) {
  Verdict none = of(VerdictKind::none, Wording::no_gap, {}, 0);
  none.improved.why_none = "The verdict names no cause, so the case stays as it is.";
  EXPECT_TRUE(holds(verdict_page(none), "No case_with_effects.toml: The verdict names no cause"));
  EXPECT_TRUE(holds(verdict_advice(none), "Leave the case as it is"));
  EXPECT_EQ(verdict_advice(of(VerdictKind::outside, Wording::outside, {"lift"}, 0)),
            "Do not tune the case to these data: no strength of an effect is right. Look for the cause where the gap is largest: z at A, "
            "0.1 to 0.2 s.");
  // A cell whose mean agrees has the largest score, because the fit of the inputs follows another point.
  Verdict moved = of(VerdictKind::outside, Wording::outside, {}, 0);
  moved.where.front().score = 5;
  moved.where.push_back({.observable = "z", .point = "B", .window = {0.1, 0.2}, .z = std::nan(""), .score = -7});
  EXPECT_TRUE(holds(verdict_advice(moved), "where the gap is largest: z at A,"));
  moved.where.front().z = 0.5;
  EXPECT_TRUE(holds(verdict_advice(moved), "where the gap is largest: z at B,"));
  Verdict tie = of(VerdictKind::tie, Wording::undecided, {"lift"}, 0.5);
  tie.tie = {"lift", "none"};
  EXPECT_EQ(verdict_advice(tie), "Change nothing yet. 327 more repeats are enough.");
  tie.identifiability.new_conditions = {{"B", "flow.amplitude", 2, "z", 3.2, 0.4}};
  EXPECT_EQ(verdict_advice(tie),
            "Change nothing yet. Measure z at point B with flow.amplitude doubled: one test there is expected to distinguish the "
            "two most probable causes by 3.2 nats; 6 are wanted.");
  EXPECT_TRUE(holds(verdict_page(tie), "point B with flow.amplitude doubled"));
}

// A candidate of one's own has a name of any kind: it is shown as text, also where the cells are that it leaves.
TEST(VerdictPage, NamesAreShownAsText) {
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"<script>alert(1)</script>"}, 0.999);
  v.where[0].score_after = 1;
  const std::string page = verdict_page(v);
  EXPECT_FALSE(holds(page, "<script"));
  EXPECT_TRUE(holds(page, "What is left with &lt;script&gt;"));
}

TEST(VerdictPage, PairsOfStrengths) {
  Verdict v = of(VerdictKind::effects, Wording::attributed, {"added_mass", "lift"}, 0.95);
  v.posterior.hypothesis = "added_mass+lift";
  v.posterior.variables = {
      {.name = "added_mass", .unit = "1"}, {.name = "lift", .unit = "1"}, {.name = "flow.viscosity", .unit = "u", .is_strength = false}};
  for (int i = 0; i < 100; ++i) {
    const double x = std::sin(i), y = std::cos(3 * i);
    v.posterior.variables[0].draws.push_back(0.5 + 0.1 * x), v.posterior.variables[1].draws.push_back(1 - 0.2 * x + 0.01 * y),
        v.posterior.variables[2].draws.push_back(y);
  }
  const std::string page = verdict_page(v);
  EXPECT_TRUE(holds(page, "correlation -1.00"));
  EXPECT_FALSE(holds(page, "flow.viscosity [standard uncertainties]"));  // nearly independent of both
  v.posterior.variables[2].draws = v.posterior.variables[1].draws;
  EXPECT_TRUE(holds(verdict_page(v), "flow.viscosity [standard uncertainties]"));
}

}  // namespace
}  // namespace snag
