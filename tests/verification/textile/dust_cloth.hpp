#pragma once
// The dust cloth of cases/textile-aro, and what its bonds may not depend on.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/sources.hpp"
#include "textile/independence.hpp"

namespace snag::dust_cloth {

inline TextileTests aro() { return read_textile_tests(in_sources("cases/textile-aro/tests.toml")); }

inline void expect_independence_of_size_and_step(const Independence& found) {
  ASSERT_EQ(found.radii.size(), 5);
  for (int d = 0; d < 2; ++d) {
    EXPECT_LT(found.strain_spread(d), 0.01);
    EXPECT_LT(found.force_spread(d), 0.1);
    for (const RadiusPoint& point : found.radii) EXPECT_LT(std::abs(point.height[d]), 1e-4) << point.radius;
  }
  for (const StepPoint& point : found.steps) {
    EXPECT_NEAR(point.grab.max_force / found.steps.front().grab.max_force, 1, 5e-3) << point.share;
    EXPECT_NEAR(point.grab.strain_at_max / found.steps.front().grab.strain_at_max, 1, 5e-3) << point.share;
  }
  EXPECT_LT(found.tip_spread(), 1e-3);
}

}  // namespace snag::dust_cloth
