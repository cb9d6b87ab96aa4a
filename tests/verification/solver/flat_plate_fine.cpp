// ranks: 1
// labels: long
// timeout: 2400
// cost: 100
#include <gtest/gtest.h>

#include "tests/verification/solver/flat_plate.hpp"

using namespace snag;
using namespace snag::test;

// Three grids: friction along the plate within 1 % and drag within 1 % of those of NASA's CFL3D and FUN3D with the SST model on their
// finest grids; the law of the wall at x = 0.97 within 3 % of CFL3D's.
TEST(FlatPlateFine, three_grids) {
  constexpr std::array grids{3, 4, 6};
  constexpr std::array log10_y_plus{0.3, 0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.1, 2.5, 2.9, 3.2};
  constexpr std::array u_plus{1.996, 3.952, 5.985, 8.212, 10.24, 12.757, 14.895, 16.846, 19.357, 22.043, 24.768};
  std::array<double, 3> friction{}, drag{};
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const int m = grids[i];
    NasaPlate plate(m, 1.6 / m);
    EXPECT_TRUE(march(plate.solver, 0.1, 40));  // two correctors of 0.03 s leave waves of 1 % along the finest grid
    const double before = plate.friction(0.97);
    march(plate.solver, 0.1, 10);
    friction[i] = plate.friction(0.97), drag[i] = plate.drag();
    EXPECT_NEAR(friction[i] / before, 1, 5e-3);  // it wanders by 0.2 %
    std::printf("%d cells: c_f at x = 0.97 %.6f, drag %.6f\n", plate.mesh.n_cells, friction[i], drag[i]);
    EXPECT_NEAR(friction[i] / 0.00269085, 1, 0.01);
    EXPECT_NEAR(drag[i] / 0.00285332, 1, 0.01);
    EXPECT_NEAR(drag[i] / 0.00284417, 1, 0.01);
    for (const auto& [x, by_cfl3d] : {std::pair{0.3, 0.0032064}, {0.5, 0.0029654}, {1.2, 0.0026109}, {1.8, 0.0024694}})
      EXPECT_NEAR(plate.friction(x) / by_cfl3d, 1, 0.02) << x;

    const double friction_velocity = std::sqrt(0.5 * plate.friction(0.97)), nu = 1 / NasaPlate::reynolds;
    const auto u_plus_at = [&](double y_plus) {
      return speed_at(plate.solver.flow, 0.97, y_plus * nu / friction_velocity) / friction_velocity;
    };
    for (std::size_t k = 0; k < u_plus.size(); ++k)
      EXPECT_NEAR(u_plus_at(std::pow(10, log10_y_plus[k])) / u_plus[k], 1, 0.03) << "y+ " << std::pow(10, log10_y_plus[k]);
    for (const WallPlace& place : plate.wall()) print_row("plate-wall", m, {place.x, place.friction, place.y_plus});
    for (int at = 0; at < 78; ++at) print_row("plate-profile", m, {std::pow(10, 0.05 * at), u_plus_at(std::pow(10, 0.05 * at))});
  }
  const GridLimit of_friction = grid_limit(grids, friction), of_drag = grid_limit(grids, drag);
  std::printf("on infinitely fine grids c_f %.6f, uncertainty of the finest %.6f; drag %.6f, uncertainty %.6f\n", of_friction.limit,
              of_friction.uncertainty, of_drag.limit, of_drag.uncertainty);
  EXPECT_LT(of_drag.uncertainty / drag[2], 0.02);
}
