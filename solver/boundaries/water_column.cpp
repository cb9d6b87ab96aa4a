#include "solver/boundaries/water_column.hpp"

#include <cmath>

#include "parallel/sum.hpp"
#include "solver/fields/face.hpp"
#include "solver/operators/poisson.hpp"

namespace snag {

namespace {
constexpr double solved = 1e-12;  // residual over right side: G is then the same on any number of ranks, nearly to the bit
}

double column_conductance(const Mesh& mesh, const std::vector<PatchBoundary>& conditions, const Patch& patch,
                          ControlledOutlets controlled) {
  const auto is_open = [&](const Boundary& boundary) {
    return controlled == ControlledOutlets::open ? boundary.pressure_side() == Side::value : boundary.pressure_is_prescribed();
  };
  std::vector<double> coefficient(static_cast<std::size_t>(mesh.n_faces)), phi(static_cast<std::size_t>(mesh.n_all_cells()));
  std::vector<double> right_side(phi.size());
  for (int f = 0; f < mesh.n_interior; ++f) coefficient[f] = conductance(mesh.face_vector[f], mesh.delta[f]);
  for (std::size_t p = 0; p < conditions.size(); ++p) {
    if (!is_open(*conditions[p].boundary) && mesh.patches[p].name != patch.name) continue;
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) coefficient[f] = conductance(mesh.face_vector[f], mesh.delta[f]);
  }
  double square = 0;
  for (int f = patch.first; f < patch.end(); ++f) right_side[mesh.owner[f]] += coefficient[f];
  for (int c = 0; c < mesh.n_cells; ++c) square += right_side[c] * right_side[c];

  std::vector<double> residual(phi.size()), direction(phi.size()), product(phi.size());
  Poisson poisson(mesh, Multigrid::boomeramg, false, {residual, direction, product});
  poisson.set_coefficients(coefficient);
  poisson.solve(right_side, phi, solved * std::sqrt(sum(mesh.comm, square)));
  std::vector<double> through;
  for (int f = patch.first; f < patch.end(); ++f) through.push_back(coefficient[f] * (1 - phi[mesh.owner[f]]));
  return sum(mesh.comm, std::span<const double>(through));
}

}  // namespace snag
