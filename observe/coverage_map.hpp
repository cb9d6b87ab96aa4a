#pragma once
// How often each place of a picture is covered by cloth: the share of rags that lie there.
#include <array>
#include <filesystem>
#include <vector>

#include "observe/blobs.hpp"

namespace snag {

class CoverageMap {
 public:
  explicit CoverageMap(const Camera& camera);
  void add(const Blob& blob);
  /// Of other pictures of the same size.
  void add(const CoverageMap& other);
  int n_blobs() const { return n_; }
  /// Share of the blobs that cover a pixel; rows from the top.
  double share(int column, int row) const;
  /// Throws Error(io).
  void write_picture(const std::filesystem::path& file) const;

 private:
  Camera camera_;
  int n_ = 0;
  std::vector<int> count_;  // [height * width], rows from the top
};

/// Shares of which contours are drawn.
inline constexpr std::array<double, 5> contour_shares{0.1, 0.3, 0.5, 0.7, 0.9};

/// Shares in colours with their contours; [height * width], rows from the top. Throws Error(io).
void write_shares(const std::filesystem::path& file, int width, int height, const std::vector<double>& shares);

/// The picture with the outlines of its blobs drawn in red, for a look at what was found. Throws Error(io).
void write_outlines(const std::filesystem::path& file, const GreyPicture& picture, const std::vector<Blob>& blobs, const Camera& camera);

}  // namespace snag
