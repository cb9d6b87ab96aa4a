// Candidates that are no forces: each is one file of diagnosis/effects that registers itself and changes a run by what a RunEdit offers.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "diagnosis/effects/effect_model.hpp"
#include "tests/sources.hpp"

namespace snag {
namespace {

/// Writes down what a run is changed by.
struct Recorded final : RunEdit {
  const CaseFeatures& base() const override { return facts; }
  void set(const std::string& text) override { changes[text] = 1; }
  void scale(const std::string& key, double factor) override { changes.emplace(key, 1).first->second *= factor; }
  void add(const std::string& key, const Vec3& vector) override { changes[key] += norm(vector); }
  void move_pieces_inside(double way) override { changes["inside"] = way; }
  void turn_pieces(double angle) override { changes["turn"] = angle; }
  void scale_picture(double factor, int axis) override { changes["picture " + std::to_string(axis)] = factor; }
  CaseFeatures facts;
  std::map<std::string, double> changes;
};

std::map<std::string, double> changes_by(const std::string& effect, const CaseFeatures& facts, double theta) {
  Recorded run;
  run.facts = facts;
  effect_models().make(effect, "test")->change(theta, 0, 1, run);
  return run.changes;
}

/// Requirement: the registry holds the folder; its other source is the registry itself.
TEST(Effects, RegistryHoldsTheFolder) {
  std::size_t n = 0;
  for (const auto& file : std::filesystem::directory_iterator(in_sources("diagnosis/effects")))
    n += file.path().extension() == ".cpp" && file.path().stem() != "effect_model";
  EXPECT_EQ(effect_models().names().size(), n);
}

/// Requirement: an effect of a case that can show it changes its run, and says for every other case why it cannot be shown.
TEST(Effects, WhatCanBeSeenChangesARun) {
  CaseFeatures all;
  for (bool CaseFeatures::*fact : {&CaseFeatures::flows, &CaseFeatures::uniform, &CaseFeatures::varies, &CaseFeatures::oriented,
                                   &CaseFeatures::pipe, &CaseFeatures::bend})
    all.*fact = true;
  for (const std::string& name : effect_models().names()) {
    const Effect effect = effect_models().make(name, "test")->effect(all);
    EXPECT_EQ(effect.name, name);
    EXPECT_NE(effect.blind.empty(), changes_by(name, all, 0.1).empty()) << name;
  }
}

/// Requirement: an error of the set-points scales a prescribed flow as a whole, and of computed water what sets it; an error of the flow
/// leaves its mean alone.
TEST(Effects, FlowIsScaledByWhatSetsIt) {
  CaseFeatures prescribed, computed;
  computed.prescribed = false;
  EXPECT_EQ(changes_by("operating_point", prescribed, 0.25).at("flow.velocity_m_s"), 1.25);
  EXPECT_EQ(changes_by("operating_point", prescribed, 0.25).count("boundary.flow_rate_m3_s"), 0u);
  EXPECT_EQ(changes_by("operating_point", computed, 0.25).at("boundary.flow_rate_m3_s"), 1.25);
  const auto error = changes_by("flow_error", prescribed, 0.25);
  EXPECT_EQ(error.at("flow.gradient_per_s"), 1.25);
  EXPECT_EQ(error.count("flow.velocity_m_s"), 0u);
}

}  // namespace
}  // namespace snag
