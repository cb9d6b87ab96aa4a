#include "solver/fields/mean_gradient.hpp"

#include <algorithm>

#include "mesh/geometry.hpp"
#include "solver/fields/face.hpp"

namespace snag {

[[gnu::always_inline]] inline void MeanGradient::set_cell(const Mesh& mesh, std::span<const Mat3> G, int c) {
  Mat3 sum{};
  const double weight = for_each_neighbour(mesh, c, [&](int other, double share) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += share * G[static_cast<std::size_t>(other)][i];
  });
  const Mat3& mean = weight > 0 ? sum : G[static_cast<std::size_t>(c)];
  for (std::size_t i = 0; i < 3; ++i) row_[i][c] = 1 / (weight > 0 ? weight : 1) * mean[i];
}

void MeanGradient::set(const Mesh& mesh, std::span<const Mat3> G) {
  for (int c = 0; c < mesh.n_cells; ++c) set_cell(mesh, G, c);
  for (std::vector<Vec3>& row : row_) mesh.halo.exchange(row);
}

void MeanGradient::set_where_faces_turn(const Mesh& mesh, std::span<const Mat3> G, int zone) {
  const auto is_facet = [&](int f) { return f >= mesh.first_facet && f < mesh.n_interior; };
  for (int c = 0; c < mesh.n_cells; ++c)
    if (mesh.cell_zone[c] == zone || std::ranges::any_of(row(mesh.cell_face_start, mesh.cell_face, c), is_facet)) set_cell(mesh, G, c);
  for (std::vector<Vec3>& row : row_) mesh.halo.exchange(row);
}

}  // namespace snag
