// The pressure equation without a fixed face.
#include "solver/operators/poisson.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/fields/face.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

// No x reaches the mean of the right side where no face is fixed. Round-off leaves such a mean, and once the rest of the residual is as
// small, iterations that aim below it must end. x is then the solution without the mean.
TEST(Poisson, MeanOfTheRightSideIsOutOfReach) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {}, {1, 1, 1}, {6, 5, 4});
  const auto n_all = static_cast<std::size_t>(mesh.n_all_cells());
  std::vector<double> coefficient(static_cast<std::size_t>(mesh.n_faces)), residual(n_all), direction(n_all), product(n_all);
  for (int f = 0; f < mesh.n_interior; ++f) coefficient[f] = conductance(mesh.face_vector[f], mesh.delta[f]);
  std::vector<double> b(n_all), free_of_mean(n_all);
  double mean = 0, squares = 0;
  for (int c = 0; c < mesh.n_cells; ++c) b[c] = std::sin(3.0 * c), mean += b[c] / mesh.n_cells;
  constexpr double left = 1e-6;
  for (int c = 0; c < mesh.n_cells; ++c)
    free_of_mean[c] = b[c] - mean, b[c] = free_of_mean[c] + left, squares += std::pow(free_of_mean[c], 2);

  const auto solution = [&](const std::vector<double>& right_side) {
    Poisson poisson(mesh, Multigrid::boomeramg, true, {residual, direction, product});
    poisson.set_coefficients(coefficient);
    std::vector<double> x(n_all);
    const PoissonReport report = poisson.solve(right_side, x, 1e-10 * std::sqrt(squares));
    EXPECT_LE(report.final, 1e-10 * std::sqrt(squares));
    return x;
  };
  const std::vector<double> x = solution(b), expected = solution(free_of_mean);
  for (int c = 0; c < mesh.n_cells; ++c) EXPECT_NEAR(x[c], expected[c], 1e-8);
}
