// Every contact law of the registry is held to the same rules; a new file in dem/contacts/laws/ is tested without a line here.
#include <gtest/gtest.h>

#include "dem/contacts/contact_blocks.hpp"
#include "tests/sources.hpp"

namespace snag {
namespace {

template <class Work>
void for_each_law(const Work& work) {
  ASSERT_FALSE(contact_laws().names().empty());
  for (const std::string& name : contact_laws().names()) {
    SCOPED_TRACE(name);
    work(*contact_laws().make(name, "test"));
  }
}

constexpr double reach = 2e-3;
const ContactBodies soft{
    .normal_modulus = 0.67e6, .shear_modulus = 0.29e6, .radius = 5e-4, .mass = 1e-6, .restitution = 0.5, .friction = 0.4};

/// Force on the first of two particles whose centres are `r` apart, at relative velocity u and slip xi; and the slip after it.
ContactForce between(const PairLaw& law, const Vec3& r, const Vec3& u, const Vec3& xi, double step) {
  ContactBlock block;
  block.n = 1;
  put(block.normal, 0, unit(r)), put(block.velocity, 0, u), put(block.slip, 0, xi);
  block.overlap[0] = std::max(reach - norm(r), 0.0), block.weight[0] = 1;
  law.evaluate(block, {}, step);
  const Vec3 force = get(block.force, 0);
  return {force, -dot(force, unit(r)), get(block.slip, 0)};
}

// Requirement: no law is dropped by the linker: the registry holds what its folder holds, and the default one is there.
TEST(ContactLaws, RegistryHoldsTheFolder) {
  EXPECT_EQ(contact_laws().names().size(), n_sources("dem/contacts/laws"));
  EXPECT_EQ(contact_laws().make(default_contact_law, "test")->description().name, default_contact_law);
}

// Requirement: a law has a description, its numbers have ranges that hold the defaults, and it gives the exact limits and published numbers
// that it names, and names at least one.
TEST(ContactLaws, ReferenceCases) {
  for_each_law([](ContactLaw& law) {
    const ContactLawDescription description = law.description();
    EXPECT_FALSE(description.equation.empty() || description.source.empty() || description.valid_for.empty());
    for (const Parameter& parameter : law.parameters())
      if (const auto* number = std::get_if<double*>(&parameter.target)) {
        EXPECT_TRUE(**number >= parameter.minimum && **number <= parameter.maximum) << parameter.key;
      }
    EXPECT_FALSE(law.reference_cases().empty());
    for (const ContactReference& reference : law.reference_cases()) {
      const auto pair = law.between(reference.bodies);
      const ContactForce force = between(*pair, {reach - reference.overlap, 0, 0}, {reference.approach, 0, 0}, {}, 1e-9);
      EXPECT_NEAR(force.normal / reference.force, 1, reference.tolerance + 1e-10) << reference.what;
      EXPECT_NEAR(pair->impact_time(1) / reference.impact_time, 1, reference.tolerance) << reference.what;
    }
  });
}

// Requirement: an impact at the largest overlap of an elastic one has stored the energy of the motion, 1/2 m u^2; the force vanishes with
// the overlap; friction never exceeds mu F_n and opposes the slip.
TEST(ContactLaws, EnergyAndFriction) {
  for_each_law([](ContactLaw& law) {
    ContactBodies elastic = soft;
    elastic.restitution = 1;
    const auto pair = law.between(elastic);
    for (const double speed : {0.1, 2.0}) {
      const double deepest = pair->deepest_overlap(speed);
      if (deepest > reach / 2) continue;
      double work = 0;
      const int n = 20000;
      for (int k = 0; k < n; ++k) work += deepest / n * between(*pair, {0, reach - (k + 0.5) / n * deepest, 0}, {}, {}, 1e-9).normal;
      EXPECT_NEAR(work / (0.5 * soft.mass * speed * speed), 1, 1e-5);
    }
    const auto damped = law.between(soft);
    EXPECT_EQ(norm(between(*damped, {0, 0, reach}, {0.1, 0.2, 0.3}, {}, 1e-7).force), 0);
    const Vec3 n = unit({1, 2, -2}), r = (reach - 1e-5) * n;
    for (const double sliding : {1e-4, 1e-2, 1.0}) {
      const Vec3 u_t = sliding * unit(cross(n, Vec3{0, 0, 1}));
      const ContactForce force = between(*damped, r, u_t, {}, 1e-5);
      const Vec3 tangential = force.force - dot(force.force, n) * n;
      EXPECT_LT(dot(tangential, u_t), 0);
      EXPECT_LE(norm(tangential), soft.friction * force.normal * (1 + 1e-12));
    }
  });
}

// Requirement: the stable step resolves an impact by eight steps or more.
TEST(ContactLaws, StableStepResolvesAnImpact) {
  for_each_law([](ContactLaw& law) {
    const auto pair = law.between(soft);
    for (const double speed : {0.1, 5.0}) {
      EXPECT_GT(pair->stable_step(speed), 0);
      EXPECT_LE(pair->stable_step(speed), pair->impact_time(speed) / 8);
    }
  });
}

}  // namespace
}  // namespace snag
