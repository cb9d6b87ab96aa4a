// ranks: 1 3
// long ranks: 2
#include <gtest/gtest.h>

#include <utility>

#include "parallel/sum.hpp"
#include "solver/operators/cell_matrix.hpp"
#include "solver/operators/gradient.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

namespace {

constexpr Vec3 slope{1, -2, 3};

Mesh tetrahedra() { return tetrahedral_box(MPI_COMM_WORLD, {.upper = {2, 1, 1}, .distortion = 0.15}, {4, 3, 6}); }

/// Gradient of a linear field with one kind of knowledge on all patches; returns the largest error of both forms.
double largest_error(const Mesh& mesh, Side side) {
  const CellMoments moments(mesh);
  const LeastSquares squares(mesh, moments, std::vector<Side>(mesh.patches.size(), side));
  std::vector<double> phi(mesh.n_all_cells()), given(mesh.n_faces - mesh.n_interior), values(given.size());
  std::vector<Vec3> g(phi.size()), gauss(phi.size());
  for (int c = 0; c < mesh.n_cells; ++c) phi[c] = dot(slope, mesh.cell_centre[c]);
  mesh.halo.exchange(phi);
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f)
    given[f - mesh.n_interior] = side == Side::value ? dot(slope, mesh.face_centre[f]) : dot(slope, unit(mesh.face_vector[f]));
  squares.gradient(phi, given, g);
  fill_boundary(mesh, squares, phi, g, given, values);
  gauss_gradient(mesh, squares, phi, values, g, gauss);
  double error = 0;
  for (int c = 0; c < mesh.n_all_cells(); ++c) error = std::max({error, norm(g[c] - slope), norm(gauss[c] - slope)});
  return maximum(mesh.comm, error);
}

}  // namespace

// Gradients of linear fields are exact on distorted tetrahedra, ghosts included, whether the boundary gives values or slopes.
TEST(Gradients, exact_for_linear_fields) {
  const Mesh mesh = tetrahedra();
  EXPECT_LT(largest_error(mesh, Side::value), 1e-12);
  EXPECT_LT(largest_error(mesh, Side::slope), 1e-12);
}

// Where the boundary gives nothing, cells with too few neighbours take the open directions from them instead of dividing by almost nothing.
TEST(Gradients, bounded_where_nothing_is_known) { EXPECT_LT(largest_error(tetrahedra(), Side::none), 20); }

// The mean of neighbours leaves a constant gradient as it is, across ranks too, and takes none of the cell's own gradient.
TEST(Gradients, mean_of_neighbours) {
  const Mesh mesh = tetrahedra();
  std::vector<Vec3> g(mesh.n_all_cells(), slope);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 own = std::exchange(g[c], 100 * slope);
    EXPECT_LT(norm(mean_of_neighbours(mesh, c, g) - slope), 1e-14) << "cell " << mesh.cell_id[c];
    g[c] = own;
  }
}

// The sum of V grad p over the cells is the sum of p S over the boundary, whatever p.
TEST(Gradients, gauss_form_telescopes) {
  const Mesh mesh = tetrahedra();
  const CellMoments moments(mesh);
  const LeastSquares squares(mesh, moments, std::vector<Side>(mesh.patches.size(), Side::slope));
  std::vector<double> p(mesh.n_all_cells()), given(mesh.n_faces - mesh.n_interior), values(given.size());
  std::vector<Vec3> g(p.size()), gauss(p.size());
  for (int c = 0; c < mesh.n_cells; ++c) p[c] = std::sin(static_cast<double>(37 * mesh.cell_id[c] % 101));
  mesh.halo.exchange(p);
  squares.gradient(p, given, g);
  fill_boundary(mesh, squares, p, g, given, values);
  gauss_gradient(mesh, squares, p, values, g, gauss);
  std::vector<Vec3> terms;
  for (int c = 0; c < mesh.n_cells; ++c) terms.push_back(mesh.cell_volume[c] * gauss[c]);
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) terms.push_back(-values[f - mesh.n_interior] * mesh.face_vector[f]);
  EXPECT_LT(norm(sum(mesh.comm, std::span<const Vec3>(terms))), 1e-13);
}

// Gauss-Seidel sweeps reach the tolerance that they report, on several ranks.
TEST(CellMatrix, sweeps) {
  const Mesh mesh = tetrahedra();
  CellMatrix matrix(mesh);
  std::vector<double> diagonal(mesh.n_all_cells(), 0.5), exact(mesh.n_all_cells()), b(mesh.n_all_cells()), x(mesh.n_all_cells());
  for (int c = 0; c < mesh.n_cells; ++c) exact[c] = std::cos(static_cast<double>(mesh.cell_id[c]));
  mesh.halo.exchange(exact);
  for (int f = 0; f < mesh.n_interior; ++f) {
    matrix.value[matrix.place_of_owner[f]] = -2, matrix.value[matrix.place_of_neighbour[f]] = -0.5;
    diagonal[mesh.owner[f]] += 2, diagonal[mesh.neighbour[f]] += 0.5;
  }
  for (int c = 0; c < mesh.n_cells; ++c) {
    b[c] = diagonal[c] * exact[c];
    for (int k = matrix.row_start[c]; k < matrix.row_start[c + 1]; ++k) b[c] += matrix.value[k] * exact[matrix.column[k]];
  }
  const auto report = solve_rows<double>(mesh, matrix, diagonal, b, x, 1e-12, 500);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.final, 1e-12);
  for (int c = 0; c < mesh.n_all_cells(); ++c) EXPECT_NEAR(x[c], exact[c], 1e-10);
}

// In layers of thin cells, where sweeps alone stall, the solution reaches the tolerance too, and is positive where it has to be although it
// spans powers of ten.
TEST(CellMatrix, thin_layers) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {5, 5, 40});
  CellMatrix matrix(mesh);
  std::vector<double> diagonal(mesh.n_all_cells(), 1), exact(mesh.n_all_cells()), b(mesh.n_all_cells());
  for (int f = 0; f < mesh.n_interior; ++f) {
    const double coupling = std::abs(mesh.face_vector[f].z) > 0 ? 1000 : 0.3;
    matrix.value[matrix.place_of_owner[f]] = matrix.value[matrix.place_of_neighbour[f]] = -coupling;
    diagonal[mesh.owner[f]] += coupling, diagonal[mesh.neighbour[f]] += coupling;
  }
  for (int c = 0; c < mesh.n_all_cells(); ++c)
    exact[c] = std::exp(-8 * mesh.cell_centre[c].z) * (1.1 + std::cos(9 * mesh.cell_centre[c].x));
  for (int c = 0; c < mesh.n_cells; ++c) {
    b[c] = diagonal[c] * exact[c];
    for (int k = matrix.row_start[c]; k < matrix.row_start[c + 1]; ++k) b[c] += matrix.value[k] * exact[matrix.column[k]];
  }
  std::vector<double> x(b.size(), 1);
  const auto report = solve_rows<double>(mesh, matrix, diagonal, b, x, 1e-11, 1000, true);
  std::printf("%d sweeps, residual %.2e, at first %.2e\n", report.sweeps, report.final, report.initial);
  EXPECT_TRUE(report.converged);
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    EXPECT_NEAR(x[c], exact[c], 1e-6);
    EXPECT_GT(x[c], 0);
  }
  std::vector<Vec3> b3, x3(b.size()), diagonal3;
  for (std::size_t c = 0; c < b.size(); ++c) {
    b3.push_back({b[c], -b[c], 2 * b[c]}), diagonal3.push_back({diagonal[c], diagonal[c], diagonal[c]});
  }
  EXPECT_TRUE(solve_rows<Vec3>(mesh, matrix, diagonal3, b3, x3, 1e-11, 1000).converged);
  for (int c = 0; c < mesh.n_all_cells(); ++c) EXPECT_LT(norm(x3[c] - exact[c] * Vec3{1, -1, 2}), 1e-6);

  // Rows whose components depend on each other as those at a plane of symmetry: c n n^T, with its diagonal in that of the row.
  std::vector<CoupledRow> coupled;
  const Vec3 n = unit(Vec3{1, 2, -2});
  for (int c = 0; c < mesh.n_cells; c += 7) {
    const double k = 50 * diagonal[c];
    diagonal3[c] += k * Vec3{n.x * n.x, n.y * n.y, n.z * n.z};
    coupled.push_back({c, k * Vec3{n.y * n.z, n.x * n.z, n.x * n.y}});
    b3[c] += k * exact[c] * dot(n, Vec3{1, -1, 2}) * n;
  }
  std::fill(x3.begin(), x3.end(), Vec3{});
  const auto of_coupled = solve_rows<Vec3>(mesh, matrix, diagonal3, b3, x3, 1e-11, 1000, false, coupled);
  EXPECT_TRUE(of_coupled.converged);
  for (int c = 0; c < mesh.n_all_cells(); ++c) EXPECT_LT(norm(x3[c] - exact[c] * Vec3{1, -1, 2}), 1e-6);
}
