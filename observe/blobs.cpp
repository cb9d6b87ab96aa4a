#include "observe/blobs.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"

namespace snag {

namespace {

void check_size(const GreyPicture& picture, const Camera& camera, const char* what) {
  if (picture.width == camera.width() && picture.height == camera.height()) return;
  throw Error(ExitCode::usage, std::string(what) + " is " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                                   " pixels, the camera " + std::to_string(camera.width()) + " x " + std::to_string(camera.height()) +
                                   "; correct pixels of [camera]");
}

cv::Mat matrix(const GreyPicture& picture) {
  return {picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.level.data())};  // only read
}

/// 255 where there is cloth.
cv::Mat mask_of(const GreyPicture& picture, const GreyPicture& background, const Camera& camera) {
  cv::Mat difference, mask;
  cv::absdiff(matrix(picture), matrix(background), difference);
  if (camera.smoothing > 0) cv::GaussianBlur(difference, difference, {}, camera.smoothing);
  const bool by_otsu = camera.threshold == 0;
  cv::threshold(difference, mask, camera.threshold, 255, by_otsu ? cv::THRESH_BINARY | cv::THRESH_OTSU : cv::THRESH_BINARY);
  if (!camera.fill_holes) return mask;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(mask, outlines, -1, 255, cv::FILLED);
  return mask;
}

}  // namespace

std::vector<Blob> find_blobs(const GreyPicture& picture, const GreyPicture& background, const Camera& camera) {
  check_size(picture, camera, "the picture");
  check_size(background, camera, "the background");
  cv::Mat labels, boxes, centroids;
  const int n = cv::connectedComponentsWithStats(mask_of(picture, background, camera), labels, boxes, centroids, 8, CV_32S);
  std::vector<Blob> blobs;
  for (int label = 1; label < n; ++label) {
    const int n_pixels = boxes.at<int>(label, cv::CC_STAT_AREA);
    if (n_pixels < camera.minimum_pixels) continue;
    const int left = boxes.at<int>(label, cv::CC_STAT_LEFT), top = boxes.at<int>(label, cv::CC_STAT_TOP),
              width = boxes.at<int>(label, cv::CC_STAT_WIDTH), height = boxes.at<int>(label, cv::CC_STAT_HEIGHT);
    Blob blob;
    blob.n_pixels = n_pixels;
    blob.at_border = left == 0 || top == 0 || left + width == picture.width || top + height == picture.height;
    Coverage& seen = blob.coverage;
    seen.side = camera.pixel, seen.nx = width, seen.ny = height;
    seen.x0 = (left - 0.5 * picture.width) * camera.pixel, seen.y0 = (0.5 * picture.height - (top + height)) * camera.pixel;
    seen.covered.assign(static_cast<std::size_t>(width) * height, 0);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        seen.covered[static_cast<std::size_t>(height - 1 - row) * width + column] = labels.at<int>(top + row, left + column) == label;
    blob.seen = moments(seen);
    blobs.push_back(std::move(blob));
  }
  std::stable_sort(blobs.begin(), blobs.end(), [](const Blob& a, const Blob& b) { return a.n_pixels > b.n_pixels; });
  return blobs;
}

}  // namespace snag
