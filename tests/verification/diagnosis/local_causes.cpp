// timeout: 600
// cost: 60
// Requirement: an effect that acts from a time on only is named with that time, and one that acts all the time is not called local.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

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
