#include "observe/virtual_camera.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "observe/cloth_to_rim.hpp"
#include "observe/coverage.hpp"

namespace snag {

namespace {

constexpr int finer = 4;  // sub-pixels along a side

/// Part of the picture in whole pixels: columns from the left, rows from the bottom.
struct Part {
  int left = 0, right = 0, bottom = 0, top = 0;  // right and top excluded
};

/// The pixels that hold these points and what is within `reach` of them; not more than the picture.
Part part_around(const std::vector<std::array<double, 2>>& points, double reach, const Camera& camera) {
  double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
  for (const auto& point : points)
    for (int c = 0; c < 2; ++c)  // comparisons with a point behind the camera, not a number, are false
      low[c] = point[c] - reach < low[c] ? point[c] - reach : low[c], high[c] = point[c] + reach > high[c] ? point[c] + reach : high[c];
  const auto pixel = [&](double at, int n) {
    return static_cast<int>(std::clamp(std::floor(at / camera.pixel + 0.5 * n), 0.0, static_cast<double>(n)));
  };
  if (!(low[0] <= high[0])) return {};
  return {pixel(low[0], camera.width()), std::min(camera.width(), pixel(high[0], camera.width()) + 1), pixel(low[1], camera.height()),
          std::min(camera.height(), pixel(high[1], camera.height()) + 1)};
}

/// Share of each pixel that is cloth, rows from the top; `fine` covers `part` in sub-pixels.
cv::Mat covered_share(const Coverage& fine, const Part& part, const Camera& camera) {
  cv::Mat share(camera.height(), camera.width(), CV_32FC1, cv::Scalar(0));
  for (int row = part.bottom; row < part.top; ++row)
    for (int column = part.left; column < part.right; ++column) {
      int n = 0;
      for (int j = 0; j < finer; ++j)
        for (int i = 0; i < finer; ++i) n += fine.at((column - part.left) * finer + i, (row - part.bottom) * finer + j);
      share.at<float>(share.rows - 1 - row, column) = static_cast<float>(n) / (finer * finer);
    }
  return share;
}

GreyPicture developed(cv::Mat share, const Camera& camera, std::uint64_t seed) {
  if (camera.blur > 0) cv::GaussianBlur(share, share, {}, camera.blur);
  cv::Mat level = share * (camera.cloth_level - camera.background_level) + camera.background_level;
  if (camera.noise > 0) {
    cv::Mat noise(level.size(), CV_32FC1);
    cv::RNG random(seed * 0x9e3779b97f4a7c15ULL + 0x632be59bd9b4e019ULL);
    random.fill(noise, cv::RNG::NORMAL, 0, camera.noise);
    level += noise;
  }
  cv::Mat bytes;
  level.convertTo(bytes, CV_8UC1);  // rounds, and cuts at black and white as a sensor does
  return {bytes.cols, bytes.rows, {bytes.datastart, bytes.dataend}};
}

}  // namespace

GreyPicture photograph(std::span<const Vec3> points, std::span<const std::array<int, 3>> triangles, double radius, const Camera& camera,
                       std::uint64_t seed) {
  const ClothToRim cloth = cloth_to_rim(points, std::vector<double>(points.size(), radius), triangles);
  std::vector<std::array<double, 2>> at;
  for (const Vec3& x : cloth.points) at.push_back(camera.seen_at(x));
  const auto disc = [&](int k) { return radius * camera.magnification(points[k]); };  // radius as seen, m
  double largest = 0;
  for (const int k : cloth.loose) largest = std::max(largest, disc(k));
  const Part part = part_around(at, largest, camera);
  Coverage fine(0, 0, 0, 0, camera.pixel / finer);
  fine.x0 = (part.left - 0.5 * camera.width()) * camera.pixel, fine.y0 = (part.bottom - 0.5 * camera.height()) * camera.pixel;
  fine.nx = finer * (part.right - part.left), fine.ny = finer * (part.top - part.bottom);
  fine.covered.assign(static_cast<std::size_t>(fine.nx) * fine.ny, 0);
  for (const int k : cloth.loose)
    if (disc(k) > 0) fine.fill_circle(at[k][0], at[k][1], disc(k));
  for (const auto& [a, b, c] : cloth.triangles)
    if (!std::isnan(at[a][0] + at[b][0] + at[c][0])) fine.fill_triangle({at[a][0], at[b][0], at[c][0]}, {at[a][1], at[b][1], at[c][1]});
  return developed(covered_share(fine, part, camera), camera, seed);
}

GreyPicture empty_picture(const Camera& camera, std::uint64_t seed) {
  return developed(cv::Mat(camera.height(), camera.width(), CV_32FC1, cv::Scalar(0)), camera, seed);
}

}  // namespace snag
