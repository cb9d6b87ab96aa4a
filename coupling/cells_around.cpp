#include "coupling/cells_around.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace snag {

namespace {
// A ball about a group holds (1.35)^3 = 2.5 times the cells of a single point: that many distances cost less than asking the tree.
constexpr double group_diameter = 0.7;  // in radii
constexpr std::size_t most_points = 64;
constexpr double box_side = group_diameter / 1.75;  // its diagonal is less than the group's diameter
}  // namespace

std::vector<int> order_in_space(std::span<const Vec3> points, double radius) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  if (!(radius > 0)) return order;
  constexpr int bits = 21;  // of a box's number along an axis
  constexpr double most = (1 << (bits - 1)) - 1;
  std::vector<std::pair<std::uint64_t, int>> by_box;
  for (const int b : order) {
    std::uint64_t box = 0;
    for (int axis = 0; axis < 3; ++axis)
      box = box << bits |
            static_cast<std::uint64_t>(std::fmin(std::fmax(std::floor(points[b][axis] / (box_side * radius)), -most), most) + most);
    by_box.emplace_back(box, b);
  }
  std::sort(by_box.begin(), by_box.end());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = by_box[i].second;
  return order;
}

void CellsAround::start_group(std::span<const Vec3> points, std::size_t i, WeightRows& rows) {
  Vec3 low = points[i], high = points[i];
  group_first_ = i;
  for (group_end_ = i + 1; group_end_ < points.size() && group_end_ < i + most_points; ++group_end_) {
    Vec3 wider_low = low, wider_high = high;
    for (int axis = 0; axis < 3; ++axis) {
      wider_low[axis] = std::min(low[axis], points[group_end_][axis]);
      wider_high[axis] = std::max(high[axis], points[group_end_][axis]);
    }
    if (norm(wider_high - wider_low) > group_diameter * radius_) break;
    low = wider_low, high = wider_high;
  }
  candidate_.clear();
  locator_.within(0.5 * (low + high), radius_ * (1 + 1e-9) + 0.5 * norm(high - low), candidate_);
  const std::size_t n = candidate_.size();
  place_.resize(n);
  for (auto* array : {&x_, &y_, &z_, &weight_, &distance_squared_}) array->resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const Vec3& centre = mesh_.cell_centre[candidate_[s]];
    x_[s] = centre.x, y_[s] = centre.y, z_[s] = centre.z;
    weight_[s] = weights_[candidate_[s]];
    place_[s] = rows.place_of(candidate_[s]);
  }
}

void CellsAround::append(std::span<const Vec3> points, std::size_t i, WeightRows& rows, std::vector<double>& weight) {
  if (i < group_first_ || i >= group_end_) start_group(points, i, rows);
  const Vec3 p = points[i];
  const std::size_t n = candidate_.size();
  double* d2 = distance_squared_.data();
  const double *x = x_.data(), *y = y_.data(), *z = z_.data();
#pragma omp simd
  for (std::size_t s = 0; s < n; ++s) d2[s] = (x[s] - p.x) * (x[s] - p.x) + (y[s] - p.y) * (y[s] - p.y) + (z[s] - p.z) * (z[s] - p.z);
  const std::size_t first = rows.place.size();
  rows.place.resize(first + n), rows.weight.resize(first + n), weight.resize(n);
  // Without a branch: every candidate is written, and kept by moving on.
  int* place = rows.place.data() + first;
  double *distance_squared = rows.weight.data() + first, *of_cell = weight.data();
  const double radius_squared = radius_ * radius_;
  std::size_t found = 0;
  for (std::size_t s = 0; s < n; ++s) {
    place[found] = place_[s], distance_squared[found] = d2[s], of_cell[found] = weight_[s];
    found += d2[s] < radius_squared ? 1 : 0;
  }
  rows.place.resize(first + found), rows.weight.resize(first + found), weight.resize(found);
}

}  // namespace snag
