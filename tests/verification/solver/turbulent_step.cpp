// ranks: 1
#include <gtest/gtest.h>

#include "tests/verification/solver/backward_facing_step.hpp"

using namespace snag;
using namespace snag::test;

// The steady flow behind a step: three correctors reach it at Courant numbers of 40; reattachment is the other program's 5.18 H within 5 %,
// y+ of the floor its 52 within 10 %.
TEST(TurbulentStep, steady) {
  BackwardFacingStep step(1, 3);
  EXPECT_TRUE(step.settle(1e-3, 150, 2e-4));
  EXPECT_NEAR(step.reattachment() / 5.18, 1, 0.05);
  EXPECT_NEAR(step.floor_y_plus() / 52, 1, 0.1);
}

// The same in time with one corrector at Courant numbers of 8, where fluxes that are extrapolated in full let it wander by a tenth.
TEST(TurbulentStep, one_corrector) {
  BackwardFacingStep step(1, 1);
  step.settle(2e-4, 400, 1e-3);
  EXPECT_NEAR(step.reattachment() / 5.13, 1, 0.02);
}
