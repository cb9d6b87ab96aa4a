#pragma once
// Cells around many points that follow each other closely: the tree of centres is asked once for a patch of points, groups of them pick
// theirs from its answer by distance, and each point its own from those of its group, in loops that vectorise.
#include <span>
#include <vector>

#include "coupling/cell_weights.hpp"

namespace snag {

/// Numbers of the points along a curve through boxes of some tenths of the radius: a sheet has whole patches there, of all its folds.
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
  /// Points [first, end) that lie close together, in a ball.
  struct Ball {
    std::size_t first = 0, end = 0;
    Vec3 centre;
    double radius = 0;  // m
    bool has(std::size_t i) const { return i >= first && i < end; }
  };
  /// Cells with what the loops need of them.
  struct Candidates {
    std::vector<int> number;  // of the cell, or its place in the rows
    std::vector<double> x, y, z, weight;
    void resize(std::size_t n);
  };
  static Ball ball_from(std::span<const Vec3> points, std::size_t i, std::size_t most, double diameter);
  void start_patch(std::span<const Vec3> points, std::size_t i);
  void start_group(std::span<const Vec3> points, std::size_t i, WeightRows& rows);
  void find_near(const Candidates& from, const Vec3& centre, double radius);

  const Mesh& mesh_;
  const CellLocator& locator_;
  const std::vector<double>& weights_;
  double radius_;
  Ball patch_, group_;
  std::vector<int> cell_;
  Candidates of_patch_, of_group_;
  // What find_near found: places in the list of candidates, and of all candidates the squared distances, m2.
  std::vector<int> near_;
  std::vector<double> distance_squared_;
  std::size_t n_near_ = 0;
};

}  // namespace snag
