// Requirement: counts, events and censored times of a random model are judged by their own likelihoods, and strengths are fitted to runs
// that chance has a part in.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "diagnosis/diagnose.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

using namespace snag;

namespace {

// A pump in three numbers: a rag stays for a lognormal time, recirculates so often, leaves with a probability. `sticking` lengthens the
// stay and keeps rags; `slip` makes them recirculate.
struct Passage {
  double time, recirculations, exited;
};

Passage passage(int point, double sticking, double slip, NormalNumbers& random) {
  const double median = 0.2 * (1 + 0.3 * point) * (1 + sticking);
  Passage p{median * std::exp(0.3 * random()), 0, 0};
  const double rate = 2 + 4 * slip;
  double sum = -std::log1p(-random.uniform());
  while (sum < rate) p.recirculations += 1, sum -= std::log1p(-random.uniform());
  p.exited = random.uniform() < 0.9 / (1 + 2 * sticking);
  return p;
}

class Pump final : public TestSimulator {
 public:
  explicit Pump(bool with_twin = false) {
    effects_ = {{.name = "slip", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 4},
                {.name = "sticking", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 4}};
    if (with_twin) effects_.push_back({.name = "twin", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 4});
    for (int o = 0; o < 3; ++o) slots_.push_back({o});
  }

 private:
  std::vector<double> values(const RunRequest& r, NormalNumbers& random) const override {
    const auto theta = [&](const char* name) { return number_of(r.effects, name); };
    const Passage p = passage(r.point, theta("sticking") + theta("twin"), theta("slip"), random);
    return {p.time, p.recirculations, p.exited};
  }
};

Experiment measured(double sticking, double slip, std::uint64_t seed) {
  using Kind = Observable::Kind;
  Experiment e;
  e.observables = {{.id = "retention_time", .unit = "s", .kind = Kind::lognormal, .noise_u = 0.05, .calibration_group = ""},
                   {.id = "recirculations", .unit = "1", .kind = Kind::count, .calibration_group = ""},
                   {.id = "exited", .unit = "1", .kind = Kind::event, .calibration_group = ""}};
  NormalNumbers random(seed);
  for (int p = 0; p < 4; ++p) {
    e.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}});
    std::vector<Passage> passages;
    for (int r = 0; r < 40; ++r) passages.push_back(passage(p, sticking, slip, random));
    constexpr double test_ends = 0.6;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int r = 0; r < 40; ++r) e.data.push_back({p, 0, r, nan, std::min(passages[r].time, test_ends), passages[r].time > test_ends});
    for (int r = 0; r < 40; ++r) e.data.push_back({p, 1, r, nan, passages[r].recirculations});
    for (int r = 0; r < 40; ++r) e.data.push_back({p, 2, r, nan, passages[r].exited});
  }
  return e;
}

}  // namespace

TEST(Rates, NamesTheEffectOfARandomModel) {
  int none = 0, sticking = 0, slip = 0, covered = 0;
  for (int i = 0; i < 4; ++i) {
    const auto judged = [&](double a, double b) {
      const Experiment e = measured(a, b, 50 + i);
      Pump pump;
      return diagnose(e, pump);
    };
    none += judged(0, 0).verdict == VerdictKind::none;
    const Verdict s = judged(1, 0), l = judged(0, 1.5);
    sticking += s.verdict == VerdictKind::effects && s.effects == std::vector<std::string>{"sticking"};
    slip += l.verdict == VerdictKind::effects && l.effects == std::vector<std::string>{"slip"};
    for (const GapCell& cell : s.where) EXPECT_NE(cell.test, CellTest::z);
    const EffectEstimate a = s.parameters.at("sticking"), b = l.parameters.at("slip");
    covered += (std::abs(a.mean - 1) < 1.96 * a.sd) + (std::abs(b.mean - 1.5) < 1.96 * b.sd);
  }
  std::printf("rates: none %d, sticking %d, slip %d of 4 each; strength in its 95 %% interval %d of 8\n", none, sticking, slip, covered);
  EXPECT_GE(covered, 6);
  EXPECT_GE(none, 3);
  EXPECT_GE(sticking, 3);
  EXPECT_GE(slip, 3);
}

// Another name of the effect is no rival, also where the data are counts, events and times.
TEST(Rates, TwoNamesOfOneCause) {
  const Experiment e = measured(1, 0, 50);
  Pump pump(true);
  const Verdict verdict = diagnose(e, pump);
  EXPECT_EQ(verdict.verdict, VerdictKind::effects);
  EXPECT_EQ(verdict.effects, std::vector<std::string>{"sticking"});
  EXPECT_EQ(verdict.same_as, (std::map<std::string, std::vector<std::string>>{{"sticking", {"twin"}}}));
}

namespace {

// A case in which every piece leaves, whatever the seed.
class Drain final : public TestSimulator {
 public:
  Drain() {
    effects_ = {{.name = "sticking", .parameter = "", .mean = 1, .sd = 0.5, .minimum = 0, .maximum = 4}};
    slots_ = {{0}};
  }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override { return {1}; }
};

Verdict of_drain(int n_left) {
  Experiment e;
  e.observables = {{.id = "exited", .unit = "1", .kind = Observable::Kind::event, .calibration_group = ""}};
  for (int p = 0; p < 4; ++p) {
    e.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}});
    for (int r = 0; r < 30; ++r) e.data.push_back({p, 0, r, std::numeric_limits<double>::quiet_NaN(), r < n_left ? 1.0 : 0.0});
  }
  Drain drain;
  return diagnose(e, drain);
}

}  // namespace

// One run of a case without chance says that all pieces leave. Where half of them stay in 120 tests, something is missing; where one of
// 30 stays, nothing need be.
TEST(Rates, OneRunWithoutChanceIsSure) {
  EXPECT_EQ(of_drain(15).verdict, VerdictKind::outside);
  EXPECT_TRUE(std::ranges::any_of(of_drain(15).where, [](const GapCell& cell) { return cell.significant; }));
  EXPECT_NE(of_drain(30).verdict, VerdictKind::outside);
  EXPECT_NE(of_drain(29).verdict, VerdictKind::outside);
}
