#pragma once
// What acts in a set of the blind benchmark whose truth is not in the library.
#include <string>
#include <vector>

#include "benchmark/blind/twin_points.hpp"
#include "casework/case_run.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

/// A force on the particles, or a camera that no candidate describes.
struct UnmodelledTruth {
  UnmodelledForce force;
  double pixel_ratio = 1;  // of a picture: breadth over height of its pixels

  bool acts() const { return static_cast<bool>(force) || pixel_ratio != 1; }
};

/// Names of those that a twin can have: "periodic" body force, "stratified" density of the water, "gust", "profile" (the flow is curved,
/// not linear), "curved" (a fibre or a rag that is bent by birth; not of a sphere), "camera" (pixels are not square).
std::vector<std::string> unmodelled_truths(const std::string& twin);

/// One of them, drawn at random; "": nothing acts. `strength`: 1 is plain to see.
UnmodelledTruth unmodelled_truth(const std::string& name, double strength, const TwinExperiment& experiment, NormalNumbers& random);

}  // namespace snag
