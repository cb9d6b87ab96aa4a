// ranks: 1
// cost: 8
#include <gtest/gtest.h>

#include "tests/verification/solver/nasa_bump.hpp"

using namespace snag;
using namespace snag::test;

// Friction at the top of a bump in cells that are 80 times as thin as the wall curves within one (kappa d^2/h): that of NASA's CFL3D and
// FUN3D with the SST model on their finest grids within 2 %.
TEST(NasaBump, friction_at_the_top) {
  NasaBump bump(2);
  EXPECT_TRUE(march(bump.solver, 0.1, 50));
  const double friction = at(bump.wall(), &WallPlace::friction, 0.75);
  std::printf("%d cells: c_f at x = 0.75 %.6f\n", bump.mesh.n_cells, friction);
  EXPECT_NEAR(friction / 0.00593328, 1, 0.02);
  EXPECT_NEAR(friction / 0.00595062, 1, 0.02);
}
