// timeout: 300
// cost: 8
// Requirement: where runs of the base model differ from seed to seed, mistakes of inputs and of the measurement are hypotheses, too: of
// scalars that many repeats were measured of, as of rags that come crumpled.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "diagnosis/diagnose.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

using namespace snag;

namespace {

using Theta = std::map<std::string, double>;

/// A crumpled piece behind a bend in three numbers: velocity, m/s, height in the pipe, m, area, m2. How it crumples (its size s, its place
/// at the start h) is chance. `drag` lets it follow the water, `pressure` holds it back from the outer wall, its mass lets it sink.
std::array<double, 3> passage(int point, const Theta& effects, const Theta& nuisances, NormalNumbers& random) {
  const double water = (0.6 + 0.4 * point) * (1 + number_of(nuisances, "flow.amplitude")), mass = 1 + number_of(nuisances, "rag.mass");
  const double s = std::exp(0.15 * random()), h = 5e-3 * random();
  const double follows = (1 + number_of(effects, "drag")) * s / mass, thrown = 0.06 * (1 - 0.5 * number_of(effects, "pressure"));
  const double vx = water * (1 - 0.4 * std::exp(-follows) + 0.02 * random());
  return {vx, h + thrown * std::exp(-0.3 * follows) * water / (1 + water) - 0.06 * mass / water, 0.014 * s / (1 + 0.3 * water)};
}

/// Index of the case of a point: points of one case are of one condition.
int condition(const OperatingPoint& point) { return point.case_file.string().front() - 'a'; }

class Pipe final : public TestSimulator {
 public:
  explicit Pipe(const Experiment& experiment) : points_(experiment.points) {
    effects_ = {{.name = "drag", .parameter = "", .mean = 0.3, .sd = 0.2, .minimum = -0.6, .maximum = 2},
                {.name = "pressure", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 2}};
    std::vector<int> all;
    for (int p = 0; p < static_cast<int>(experiment.points.size()); ++p)
      all.push_back(p), nuisances_.push_back({"flow.amplitude", 0.02, {p}});
    nuisances_.push_back({"rag.mass", 0.02, all});
    for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) slots_.push_back({o});
  }

 private:
  std::vector<double> values(const RunRequest& r, NormalNumbers& random) const override {
    const auto found = passage(condition(points_[static_cast<std::size_t>(r.point)]), r.effects, r.nuisances, random);
    return {found.begin(), found.end()};
  }

  std::vector<OperatingPoint> points_;
};

/// Forty repeats at twelve points of three groups; `with_pair`: two of different groups have one condition.
Experiment measured(const Theta& effects, const Theta& nuisances, std::uint64_t seed, bool with_pair = false) {
  Experiment e;
  e.observables = {{.id = "vx", .unit = "m/s", .noise_u = 0.01, .calibration_group = ""},
                   {.id = "y", .unit = "m", .noise_u = 1e-3, .calibration_group = ""},
                   {.id = "area", .unit = "m2", .noise_u = 1e-4, .calibration_group = ""}};
  NormalNumbers random(seed);
  for (int p = 0; p < 12; ++p) {
    e.points.push_back({.id = std::string(1, static_cast<char>('A' + p)),
                        .case_file = std::string(1, static_cast<char>('a' + (with_pair && p == 4 ? 3 : p))),
                        .withheld = p / 3 == 2,
                        .group = std::array{"low", "middle", "high"}[p % 3]});
    std::vector<std::array<double, 3>> all;
    Theta at = nuisances;
    at["flow.amplitude"] += 0.02 * random();
    for (int r = 0; r < 40; ++r) all.push_back(passage(condition(e.points.back()), effects, at, random));
    for (int o = 0; o < 3; ++o)
      for (int r = 0; r < 40; ++r)
        e.data.push_back(
            {p, o, r, std::numeric_limits<double>::quiet_NaN(), all[static_cast<std::size_t>(r)][static_cast<std::size_t>(o)]});
  }
  e.seed = 3, e.max_runs = 20000;
  return e;
}

Verdict judged(const Experiment& experiment) {
  Pipe pipe(experiment);
  return diagnose(experiment, pipe);
}

std::string said(const Verdict& verdict) {
  std::string name;
  for (const std::string& effect : verdict.effects) name += (name.empty() ? "" : "+") + effect;
  return verdict.verdict == VerdictKind::effects ? name : word(verdict.verdict);
}

}  // namespace

TEST(RandomBase, NamesMistakes) {
  std::map<std::string, int> right;
  constexpr int n = 3;
  const auto check = [&](const std::string& name, const Experiment& experiment) {
    const std::string verdict = said(judged(experiment));
    right[name] += verdict == name;
    if (verdict != name) std::printf("%s: %s\n", name.c_str(), verdict.c_str());
  };
  for (int i = 0; i < n; ++i) {
    const Experiment null = measured({}, {}, 9100 + i);
    Experiment scale = null, offset = null, unit = null;
    for (Datum& d : scale.data) d.value *= d.point % 3 == 2 && d.observable == 0 ? 0.85 : 1;
    for (Datum& d : offset.data) d.value += d.point % 3 == 1 && d.observable == 1 ? 0.015 : 0;
    for (Datum& d : unit.data) d.value *= d.observable == 1 ? 1e3 : 1;
    check("none", null);
    check("scale:high/m/s", scale);
    check("offset:y@middle", offset);
    check("unit:m", unit);
    check("input:rag.mass", measured({}, {{"rag.mass", 0.35}}, 9200 + i));
    check("drag", measured({{"drag", 0.5}}, {}, 9300 + i));
    check("pressure", measured({{"pressure", 0.7}}, {}, 9400 + i));
  }
  for (const auto& [name, count] : right) {
    std::printf("%s: %d of %d\n", name.c_str(), count, n);
    EXPECT_GE(count, n - 1) << name;
  }
}

/// What series differ by is no effect and no calibration of one of them where a pair of points of one condition shows it: heights of each
/// series are off by 4 mm at random, five times the standard uncertainty of a mean. Without the pair nobody can know.
TEST(RandomBase, SeriesDiffer) {
  constexpr int n = 8;
  int none_with_pair = 0, none_without = 0;
  for (int i = 0; i < n; ++i) {
    for (const bool pair : {true, false}) {
      Experiment experiment = measured({}, {}, 9600 + i, pair);
      NormalNumbers random(9700 + i);
      const std::array<double, 3> off{4e-3 * random(), 4e-3 * random(), 4e-3 * random()};
      for (Datum& d : experiment.data) d.value += d.observable == 1 ? off[static_cast<std::size_t>(d.point % 3)] : 0;
      (pair ? none_with_pair : none_without) += said(judged(experiment)) == "none";
    }
  }
  std::printf("series that differ: none in %d of %d with a pair, in %d without\n", none_with_pair, n, none_without);
  EXPECT_GE(none_with_pair, 5);
  EXPECT_LE(none_without, none_with_pair - 3);
}

/// A crumple behind a bend: a kernel of this width brings the height down, and lets the shapes of the crumples differ less. No width brings
/// the shape of the measured ones.
class Bend final : public TestSimulator {
 public:
  explicit Bend(const Experiment& experiment) {
    effects_ = {{.name = "width", .parameter = "", .mean = 20, .sd = 15, .minimum = 0, .maximum = 60},
                {.name = "weight", .parameter = "", .mean = 0.1, .sd = 0.1, .minimum = -0.5, .maximum = 0.5}};
    for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) slots_.push_back({o});
  }

 private:
  std::vector<double> values(const RunRequest& r, NormalNumbers& random) const override {
    const double width = number_of(r.effects, "width"), alike = std::exp(-width / 10);
    const double shape = 5.2 + alike * random();
    return {shape, 30 - 0.7 * width - 3 * number_of(r.effects, "weight") + 0.5 * random()};
  }
};

/// With two runs a state: how alike they happen to be must not decide about a cause by rows that it does not explain. The fit says of the
/// strength what the screening says, and what the heights are made with.
TEST(RandomBase, ScatterOfTwoRunsDecidesNothing) {
  constexpr double width = 40;
  double least_gain = 1e9, furthest = 0;
  for (int i = 0; i < 8; ++i) {
    Experiment e;
    e.observables = {{.id = "elongation_ratio", .unit = "1", .noise_u = 0.01, .calibration_group = ""},
                     {.id = "y", .unit = "mm", .noise_u = 0.1, .calibration_group = ""}};
    NormalNumbers random(9800 + i);
    for (int p = 0; p < 8; ++p) {
      e.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = "bend", .withheld = p > 5});
      for (int o = 0; o < 2; ++o)
        for (int r = 0; r < 40; ++r)
          e.data.push_back(
              {p, o, r, std::numeric_limits<double>::quiet_NaN(), o == 0 ? 2.6 + 0.6 * random() : 30 - 0.7 * width + 40 * random()});
    }
    e.seed = static_cast<std::uint64_t>(3 + 10 * i), e.max_runs = 1000, e.pairs = false;
    Bend bend(e);
    const Verdict verdict = diagnose(e, bend);
    const EffectEstimate& found = verdict.parameters.at("width");
    const double gain = verdict.log_evidence.at("width"), screened = verdict.screening.at("width");
    std::printf("width %.1f +- %.1f, %.1f nats, screened %.1f\n", found.mean, found.sd, gain, screened);
    least_gain = std::min(least_gain, gain / screened), furthest = std::max(furthest, std::abs(found.mean - width) / found.sd);
  }
  EXPECT_GT(least_gain, 0.5);
  EXPECT_LT(furthest, 4);
}

/// Conditions that would tell what the data do not decide are proposed here, too; what the draws of chance differ by counts for none.
TEST(RandomBase, ProposesConditions) {
  int ties = 0, proposed = 0;
  for (int i = 0; i < 12; ++i) {
    Experiment few = measured({{"drag", 0.25}}, {}, 9500 + i);
    std::erase_if(few.data, [](const Datum& d) { return d.replicate >= 8; });
    const Verdict verdict = judged(few);
    if (verdict.verdict != VerdictKind::tie) continue;
    ++ties, proposed += !verdict.identifiability.new_conditions.empty();
    for (const std::string& name : verdict.tie) std::printf("%s ", name.c_str());
    for (const NewCondition& c : verdict.identifiability.new_conditions) {
      std::printf("  %s at %s times %g: %.3g nats, of a repeat %.3g", c.input.c_str(), c.point.c_str(), c.factor, c.nats, c.nats_of_repeat);
      EXPECT_GE(c.nats, 2 * c.nats_of_repeat);
    }
    std::printf("\n");
  }
  std::printf("%d of %d ties with a condition\n", proposed, ties);
  EXPECT_GE(proposed, 1);
}
