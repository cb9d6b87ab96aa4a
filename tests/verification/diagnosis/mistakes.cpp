// timeout: 300
// cost: 10
// Requirement: an input that is far off and mistakes of the measurement (unit, sign, clock, frame rate, calibration of a group of points)
// are named as what they are, not blamed on an effect and not called outside.
#include <gtest/gtest.h>

#include "tests/verification/diagnosis/formula.hpp"

using namespace snag;
using formula::judged;
using formula::said;

namespace {

constexpr double noise = 5e-4;

}  // namespace

// The viscosity is 10 and 15 u off at every point.
TEST(Mistakes, InputFarOff) {
  int right = 0, blamed = 0;
  for (int i = 0; i < 6; ++i) {
    const Verdict verdict = judged(formula::experiment({.nuisances = {{"flow.viscosity", i % 2 ? 0.3 : -0.2}}}, 6, 3, 3, noise, 7300 + i));
    right += said(verdict) == "input:flow.viscosity";
    blamed += verdict.verdict == VerdictKind::effects && said(verdict) != "input:flow.viscosity" && verdict.wording == Wording::attributed;
    std::printf("viscosity off: %s\n", said(verdict).c_str());
  }
  EXPECT_GE(right, 4);
  EXPECT_LE(blamed, 1);
}

TEST(Mistakes, UnitSignClockFrameRate) {
  int right = 0, n = 0;
  const auto check = [&](const std::string& name, const Verdict& verdict) {
    ++n, right += said(verdict) == name;
    if (said(verdict) != name) std::printf("%s: %s\n", name.c_str(), said(verdict).c_str());
  };
  for (int i = 0; i < 3; ++i) {
    Experiment unit = formula::experiment({}, 6, 3, 3, noise, 7400 + i), sign = unit, clock = unit, rate = unit;
    for (Datum& d : unit.data) d.value *= 1e-3;
    check("unit:m", judged(unit));
    for (Datum& d : sign.data) d.value *= d.observable == 1 ? -1 : 1;
    check("sign:z", judged(sign));
    // Times are written down 0.04 s too early, so what is measured at t was there at t + 0.04 s.
    std::erase_if(clock.data, [](const Datum& d) { return d.time < 0.05; });
    for (Datum& d : clock.data) d.time -= 0.04;
    check("clock", judged(clock));
    for (Datum& d : rate.data) d.time /= 1.12;
    check("frame_rate", judged(rate));
  }
  std::printf("mistakes of the measurement: %d of %d named\n", right, n);
  EXPECT_EQ(right, n);
}

// Numbers in millimetres that are said to be metres, and the other way round: noise and bias are stated in the unit that is named, so that
// they are a thousand times too small or too large for the numbers. One repeat says nothing of the noise.
TEST(Mistakes, UnitOfNumbersNoiseAndBias) {
  int right = 0, n = 0;
  for (int i = 0; i < 4; ++i)
    for (const double factor : {1e3, 1e-3}) {
      Experiment experiment = formula::experiment({}, 6, 3, i % 2 ? 3 : 1, noise, 7450 + i);
      NormalNumbers random(7460 + i);
      for (Observable& observable : experiment.observables) observable.bias_u = 4 * noise;
      const std::array<double, 2> bias{4 * noise * random(), 4 * noise * random()};
      for (Datum& d : experiment.data) d.value = factor * (d.value + bias[static_cast<std::size_t>(d.observable)]);
      const Verdict verdict = judged(experiment);
      ++n, right += said(verdict) == "unit:m";
      if (said(verdict) != "unit:m") std::printf("unit:m, %g: %s\n", factor, said(verdict).c_str());
    }
  std::printf("units: %d of %d named\n", right, n);
  EXPECT_EQ(right, n);
}

// A camera has a calibration for each axis. A wrong distance to it is one factor of both, a wrong calibration of one axis is one of that.
TEST(Mistakes, ScaleOfAllAxesOrOfOne) {
  int right = 0, n = 0;
  for (int i = 0; i < 2; ++i) {
    Experiment both = formula::experiment({}, 6, 3, 3, noise, 8450 + i);
    for (std::size_t p = 0; p < both.points.size(); ++p) both.points[p].group = std::array{"low", "high"}[p % 2];
    for (Observable& observable : both.observables) observable.calibration_group = observable.id + " of the camera";
    Experiment one = both;
    const auto is_high = [](const Datum& d) { return d.point % 2 == 1; };
    for (Datum& d : both.data) d.value *= is_high(d) ? 1.05 : 1;
    for (Datum& d : one.data) d.value *= is_high(d) && d.observable == 1 ? 1.05 : 1;
    for (const auto& [name, verdict] : {std::pair("scale:high", judged(both)), std::pair("scale:high/z of the camera", judged(one))}) {
      // Of two groups, one that is too large is one that is too small of the other, but for the runs.
      ++n, right += said(verdict) == name;
      if (said(verdict) != name) std::printf("%s: %s\n", name, said(verdict).c_str());
    }
  }
  EXPECT_EQ(right, n);
}

// An input that is far off is told where it is no hypothesis, too; one that is within its uncertainty is not.
TEST(Mistakes, InputFarOffIsTold) {
  const auto told = [](double off) {
    Experiment experiment = formula::experiment({.nuisances = {{"flow.viscosity", off}}}, 6, 0, 3, noise, 7310);
    experiment.candidates = {"added_mass"};
    const Verdict verdict = judged(experiment);
    return std::any_of(verdict.notes.begin(), verdict.notes.end(), [](const std::string& note) {
      return note.find("flow.viscosity is fitted") != std::string::npos && note.find("above what is stated") != std::string::npos;
    });
  };
  EXPECT_TRUE(told(0.12));
  EXPECT_FALSE(told(0.01));
}

// Three groups of three points, two of each for training: the numbers of one group are 4 to 8 % too large, or shifted by 4 mm. Without a
// mistake the groups change nothing.
TEST(Mistakes, CalibrationOfAGroupOfPoints) {
  int right = 0, n = 0, effects = 0, nulls = 0;
  const auto grouped = [](const formula::Truth& truth, std::uint64_t seed) {
    Experiment experiment = formula::experiment(truth, 6, 3, 3, noise, seed);
    for (std::size_t p = 0; p < experiment.points.size(); ++p) experiment.points[p].group = std::array{"low", "middle", "high"}[p % 3];
    return experiment;
  };
  const auto check = [&](const std::string& name, const Verdict& verdict) {
    ++n, right += said(verdict) == name;
    if (said(verdict) != name) std::printf("%s: %s\n", name.c_str(), said(verdict).c_str());
  };
  for (int i = 0; i < 3; ++i) {
    Experiment scale = grouped({}, 8400 + i), offset = scale;
    const double factor = 1.04 + 0.02 * i;
    for (Datum& d : scale.data) d.value *= d.point % 3 == 2 ? factor : 1;
    const Verdict common = judged(scale);
    check("scale:high", common);
    if (said(common) == "scale:high") {
      const EffectEstimate& fitted = common.parameters.at("scale:high");
      EXPECT_NEAR(fitted.mean, factor - 1, 4 * fitted.sd);
    }
    for (Datum& d : offset.data) d.value += d.point % 3 == 1 && d.observable == 1 ? 4e-3 : 0;
    check("offset:z@middle", judged(offset));
    nulls += said(judged(grouped({}, 8500 + i))) == "none";
    effects += said(judged(grouped({.effects = {{"lift", 1}}}, 8600 + i))) == "lift";
  }
  std::printf("calibrations of groups: %d of %d named; %d of 3 nulls none, %d of 3 effects named\n", right, n, nulls, effects);
  EXPECT_EQ(right, n);
  EXPECT_EQ(nulls, 3);
  EXPECT_GE(effects, 2);
}
