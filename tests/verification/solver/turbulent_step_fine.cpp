// ranks: 1
// labels: long
// timeout: 600
#include <gtest/gtest.h>

#include "tests/verification/solver/backward_facing_step.hpp"

using namespace snag;
using namespace snag::test;

// The flow behind a step on a grid twice as fine in both directions: the other program finds 5.39 H, with a y+ of the floor of 24.
TEST(TurbulentStepFine, steady) {
  BackwardFacingStep step(2, 3);
  EXPECT_TRUE(step.settle(5e-4, 300, 2e-4));
  EXPECT_NEAR(step.reattachment() / 5.39, 1, 0.05);
  EXPECT_NEAR(step.floor_y_plus() / 24, 1, 0.1);
}
