#include <gtest/gtest.h>

#include <array>

#include "solver/fields/face.hpp"
#include "solver/operators/gradient.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/planar_grid.hpp"

using namespace snag;
using namespace snag::test;

// A boundary layer on a cylinder of 60 plane facets, in cells at the wall a hundred times as thin as the facets bulge: the flux through the
// faces across the layers is that of the layer within 1 % of the speed of the stream.
TEST(CurvedLayers, flux_along_a_boundary_layer) {
  constexpr int n_around = 60;
  constexpr double depth = 0.01, thickness = 2e-3;  // m, of the boundary layer; the cylinder has a radius of 1 m
  const std::vector<double> place = graded(40, 300);
  const auto speed = [](double y) { return 1 - std::exp(-y / thickness); };
  PlanarGrid ring{.n_i = n_around, .n_j = 40, .closed = true, .depth = depth};
  ring.node = [&](int i, int j) {
    const double r = 1 + 0.1 * place[static_cast<std::size_t>(j)], angle = -2 * pi * i / n_around;
    return Vec3{r * std::cos(angle), r * std::sin(angle), 0};
  };
  ring.patches = {"inner", "outer"};
  ring.patch = [](int, int, GridSide side) { return side == GridSide::low_j ? "inner" : "outer"; };
  const Mesh mesh = plane_mesh(ring);
  const double facet = std::cos(pi / n_around);  // its distance from the axis, and the height of cells over that of their edges
  const auto depth_of_layer = [&](const Vec3& x) { return std::hypot(x.x, x.y) / facet - 1; };
  std::vector<Vec3> u, at_boundary;
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3& x = mesh.cell_centre[c];
    u.push_back(speed(depth_of_layer(x)) * unit({-x.y, x.x, 0}));
  }
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) {
    const Vec3& x = mesh.face_centre[f];
    at_boundary.push_back(std::abs(x.z - depth / 2) < 1e-9 ? speed(depth_of_layer(x)) * unit({-x.y, x.x, 0}) : Vec3{});
  }
  const CellMoments moments(mesh);
  const LeastSquares squares(mesh, moments, {Side::value, Side::value, Side::mirror});
  std::vector<Mat3> G(u.size());
  squares.gradient(u, at_boundary, G);
  std::array<std::vector<Vec3>, 3> rows{u, u, u};
  MeanGradient mean(rows);
  mean.set(mesh, G);
  double largest = 0;
  for (int f = 0; f < mesh.n_interior; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const Vec3 &x = mesh.face_centre[f], &S = mesh.face_vector[f], along = unit({-x.y, x.x, 0});
    if (std::abs(dot(unit(S), along)) < 0.5) continue;
    const double flux = interpolated_flux(mesh, f, blend(mesh.weight[f], u[P], u[N]), mean) / dot(S, along);
    largest = std::max(largest, std::abs(flux - speed(std::hypot(x.x, x.y) - 1)));
  }
  std::printf("largest error of the flux along the layers: %.4f of that of the stream\n", largest);
  EXPECT_LT(largest, 0.01);
}
