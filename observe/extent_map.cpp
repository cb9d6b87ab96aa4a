#include "observe/extent_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "observe/coverage_map.hpp"

namespace snag {

void ExtentMap::reach(int half_width, int half_height) {
  if (half_width <= half_width_ && half_height <= half_height_) return;
  ExtentMap larger(pixel_);
  larger.half_width_ = std::max(half_width_, half_width), larger.half_height_ = std::max(half_height_, half_height);
  larger.count_.assign(static_cast<std::size_t>(2 * larger.half_width_ + 1) * (2 * larger.half_height_ + 1), 0);
  for (int j = -half_height_; j <= half_height_; ++j)
    for (int i = -half_width_; i <= half_width_; ++i) larger.count_[larger.index(i, j)] = count_[index(i, j)];
  larger.n_ = n_;
  *this = std::move(larger);
}

void ExtentMap::add(const Blob& blob) {
  const Coverage& seen = blob.coverage;
  const auto nearest = [&](double from, double centroid) {
    return static_cast<int>(std::lround((from + 0.5 * seen.side - centroid) / pixel_));
  };
  const int left = nearest(seen.x0, blob.seen.x), bottom = nearest(seen.y0, blob.seen.y);
  reach(std::max(std::abs(left), std::abs(left + seen.nx - 1)), std::max(std::abs(bottom), std::abs(bottom + seen.ny - 1)));
  for (int j = 0; j < seen.ny; ++j)
    for (int i = 0; i < seen.nx; ++i) count_[index(left + i, bottom + j)] += seen.at(i, j);
  ++n_;
}

void ExtentMap::add(const ExtentMap& other) {
  reach(other.half_width_, other.half_height_);
  for (int j = -other.half_height_; j <= other.half_height_; ++j)
    for (int i = -other.half_width_; i <= other.half_width_; ++i) count_[index(i, j)] += other.count_[other.index(i, j)];
  n_ += other.n_;
}

double ExtentMap::share(int right, int up) const {
  if (n_ == 0 || std::abs(right) > half_width_ || std::abs(up) > half_height_) return 0;
  return static_cast<double>(count_[index(right, up)]) / n_;
}

Silhouette ExtentMap::contour(double least_share) const {
  const double x = (half_width_ + 0.5) * pixel_, y = (half_height_ + 0.5) * pixel_;
  Coverage inside(-x, -y, x, y, pixel_);
  for (int j = 0; j <= 2 * half_height_; ++j)
    for (int i = 0; i <= 2 * half_width_; ++i)
      inside.covered[static_cast<std::size_t>(j) * inside.nx + i] = share(i - half_width_, j - half_height_) >= least_share;
  return moments(inside);
}

void ExtentMap::write_picture(const std::filesystem::path& file) const {
  std::vector<double> shares;
  for (int j = half_height_; j >= -half_height_; --j)
    for (int i = -half_width_; i <= half_width_; ++i) shares.push_back(share(i, j));
  write_shares(file, 2 * half_width_ + 1, 2 * half_height_ + 1, shares);
}

}  // namespace snag
