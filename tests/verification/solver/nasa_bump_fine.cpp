// ranks: 1
// labels: long
// timeout: 2400
// cost: 230
#include <gtest/gtest.h>

#include "tests/verification/solver/nasa_bump.hpp"

using namespace snag;
using namespace snag::test;

// Three grids: friction at the top of the bump within 2 % of CFL3D's and FUN3D's with the SST model, before and behind it within 3 % of
// their mean; drag by friction, drag by pressure and lift within 2, 3 and 2 % of CFL3D's on 901,120 cells.
TEST(NasaBumpFine, three_grids) {
  // NASA's codes are compressible. Forces at a Mach number of 0.2 over those of incompressible flow: OpenFOAM 1912, rhoSimpleFoam over
  // simpleFoam with SST on the finest of these grids. At Mach 0.02 the compressible program gives the incompressible forces within 0.3 %.
  constexpr struct { double pressure, friction, lift; } of_mach_number{1.058, 0.995, 1.027};
  constexpr std::array grids{2, 3, 4};
  constexpr std::array places{0.6321975, 0.75, 0.8678025};
  constexpr std::array cfl3d{0.00502471, 0.00593328, 0.00260246}, fun3d{0.0050439, 0.00595062, 0.0026322};
  std::array<std::array<double, 3>, 3> friction{};  // by place and grid
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const int m = grids[i];
    NasaBump bump(m);
    EXPECT_TRUE(march(bump.solver, 0.2 / m, 40 * m));  // after 25 m steps friction drifts by 0.12 % on the first grid
    const double before = at(bump.wall(), &WallPlace::friction, 0.75);
    march(bump.solver, 0.2 / m, 5 * m);
    const std::vector<WallPlace> wall = bump.wall();
    double y_plus = 0;
    for (const WallPlace& place : wall) y_plus = std::max(y_plus, place.x > 0.1 ? place.y_plus : 0);
    const PatchForce force = patch_force(bump.solver.flow, bump.mesh.patch_index("bump"), {});
    const double c_p = force.pressure.x / 0.75, c_v = force.friction.x / 0.75,
                 c_l = force.pressure.y / 0.75;  // rho U^2/2 times 1.5 m times 1 m
    std::printf("%d cells: y+ up to %.2f, drag by pressure %.6f, by friction %.6f, lift %.5f; c_f", bump.mesh.n_cells, y_plus, c_p, c_v,
                c_l);
    for (std::size_t k = 0; k < places.size(); ++k) {
      friction[k][i] = at(wall, &WallPlace::friction, places[k]);
      std::printf(" %.6f (x %.3f)", friction[k][i], places[k]);
    }
    std::printf("\n");
    EXPECT_NEAR(friction[1][i] / before, 1, 1e-3);
    for (const WallPlace& place : wall) print_row("bump-wall", m, {place.x, place.friction, place.pressure});
    if (m < 4) continue;
    EXPECT_NEAR(c_v * of_mach_number.friction / 0.0031819, 1, 0.02);
    EXPECT_NEAR(c_p * of_mach_number.pressure / 0.00040024, 1, 0.03);
    EXPECT_NEAR(c_l * of_mach_number.lift / 0.0250421, 1, 0.02);
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    const GridLimit limit = grid_limit(grids, friction[k]);
    std::printf("x %.7g: c_f on infinitely fine grids %.6f, uncertainty of the finest %.6f; finest over CFL3D's %.4f, FUN3D's %.4f\n",
                places[k], limit.limit, limit.uncertainty, friction[k][2] / cfl3d[k], friction[k][2] / fun3d[k]);
    const double mean = 0.5 * (cfl3d[k] + fun3d[k]);
    EXPECT_NEAR(friction[k][2] / mean, 1, k == 1 ? 0.01 : 0.03);
    EXPECT_LT(limit.uncertainty / mean, 0.02);
  }
  for (const double found : friction[1]) {
    EXPECT_NEAR(found / cfl3d[1], 1, 0.02);
    EXPECT_NEAR(found / fun3d[1], 1, 0.02);
  }
}
