// What is known beforehand of the effects that a diagnosis over cases may find missing.
#include <gtest/gtest.h>

#include <algorithm>

#include "casework/library.hpp"
#include "casework/point_case.hpp"
#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

// Requirement: there is one prior of each force, that in its description; and gravity at its strength 1 is 9.81 m/s2 downwards.
TEST(DiagnosisLibrary, PriorsAreThoseOfTheCards) {
  for (const std::string& name : fluid_forces().names()) {
    const auto prior = fluid_forces().make(name, "test")->description().prior;
    const CatalogueEffect* effect = catalogue_effect(name);
    ASSERT_EQ(effect != nullptr, prior.has_value()) << name;
    if (!effect) continue;
    EXPECT_EQ(effect->prior.key, prior->key) << name;
    EXPECT_EQ(effect->prior.meaning, prior->meaning) << name;
    EXPECT_EQ(effect->prior.unit, prior->unit) << name;
    EXPECT_EQ(effect->prior.mean, prior->mean) << name;
    EXPECT_EQ(effect->prior.sd, prior->sd) << name;
    EXPECT_EQ(effect->prior.minimum, prior->minimum) << name;
    EXPECT_EQ(effect->prior.maximum, prior->maximum) << name;
    EXPECT_EQ(effect->is_force, name != "gravity") << name;
  }
  const auto overrides = catalogue_effect("gravity")->overrides(1, 0, 0, [](const std::string&) { return ""; });
  ASSERT_EQ(overrides.size(), 1u);
  EXPECT_EQ(overrides[0], "gravity.acceleration_m_s2=[0.0, 0.0, -9.81]");
}

/// Requirement: settings change the value that the case has, by a sum or by a share, and bring the law that has them; a number of a force
/// is blind where the case does not hold the force.
TEST(DiagnosisLibrary, Settings) {
  const auto base = [](const std::string& key) { return key.ends_with("reference_speed_m_s") ? "0.4" : ""; };
  EXPECT_EQ(catalogue_effect("folding_speed")->overrides(0.5, 0, 0, base),
            std::vector<std::string>{"coupling.reconfiguration.reference_speed_m_s=0.6000000000000001"});
  EXPECT_EQ(catalogue_effect("wall_adhesion")->overrides(0.25, 0, 0, base),
            (std::vector<std::string>{"contact.hertz_dmt.wall_adhesion_J_m2=0.25", "contact.law=\"hertz_dmt\""}));
  const auto blind = [](const std::string& name, const CaseFeatures& facts, const std::vector<std::string>& forces) {
    const std::vector<Effect> all = library_effects(facts, forces);
    return std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.name == name; })->blind;
  };
  CaseFeatures facts;
  facts.bonds = facts.wall = facts.several = true;
  EXPECT_EQ(blind("folding_speed", facts, {}), "the base case has no reconfiguration");
  EXPECT_EQ(blind("folding_speed", facts, {"reconfiguration"}), "");
  EXPECT_EQ(blind("wall_adhesion", facts, {}), "contacts are no spheres of Hertz");
  facts.hertz = true;
  EXPECT_EQ(blind("wall_adhesion", facts, {}), "");
}

}  // namespace
}  // namespace snag
