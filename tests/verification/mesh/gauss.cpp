// ranks: 1 3
// Geometry against exact integrals.
#include <gtest/gtest.h>

#include <cstdlib>

#include "../../unit/mesh/check.hpp"
#include "../../unit/mesh/sample.hpp"
#include "mesh/import/import.hpp"
#include "tests/sources.hpp"

namespace {

using namespace snag;

Mesh pump() { return import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD); }

/// Largest error of the Gauss gradient, 1/V sum_f phi(x_f) S, of the linear field phi = g.x + 3 with |g| = 1.
double gauss_error(const Mesh& mesh) {
  const Vec3 g = Vec3{2, -3, 6} / 7;
  std::vector<Vec3> gradient(static_cast<std::size_t>(mesh.n_all_cells()));
  for (int f = 0; f < mesh.n_faces; ++f) {
    const Vec3 part = (dot(g, mesh.face_centre[f]) + 3) * mesh.face_vector[f];
    gradient[mesh.owner[f]] += part;
    if (mesh.neighbour[f] >= 0) gradient[mesh.neighbour[f]] -= part;
  }
  double worst = 0;
  for (int c = 0; c < mesh.n_cells; ++c) worst = std::max(worst, norm(gradient[c] / mesh.cell_volume[c] - g));
  return maximum(mesh.comm, worst);
}

// On plane faces the Gauss gradient of a linear field is exact: face centres, vectors and volumes belong together.
TEST(Geometry, GaussGradientOfALinearFieldIsExactOnPlaneFaces) {
  EXPECT_LT(gauss_error(pump()), 1e-10);
  const test::TemporaryFile file(test::mixed_units(6), test::Format::ascii22);
  EXPECT_LT(gauss_error(import_mesh(file.path(), MPI_COMM_WORLD)), 1e-14);
}

// Cells with warped faces still close, tile the cube and have its first moment: volumes, centres and face vectors are those of one and the
// same polyhedron.
TEST(Geometry, WarpedCellsTileTheCube) {
  const test::TemporaryFile file(test::warped_cube(8, 0.3), test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  EXPECT_LT(test::closure(mesh), 1e-15);
  EXPECT_NEAR(test::volume(mesh), 1, 1e-14);
  std::vector<Vec3> moment;
  for (int c = 0; c < mesh.n_cells; ++c) moment.push_back(mesh.cell_volume[c] * mesh.cell_centre[c]);
  EXPECT_LT(norm(sum(mesh.comm, moment) - Vec3{0.5, 0.5, 0.5}), 1e-14);
}

// Linear interpolation to the face is exact for a linear field where the line of centres meets the face: with weights off by skewness it
// errs by g.(x_f - x_line) only.
TEST(Geometry, WeightsInterpolateLinearFieldsOnTheLineOfCentres) {
  const Mesh mesh = pump();
  const Vec3 g = Vec3{2, -3, 6} / 7;
  for (int f = 0; f < mesh.n_interior; ++f) {
    const Vec3 x_P = mesh.cell_centre[mesh.owner[f]], x_N = x_P + mesh.delta[f];
    EXPECT_NEAR(norm(x_N - mesh.cell_centre[mesh.neighbour[f]]), 0, 1e-15);
    const Vec3 on_line = mesh.weight[f] * x_P + (1 - mesh.weight[f]) * x_N;
    EXPECT_LT(std::abs(dot(on_line - mesh.face_centre[f], unit(mesh.face_vector[f]))), 1e-14);  // in the plane of the face
    const double interpolated = mesh.weight[f] * dot(g, x_P) + (1 - mesh.weight[f]) * dot(g, x_N);
    EXPECT_NEAR(interpolated, dot(g, on_line), 1e-14);
  }
}

}  // namespace
