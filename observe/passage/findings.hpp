#pragma once
// What was found in the test of one rag, in the tests of a group, or in all.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "observe/coverage_map.hpp"
#include "observe/extent_map.hpp"
#include "observe/repeats.hpp"
#include "observe/volute_histogram.hpp"

namespace snag {

/// In pictures by one camera; samples are the blobs that lie wholly in their picture.
class PictureFindings {
 public:
  explicit PictureFindings(const Camera& camera) : places_(camera), extent_(camera.pixel) {}
  void add(const std::vector<Blob>& blobs_of_a_picture);
  void add(const PictureFindings& other);

  static const std::vector<Quantity>& quantities();
  /// Values of the quantities [sample].
  const std::vector<std::vector<double>>& samples() const { return samples_; }
  /// statistics.json, coverage.png, extent.png. Throws Error(io).
  void write(const std::filesystem::path& folder) const;
  /// How many, and with `statistics` a line for each quantity.
  std::string words(bool statistics) const;

 private:
  std::vector<double> column(std::size_t quantity) const;

  CoverageMap places_;
  ExtentMap extent_;
  std::vector<std::vector<double>> samples_;
  int n_pictures_ = 0, n_blobs_ = 0;
};

struct Findings {
  std::optional<PictureFindings> pictures;  // with a camera
  VoluteHistogram volute, volute_seen;      // from the summaries of runs; from pictures

  void add(const Findings& other);
  /// What there is of statistics.json, coverage.png, extent.png, volute.csv, volute_seen.csv. Throws Error(io).
  void write(const std::filesystem::path& folder) const;
  /// Lines for the log.
  std::string words(bool statistics) const;
};

}  // namespace snag
