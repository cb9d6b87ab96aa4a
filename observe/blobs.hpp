#pragma once
// Pieces of cloth in a picture: difference from the background, threshold, holes filled, small ones dropped, moments
// (Jensen 2018, section A.2, Eqs. A.1 - A.3).
#include <vector>

#include "observe/camera.hpp"
#include "observe/coverage.hpp"
#include "observe/picture.hpp"
#include "observe/silhouette.hpp"

namespace snag {

struct Blob {
  Silhouette seen;  // metres from the middle of the picture
  int n_pixels = 0;
  bool at_border = false;  // part of it may be outside the picture
  Coverage coverage{0, 0, 0, 0, 1};
};

/// Largest first. Throws Error(usage) if the pictures differ in size from each other or from the camera.
std::vector<Blob> find_blobs(const GreyPicture& picture, const GreyPicture& background, const Camera& camera);

}  // namespace snag
