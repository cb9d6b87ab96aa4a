#pragma once
// What a camera sees of rags: in pictures that were taken, or in pictures of a run that the same camera would take.
#include <filesystem>

namespace snag {

struct ObserveOptions {
  std::filesystem::path subject;  // folder of pictures, one picture, or the output folder of a run
  std::filesystem::path camera_file;
  std::filesystem::path out;  // empty: results/observe-NAME
  int seed = 1;               // of the virtual camera's noise
};

/// Writes observations.csv (a row a blob), statistics.json (means and deviations of the blobs that lie wholly in their picture),
/// coverage.png, outlines/*.png for some pictures, and for a run pictures/*.png. On one rank. Throws Error(usage, io).
void observe(const ObserveOptions& options);

}  // namespace snag
