#include "observe/coverage_map.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "observe/picture_file.hpp"

namespace snag {

namespace {

using Outlines = std::vector<std::vector<cv::Point>>;

Outlines outlines_of(const cv::Mat& mask) {
  Outlines outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  return outlines;
}

/// Calls a function for each covered pixel: (column, row from the top).
template <class Action>
void for_pixels(const Blob& blob, const Camera& camera, const Action& action) {
  const Coverage& seen = blob.coverage;
  const int left = static_cast<int>(std::lround(seen.x0 / camera.pixel + 0.5 * camera.width()));
  const int bottom = static_cast<int>(std::lround(seen.y0 / camera.pixel + 0.5 * camera.height()));
  for (int j = 0; j < seen.ny; ++j)
    for (int i = 0; i < seen.nx; ++i)
      if (seen.at(i, j)) action(left + i, camera.height() - 1 - (bottom + j));
}

}  // namespace

CoverageMap::CoverageMap(const Camera& camera)
    : camera_(camera), count_(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height())) {}

void CoverageMap::add(const Blob& blob) {
  ++n_;
  for_pixels(blob, camera_, [&](int column, int row) { ++count_[static_cast<std::size_t>(row) * camera_.width() + column]; });
}

void CoverageMap::add(const CoverageMap& other) {
  n_ += other.n_;
  for (std::size_t k = 0; k < count_.size(); ++k) count_[k] += other.count_[k];
}

double CoverageMap::share(int column, int row) const {
  return n_ == 0 ? 0 : static_cast<double>(count_[static_cast<std::size_t>(row) * camera_.width() + column]) / n_;
}

void CoverageMap::write_picture(const std::filesystem::path& file) const {
  std::vector<double> shares;
  for (int row = 0; row < camera_.height(); ++row)
    for (int column = 0; column < camera_.width(); ++column) shares.push_back(share(column, row));
  write_shares(file, camera_.width(), camera_.height(), shares);
}

void write_shares(const std::filesystem::path& file, int width, int height, const std::vector<double>& shares) {
  cv::Mat levels(height, width, CV_8UC1), colours;
  for (std::size_t k = 0; k < shares.size(); ++k) levels.data[k] = static_cast<std::uint8_t>(std::lround(255 * shares[k]));
  cv::applyColorMap(levels, colours, cv::COLORMAP_VIRIDIS);
  for (const double share : contour_shares) {
    const cv::Mat above = levels >= 255 * share;
    cv::drawContours(colours, outlines_of(above), -1, {255, 255, 255}, 1);
  }
  write_picture(file, colours);
}

void write_outlines(const std::filesystem::path& file, const GreyPicture& picture, const std::vector<Blob>& blobs, const Camera& camera) {
  const cv::Mat grey(picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.level.data()));  // only read
  cv::Mat colours;
  cv::cvtColor(grey, colours, cv::COLOR_GRAY2BGR);
  for (const Blob& blob : blobs) {
    cv::Mat mask(picture.height, picture.width, CV_8UC1, cv::Scalar(0));
    for_pixels(blob, camera, [&](int column, int row) { mask.at<std::uint8_t>(row, column) = 255; });
    cv::drawContours(colours, outlines_of(mask), -1, {0, 0, 255}, 2);
  }
  write_picture(file, colours);
}

}  // namespace snag
