#pragma once
// Cells around many points that follow each other closely: the tree of centres is asked once for a group of points, and each point picks
// its cells from the group's by distance, in a loop that vectorises.
#include <span>
#include <vector>

#include "coupling/cell_weights.hpp"

namespace snag {

/// Numbers of the points, those of a box of some tenths of the radius after each other: a sheet has whole patches there, of all its folds.
std::vector<int> order_in_space(std::span<const Vec3> points, double radius);

class CellsAround {
 public:
  /// `weights`: of the owned cells.
  CellsAround(const Mesh& mesh, const CellLocator& locator, const std::vector<double>& weights, double radius)
      : mesh_(mesh), locator_(locator), weights_(weights), radius_(radius) {}
  /// Appends to the rows the owned cells whose centres are nearer than the radius to points[i], with the squared distance (m2) as weight;
  /// `weight`: that of each of these cells. Fast if called for i = 0, 1, 2, ... of the same points, in the order of order_in_space.
  void append(std::span<const Vec3> points, std::size_t i, WeightRows& rows, std::vector<double>& weight);

 private:
  void start_group(std::span<const Vec3> points, std::size_t i, WeightRows& rows);

  const Mesh& mesh_;
  const CellLocator& locator_;
  const std::vector<double>& weights_;
  double radius_;
  std::size_t group_first_ = 0, group_end_ = 0;
  std::vector<int> candidate_, place_;                         // cells near the group, and their places in the rows
  std::vector<double> x_, y_, z_, weight_, distance_squared_;  // of the candidates
};

}  // namespace snag
