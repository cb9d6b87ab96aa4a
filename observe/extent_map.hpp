#pragma once
// How far rags reach about their centroids: all centroids in one place, the share of rags that cover each place around it (Jensen 2018,
// Fig. A.6).
#include <filesystem>
#include <vector>

#include "observe/blobs.hpp"

namespace snag {

class ExtentMap {
 public:
  /// `pixel`: side, m.
  explicit ExtentMap(double pixel) : pixel_(pixel) {}
  /// The centroid is moved to the middle of the nearest pixel.
  void add(const Blob& blob);
  /// Of other pictures with pixels of the same side.
  void add(const ExtentMap& other);
  int n_blobs() const { return n_; }
  /// Share of the blobs that cover the pixel so many columns to the right of the common centroid and rows above it.
  double share(int right, int up) const;
  /// Of what at least this share of the blobs covers: area, centroid from the common one, ratio of axes, orientation.
  Silhouette contour(double least_share) const;
  /// As large as the rags reach, with contours as those of the coverage map. Throws Error(io).
  void write_picture(const std::filesystem::path& file) const;

 private:
  void reach(int half_width, int half_height);  // makes room
  std::size_t index(int right, int up) const {
    return static_cast<std::size_t>(up + half_height_) * (2 * half_width_ + 1) + right + half_width_;
  }

  double pixel_;
  int n_ = 0, half_width_ = 0, half_height_ = 0;
  std::vector<int> count_ = {0};  // [(2 half_height + 1) * (2 half_width + 1)], rows from the bottom
};

}  // namespace snag
