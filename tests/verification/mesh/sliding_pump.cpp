// ranks: 1 3
// The coarse pump: unstructured tetrahedra, cylinder and full disc in one interface, vane and walls beside it.
#include <cstdlib>
#include <iostream>

#include "mesh/import/import.hpp"
#include "tests/sources.hpp"
#include "tests/unit/mesh/sliding_check.hpp"

namespace {

using namespace snag;

// At any angle facets tile the faces of both sides and cells of both zones close to 1e-12, the whole is the surface of revolution, and
// the turning of the rotor changes no volume.
TEST(SlidingPump, IsExactAtAnyAngle) {
  Mesh mesh = import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD);
  const SlidingInterface interface(mesh, {});
  interface.curve(mesh);
  constexpr double exact = 2 * std::numbers::pi * 0.1045 * 0.08 + std::numbers::pi * 0.05 * 0.05;  // 0.0603814 m2
  const std::int64_t n_faces = mesh.patches[mesh.patch_index("interface_rotor")].count_global;
  for (const double degrees : {0.0, -7.0, 1.44, 90.0, 213.7, 3600.1}) {
    const auto errors = test::interface_errors(mesh, interface, degrees * std::numbers::pi / 180);
    if (rank_of(mesh.comm) == 0)
      std::cout << degrees << " degrees: " << errors.facets << " facets of " << n_faces << " faces; tiling " << errors.tiling
                << ", coverage " << errors.coverage << ", closure " << errors.closure << ", area " << errors.area / exact - 1 << '\n';
    EXPECT_LT(errors.tiling, 1e-12);
    EXPECT_LT(errors.coverage, 1e-12);
    EXPECT_LT(errors.closure, 1e-12);
    EXPECT_NEAR(errors.area, exact, 1e-12 * exact);
    EXPECT_GT(errors.facets, degrees == -7 ? n_faces - 1 : 2 * n_faces);
    EXPECT_LT(errors.facets, 8 * n_faces);
  }
  EXPECT_LT(test::swept_by_cells(mesh, interface), 1e-12);
  for (int c = 0; c < mesh.n_cells; ++c) EXPECT_GT(mesh.cell_volume[c], 0);
  for (int f = 0; f < mesh.n_interior; ++f) EXPECT_GT(dot(mesh.face_vector[f], mesh.delta[f]), 0);
}

}  // namespace
