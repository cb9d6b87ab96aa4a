#pragma once
// How often each place of a picture is covered by cloth: the share of rags that lie there (Jensen 2018, Fig. A.6).
#include <filesystem>
#include <vector>

#include "observe/blobs.hpp"

namespace snag {

class CoverageMap {
 public:
  explicit CoverageMap(const Camera& camera);
  void add(const Blob& blob);
  int n_blobs() const { return n_; }
  /// Share of the blobs that cover a pixel; rows from the top.
  double share(int column, int row) const;
  /// The map in colours, with contours at 10, 30, 50, 70 and 90 per cent. Throws Error(io).
  void write_picture(const std::filesystem::path& file) const;

 private:
  Camera camera_;
  int n_ = 0;
  std::vector<int> count_;  // [height * width], rows from the top
};

/// The picture with the outlines of its blobs drawn in red, for a look at what was found. Throws Error(io).
void write_outlines(const std::filesystem::path& file, const GreyPicture& picture, const std::vector<Blob>& blobs, const Camera& camera);

}  // namespace snag
