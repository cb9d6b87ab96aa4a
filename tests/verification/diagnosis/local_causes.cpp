// timeout: 600
// cost: 60
// Requirement: an effect that acts from a time on only is named with that time, and one that acts all the time is not called local.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <vector>

#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/attribution/local_causes.hpp"
#include "tests/verification/diagnosis/formula.hpp"

using namespace snag;

namespace {

Verdict judged(const formula::Truth& truth, std::uint64_t seed) {
  const Experiment experiment = formula::experiment(truth, 4, 3, 5, 2e-4, seed);
  formula::Sphere sphere(experiment, false, false, true);
  return diagnose(experiment, sphere);
}

}  // namespace

TEST(LocalCauses, NamedWithTheirOnset) {
  constexpr int n = 6;
  int named = 0, within = 0;
  for (int i = 0; i < n; ++i) {
    const char* effect = i % 2 ? "lift" : "added_mass";
    Gate gate;
    gate.effect = effect, gate.from = 0.2 + 0.05 * i;
    const Verdict verdict = judged({.effects = {{effect, i % 2 ? 1.5 : 0.6}}, .gate = gate}, 8000 + i);
    const std::string name = formula::said(verdict);
    const auto local = verdict.local.find(name);
    const bool is_named = name == std::string(effect) + "@t";
    named += is_named, within += is_named && std::abs(local->second.mean - gate.from) < 3 * local->second.sd;
    std::printf("%s from %.3f s on: %s", effect, gate.from, name.c_str());
    if (local != verdict.local.end()) std::printf(" from %.4f +- %.4f", local->second.mean, local->second.sd);
    std::printf(", %d runs\n", verdict.runs);
  }
  std::printf("%d of %d named, %d of them within 3 sd\n", named, n, within);
  EXPECT_GE(named, n - 1);
  EXPECT_GE(within, named - 1);
}

/// Requirement: each of three turns brings the places of a profile nearer, and where the data are so good that one place has all the
/// evidence, the onset is not said to be known better than the places stand apart.
TEST(LocalCauses, TheOnsetIsKnownAsWellAsItsPlacesStand) {
  constexpr double duration = 0.8, spacing = duration / 9, of_profile = 0.5 * spacing, even = 3.464101615137755;  // 12^(1/2)
  Gate gate;
  gate.effect = "lift", gate.from = 0.333;
  const Experiment experiment = formula::experiment({.effects = {{"lift", 1.5}}, .gate = gate}, 3, 1, 1, 1e-6, 8200);
  std::map<int, LocalCause> found;  // by turns that are allowed
  for (const int allowed : {0, 1, 9}) {
    formula::Sphere sphere(experiment, false, false, true);
    Responses model(experiment, sphere);
    Fitter fitter(model);
    const auto& effects = model.effects();
    const auto lift = std::find_if(effects.begin(), effects.end(), [](const Effect& effect) { return effect.name == "lift"; });
    const GateFamily family{.axis = -1, .is_upwards = true, .low = 0, .high = duration};
    const ScannedLocal scanned{.effect = static_cast<int>(lift - effects.begin()), .family = family, .place = 4 * spacing, .theta = 1};
    const int local = model.add_local(scanned.effect, family.at(scanned.place));
    int turns = 0;
    const LocalFit fit = fit_local_cause(model, fitter, local, scanned, [&](int) { return turns++ < allowed; });
    EXPECT_EQ(turns, std::min(allowed + 1, 3));
    found[allowed] = fit.cause;
    std::printf("%d turns allowed: lift from %.5f +- %.5f s on, truth %.5f\n", allowed, fit.cause.mean, fit.cause.sd, gate.from);
  }
  EXPECT_NEAR(found[0].sd / (of_profile / even), 1, 1e-9);
  EXPECT_NEAR(found[1].sd / (0.4 * of_profile / even), 1, 1e-9);
  EXPECT_NEAR(found[9].sd / (0.4 * 0.4 * 0.4 * of_profile / even), 1, 1e-9);
  for (const auto& [turns, cause] : found) EXPECT_LT(std::abs(cause.mean - gate.from), 3 * cause.sd) << turns;
}

/// Requirement: the evidence of a local cause beside another effect is the mean of exp of the evidence over all places, as that of a local
/// cause alone is; the place that fits best is no prior knowledge.
TEST(LocalCauses, PlaceHasItsPriceBesideAnotherEffect) {
  constexpr double duration = 0.8;
  Gate gate;
  gate.effect = "lift", gate.from = 0.35;
  const Experiment experiment = formula::experiment({.effects = {{"added_mass", 0.04}, {"lift", 3}}, .gate = gate}, 4, 3, 5, 5e-4, 8301);
  formula::Sphere sphere(experiment, false, false, true);
  Responses model(experiment, sphere);
  Fitter fitter(model);
  const Attribution a = attribute(model, fitter, {});
  const auto found = std::find(a.names.begin(), a.names.end(), "added_mass+lift@t");
  ASSERT_NE(found, a.names.end());
  const Fit& fit = a.fits[static_cast<std::size_t>(found - a.names.begin())];
  const auto local = *std::find_if(fit.hypothesis.effects.begin(), fit.hypothesis.effects.end(), [&](int k) { return model.gate_of(k); });
  const GateFamily family{.axis = -1, .is_upwards = true, .low = 0, .high = duration};
  const LocalCause& cause = a.local.at("lift@t");
  constexpr int n = 16;  // places on each side, half a standard deviation apart: the other effect moves the best place
  const double step = cause.sd / 2;
  std::vector<double> terms;
  double best = -std::numeric_limits<double>::infinity();
  for (int i = -n; i <= n; ++i) {
    model.set_gate(local, family.at(cause.mean + i * step));
    const double log_evidence = fitter.fit(fit.hypothesis, fit.theta, fit.at.state.forms).log_evidence;
    best = std::max(best, log_evidence), terms.push_back(log_evidence + std::log(step / duration));
  }
  std::printf("evidence of the set %.2f, of its best place %.2f, mean over all places %.2f\n", fit.log_evidence, best, log_sum_exp(terms));
  EXPECT_NEAR(fit.log_evidence, log_sum_exp(terms), 0.5);
}

TEST(LocalCauses, WhatActsAllTheTimeIsNotLocal) {
  constexpr int n = 8;
  int local = 0, right = 0;
  for (int i = 0; i < n; ++i) {
    const char* effect = i % 2 ? "lift" : "added_mass";
    const std::string name = formula::said(judged({.effects = {{effect, i % 2 ? 0.8 : 0.4}}, .form = 0.05}, 8100 + i));
    std::printf("%s: %s\n", effect, name.c_str());
    local += name.find('@') != std::string::npos, right += name == effect;
  }
  EXPECT_EQ(local, 0);
  EXPECT_GE(right, n - 1);
}
