#include "solver/convection/tetrahedra.hpp"

#include <cmath>

#include "base/flat.hpp"
#include "parallel/sum.hpp"

namespace snag {

TetrahedronReconstruction::TetrahedronReconstruction(const Mesh& mesh)
    : mesh_(mesh), is_tetrahedron_(static_cast<std::size_t>(mesh.n_cells)) {
  std::int64_t n_tetrahedra = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    double n_faces = for_each_neighbour(mesh, c, [](int, double) {});
    for (const int f : row(mesh.cell_face_start, mesh.cell_face, c)) n_faces += f >= mesh.n_interior;
    is_tetrahedron_[c] = std::lround(n_faces) == 4;
    n_tetrahedra += is_tetrahedron_[c];
  }
  anywhere_ = sum(mesh.comm, n_tetrahedra) > 0;
  if (!anywhere_) return;
  gradient_.resize(static_cast<std::size_t>(mesh.n_all_cells()));
  near_.resize(static_cast<std::size_t>(mesh.n_all_cells()));
}

const std::vector<Mat3>& TetrahedronReconstruction::gradient(const std::vector<Mat3>& G) {
  if (!anywhere_) return G;
  for (int c = 0; c < mesh_.n_cells; ++c) {
    gradient_[c] = is_tetrahedron_[c] != 0 ? mean_with_neighbours(mesh_, c, G) : G[c];
  }
  mesh_.halo.exchange(flat(gradient_), 9);
  return gradient_;
}

TetrahedronRanges TetrahedronReconstruction::ranges(std::span<const Vec3> u, const std::vector<Side>& sides, std::span<const Vec3> given) {
  if (!anywhere_) return {};
  for (int c = 0; c < mesh_.n_cells; ++c) near_[c] = three(range_of_neighbours(mesh_, c, u));
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    if (sides[p] != Side::value) continue;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      VelocityRange& range = near_[mesh_.owner[f]];
      const FourValues at_face = four(given[f - mesh_.n_interior]);
      range = three(enclosing(four(range), {at_face, at_face}));
    }
  }
  mesh_.halo.exchange(std::span(near_.empty() ? nullptr : &near_[0].lowest.x, 6 * near_.size()), 6);
  return {.near = near_, .is_tetrahedron = is_tetrahedron_};
}

}  // namespace snag
