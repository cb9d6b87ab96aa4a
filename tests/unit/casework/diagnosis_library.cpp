// What is known beforehand of the effects that a diagnosis over cases may find missing.
#include <gtest/gtest.h>

#include "casework/library.hpp"
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

}  // namespace
}  // namespace snag
