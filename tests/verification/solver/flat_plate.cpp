// ranks: 1
// timeout: 900
// cost: 30
#include <gtest/gtest.h>

#include "tests/verification/solver/flat_plate.hpp"

using namespace snag;
using namespace snag::test;

// Friction of a flat plate at Re_x 4.85e6 is that of NASA's CFL3D with the SST model on its finest grid, 0.0026909, within 2 % with first
// cells at y+ 0.4, and within 5 % with those at y+ 5, 30 and 100.
TEST(FlatPlate, friction) {
  constexpr double by_nasa = 0.0026909;
  for (const auto& [y_plus, n_across] : {std::pair{0.4, 96}, {5.0, 72}, {30.0, 56}, {100.0, 56}}) {
    NasaPlate plate(4, n_across, y_plus);
    EXPECT_TRUE(march(plate.solver, 0.1, 40));
    const double friction = plate.friction(0.97);
    std::printf("%d cells: c_f at x = 0.97 %.6f, y+ there %.2f\n", plate.mesh.n_cells, friction,
                at(plate.wall(), &WallPlace::y_plus, 0.97));
    EXPECT_NEAR(friction / by_nasa, 1, y_plus < 1 ? 0.02 : 0.05);
  }
}
