// ranks: 1 2 3
// The velocity that particles see is that of the fluxes where the kernel is as wide as the cells, and that of the cells where it is not.
#include <gtest/gtest.h>

#include <numeric>

#include "coupling/water_prediction.hpp"
#include "parallel/sum.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

namespace {

/// Largest deviation from a velocity that is linear in space, when the fluxes are exact and the velocities of the cells are wrong by 1 m/s.
double deviation(const Mesh& mesh, double kernel_width, const Mat3& G) {
  const auto u = [&](const Vec3& x) { return Vec3{3, -1, 2} + G * x; };
  Flow flow(mesh);
  flow.time_step_size = 1;
  flow.reaction.assign(static_cast<std::size_t>(mesh.n_cells), {});
  for (int c = 0; c < mesh.n_all_cells(); ++c) flow.velocity[c] = u(mesh.cell_centre[c]) + Vec3{1, 0, 0}, flow.velocity_gradient[c] = G;
  for (int f = 0; f < mesh.n_faces; ++f) flow.flux[f] = dot(u(mesh.face_centre[f]), mesh.face_vector[f]);
  WaterPrediction prediction(flow, kernel_width);
  prediction.begin_step(1);
  prediction.end_step();
  prediction.begin_step(1);
  std::vector<int> cells(static_cast<std::size_t>(mesh.n_cells));
  std::iota(cells.begin(), cells.end(), 0);
  prediction.predict(cells);
  double largest = 0;
  for (int c = 0; c < mesh.n_cells; ++c) largest = std::max(largest, norm(prediction.velocity()[c] - u(mesh.cell_centre[c])));
  return maximum(mesh.comm, largest);
}

}  // namespace

TEST(FluxVelocity, IsExactForLinearFields) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {4, 4, 4});
  const Mat3 shear{Vec3{1, 2, -1}, Vec3{0.5, -3, 4}, Vec3{-2, 1, 2}};
  EXPECT_LT(deviation(mesh, 1, shear), 1e-12);
  EXPECT_NEAR(deviation(mesh, 0.01, shear), 1, 1e-12);
  EXPECT_NEAR(deviation(mesh, 0, shear), 1, 1e-12);
}

TEST(FluxVelocity, IsExactAcrossAPeriod) {
  EXPECT_LT(deviation(tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {4, 4, 4}, {true, true, false}), 1, {}), 1e-12);
  EXPECT_LT(deviation(structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {1, 4, 4}, {true, true, true}), 1, {}), 1e-12);
}
