#include "coupling/cells_around.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace snag {

namespace {
// In radii. A ball about a group holds (1.35)^3 = 2.5 times the cells of a single point, one about a patch 5 times: that many distances
// cost less than asking the tree.
constexpr double group_diameter = 0.7, patch_diameter = 1.4;
constexpr std::size_t most_in_group = 64, most_in_patch = 1024;
constexpr double slack = 1 + 1e-9;                  // against round-off in the radius of a ball
constexpr double box_side = group_diameter / 1.75;  // its diagonal is less than the group's diameter

/// The bits of a box's number along an axis, two places free behind each.
std::uint64_t spaced(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}
}  // namespace

std::vector<int> order_in_space(std::span<const Vec3> points, double radius) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  if (!(radius > 0)) return order;
  constexpr int bits = 21;  // of a box's number along an axis
  constexpr double most = (1 << (bits - 1)) - 1;
  std::vector<std::pair<std::uint64_t, int>> by_box;  // along Morton's curve: boxes near each other in all directions follow each other
  by_box.reserve(points.size());
  for (const int b : order) {
    std::uint64_t box = 0;
    for (int axis = 0; axis < 3; ++axis)
      box = box << 1 |
            spaced(static_cast<std::uint64_t>(std::fmin(std::fmax(std::floor(points[b][axis] / (box_side * radius)), -most), most) + most));
    by_box.emplace_back(box, b);
  }
  std::sort(by_box.begin(), by_box.end());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = by_box[i].second;
  return order;
}

void CellsAround::Candidates::resize(std::size_t n) {
  number.resize(n);
  for (auto* array : {&x, &y, &z, &weight}) array->resize(n);
}

/// Around points[i] and those after it, at most so many, as long as their box has no longer diagonal than the diameter.
CellsAround::Ball CellsAround::ball_from(std::span<const Vec3> points, std::size_t i, std::size_t most, double diameter) {
  Vec3 low = points[i], high = points[i];
  std::size_t end = i + 1;
  for (; end < points.size() && end < i + most; ++end) {
    Vec3 wider_low = low, wider_high = high;
    for (int axis = 0; axis < 3; ++axis) {
      wider_low[axis] = std::min(low[axis], points[end][axis]);
      wider_high[axis] = std::max(high[axis], points[end][axis]);
    }
    if (norm(wider_high - wider_low) > diameter) break;
    low = wider_low, high = wider_high;
  }
  return {i, end, 0.5 * (low + high), 0.5 * norm(high - low)};
}

/// Places of the candidates that are nearer to the centre than the radius.
void CellsAround::find_near(const Candidates& from, const Vec3& centre, double radius) {
  const std::size_t n = from.number.size();
  near_.resize(std::max(near_.size(), n)), distance_squared_.resize(near_.size());
  double* d2 = distance_squared_.data();
  const double *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
#pragma omp simd
  for (std::size_t s = 0; s < n; ++s)
    d2[s] = (x[s] - centre.x) * (x[s] - centre.x) + (y[s] - centre.y) * (y[s] - centre.y) + (z[s] - centre.z) * (z[s] - centre.z);
  // Without a branch: every place is written, and kept by moving on.
  const double radius_squared = radius * radius;
  int* near = near_.data();
  std::size_t found = 0;
  for (std::size_t s = 0; s < n; ++s) {
    near[found] = static_cast<int>(s);
    found += d2[s] < radius_squared ? 1 : 0;
  }
  n_near_ = found;
}

void CellsAround::start_patch(std::span<const Vec3> points, std::size_t i) {
  patch_ = ball_from(points, i, most_in_patch, patch_diameter * radius_);
  cell_.clear();
  locator_.within(patch_.centre, radius_ * slack + patch_.radius, cell_);
  of_patch_.resize(cell_.size());
  for (std::size_t s = 0; s < cell_.size(); ++s) {
    const Vec3& centre = mesh_.cell_centre[cell_[s]];
    of_patch_.x[s] = centre.x, of_patch_.y[s] = centre.y, of_patch_.z[s] = centre.z;
    of_patch_.weight[s] = weights_[cell_[s]];
    of_patch_.number[s] = cell_[s];
  }
}

void CellsAround::start_group(std::span<const Vec3> points, std::size_t i, WeightRows& rows) {
  if (!patch_.has(i)) start_patch(points, i);
  group_ = ball_from(points.first(patch_.end), i, most_in_group, group_diameter * radius_);
  find_near(of_patch_, group_.centre, radius_ * slack + group_.radius);
  of_group_.resize(n_near_);
  for (std::size_t s = 0; s < n_near_; ++s) {
    const int from = near_[s];
    of_group_.x[s] = of_patch_.x[from], of_group_.y[s] = of_patch_.y[from], of_group_.z[s] = of_patch_.z[from];
    of_group_.weight[s] = of_patch_.weight[from];
    of_group_.number[s] = rows.place_of(of_patch_.number[from]);
  }
}

void CellsAround::append(std::span<const Vec3> points, std::size_t i, WeightRows& rows, std::vector<double>& weight) {
  if (!group_.has(i)) start_group(points, i, rows);
  find_near(of_group_, points[i], radius_);
  const std::size_t first = rows.place.size(), n = n_near_;
  rows.place.resize(first + n), rows.weight.resize(first + n), weight.resize(n);
  int* place = rows.place.data() + first;
  double *d2 = rows.weight.data() + first, *of_cell = weight.data();
  const int *near = near_.data(), *place_of = of_group_.number.data();
  const double *from_d2 = distance_squared_.data(), *from_weight = of_group_.weight.data();
#pragma omp simd
  for (std::size_t s = 0; s < n; ++s) {
    const int from = near[s];
    place[s] = place_of[from], d2[s] = from_d2[from], of_cell[s] = from_weight[from];
  }
}

}  // namespace snag
