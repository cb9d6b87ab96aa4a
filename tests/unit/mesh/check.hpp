#pragma once
// What holds for every mesh, whatever its source and number of ranks; used by the tests of this folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/mesh.hpp"
#include "parallel/sum.hpp"

namespace snag::test {

/// Largest |sum S| / sum |S| over the owned cells.
inline double closure(const Mesh& mesh) {
  std::vector<Vec3> total(static_cast<std::size_t>(mesh.n_all_cells()));
  std::vector<double> area(total.size(), 0);
  for (int f = 0; f < mesh.n_faces; ++f) {
    total[mesh.owner[f]] += mesh.face_vector[f], area[mesh.owner[f]] += norm(mesh.face_vector[f]);
    if (mesh.neighbour[f] >= 0) total[mesh.neighbour[f]] -= mesh.face_vector[f], area[mesh.neighbour[f]] += norm(mesh.face_vector[f]);
  }
  double worst = 0;
  for (int c = 0; c < mesh.n_cells; ++c) worst = std::max(worst, norm(total[c]) / area[c]);
  return maximum(mesh.comm, worst);
}

inline double volume(const Mesh& mesh) {
  return sum(mesh.comm, std::span(mesh.cell_volume.data(), static_cast<std::size_t>(mesh.n_cells)));
}

/// Sums over all cells and faces, weighted by the numbers of the file: the same on any number of ranks if every array is.
inline std::vector<double> fingerprint(const Mesh& mesh) {
  std::vector<double> cell, face;
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 x = mesh.cell_centre[c];
    double nodes = 0;
    for (int i = mesh.cell_node_start[c]; i < mesh.cell_node_start[c + 1]; ++i)
      nodes = 1.5 * nodes + static_cast<double>(mesh.node_id[mesh.cell_node[i]] % 1000) + mesh.node[mesh.cell_node[i]].x;
    cell.push_back(std::sin(static_cast<double>(mesh.cell_id[c])) * (mesh.cell_volume[c] + x.x + 2 * x.y + 3 * x.z + 1e-3 * nodes +
                                                                     mesh.cell_zone[c] + static_cast<int>(mesh.cell_shape[c])));
  }
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    if (P >= mesh.n_cells) continue;  // counted by the rank that owns the owner
    const Vec3 &S = mesh.face_vector[f], &x = mesh.face_centre[f], &d = mesh.delta[f];
    const double other = N < 0 ? -1 : static_cast<double>(mesh.cell_id[N]);
    face.push_back(std::sin(static_cast<double>(mesh.cell_id[P]) + 0.37 * other) *
                   (S.x + 2 * S.y + 3 * S.z + x.x - x.y + 0.3 * x.z + d.x + 5 * d.y - d.z + mesh.weight[f]));
  }
  return {sum(mesh.comm, cell), sum(mesh.comm, face)};
}

/// Everything mesh.hpp promises about indices, orientation and halo.
inline void expect_sound(const Mesh& mesh) {
  ASSERT_EQ(mesh.cell_centre.size(), static_cast<std::size_t>(mesh.n_all_cells()));
  ASSERT_EQ(mesh.owner.size(), static_cast<std::size_t>(mesh.n_faces));
  EXPECT_EQ(sum(mesh.comm, std::int64_t{mesh.n_cells}), mesh.n_cells_global);
  int end = mesh.n_interior;
  for (const Patch& patch : mesh.patches) {
    EXPECT_EQ(patch.first, end);
    end = patch.end();
    EXPECT_EQ(sum(mesh.comm, std::int64_t{patch.count}), patch.count_global);
  }
  EXPECT_EQ(end, mesh.n_faces);
  auto id = mesh.cell_id;
  mesh.halo.exchange(std::span(id));
  EXPECT_EQ(id, mesh.cell_id);  // ghosts carry the numbers of their owners
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    ASSERT_TRUE(P >= 0 && P < mesh.n_all_cells() && N < mesh.n_all_cells());
    EXPECT_EQ(N < 0, f >= mesh.n_interior);
    EXPECT_TRUE(P < mesh.n_cells || (N >= 0 && N < mesh.n_cells));
    if (N >= 0) {
      EXPECT_LE(mesh.cell_id[P], mesh.cell_id[N]);
    }
    EXPECT_GT(dot(mesh.face_vector[f], mesh.delta[f]), 0);
    const int* node = &mesh.face_node[mesh.face_node_start[f]];
    const Vec3 first = mesh.node[node[1]] - mesh.node[node[0]], second = mesh.node[node[2]] - mesh.node[node[0]];
    EXPECT_GT(dot(cross(first, second), mesh.face_vector[f]), 0);
  }
  std::vector<int> uses(static_cast<std::size_t>(mesh.n_faces), 0);
  for (int c = 0; c < mesh.n_cells; ++c)
    for (int i = mesh.cell_face_start[c]; i < mesh.cell_face_start[c + 1]; ++i) {
      const int f = mesh.cell_face[i];
      EXPECT_TRUE(mesh.owner[f] == c || mesh.neighbour[f] == c);
      ++uses[f];
    }
  for (int f = 0; f < mesh.n_faces; ++f)
    EXPECT_EQ(uses[f], (mesh.owner[f] < mesh.n_cells) + (mesh.neighbour[f] >= 0 && mesh.neighbour[f] < mesh.n_cells));
}

}  // namespace snag::test
