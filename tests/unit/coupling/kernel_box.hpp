#pragma once
// A box of cells, points in it and fields on it, for tests of transfers between particles and cells.
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "coupling/kernel.hpp"
#include "parallel/session.hpp"
#include "tests/structured_box.hpp"

namespace snag {

inline const MPI_Comm world = MPI_COMM_WORLD;
inline const Vec3 lower{-0.1, 0.2, 0}, upper{0.5, 0.6, 0.8};
inline constexpr double h = 0.05;  // cell size of box()

inline Mesh box(MPI_Comm comm) { return structured_box(comm, lower, upper, {12, 8, 16}); }

/// Points in the box, many of them near walls, edges and corners.
inline std::vector<Vec3> scattered_points(int n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Vec3> points(n);
  for (Vec3& x : points)
    for (int i = 0; i < 3; ++i) {
      double s = share(random);
      if (share(random) < 0.3) s = s < 0.5 ? 0.02 * s : 1 - 0.02 * s;
      x[i] = lower[i] + s * (upper[i] - lower[i]);
    }
  return points;
}

/// Every size-th point: so that most particles lie in cells of other ranks.
template <class T>
std::vector<T> dealt(const std::vector<T>& all) {
  std::vector<T> mine;
  for (std::size_t b = rank_of(world); b < all.size(); b += size_of(world)) mine.push_back(all[b]);
  return mine;
}

inline double wave(const Vec3& x) { return std::sin(5 * x.x + 1) * std::cos(4 * x.y) + x.z * x.z; }

inline std::vector<double> field_of(const Mesh& mesh, double (*f)(const Vec3&)) {
  std::vector<double> field(mesh.n_all_cells());
  for (int c = 0; c < mesh.n_all_cells(); ++c) field[c] = f(mesh.cell_centre[c]);
  return field;
}

inline std::vector<double> averaged(const Kernel& kernel, const std::vector<double>& field) {
  const CellField one{field.data(), 1};
  return kernel.average(std::span(&one, 1));
}

}  // namespace snag
