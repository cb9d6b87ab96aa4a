// Virtual pictures and what is read off them, against shapes whose moments are known.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "base/error.hpp"
#include "observe/blobs.hpp"
#include "observe/virtual_camera.hpp"

using namespace snag;

namespace {

struct Sheet {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};

/// Ellipse of half axes a and b (m) in the object plane of a camera that looks along -z, lifted by z.
Sheet ellipse(double a, double b, double angle, double z = 0, int n = 720) {
  Sheet sheet;
  const Vec3 centre{0.012, -0.021, z};
  sheet.points.push_back(centre);
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n, x = a * std::cos(t), y = b * std::sin(t);
    sheet.points.push_back(centre + Vec3{x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle), 0});
    sheet.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return sheet;
}

/// That of the suction-pipe experiment: 0.27 mm a pixel.
Camera camera() {
  Camera c;
  c.pixel = 0.27e-3, c.minimum_pixels = 1000;
  c.threshold = 70;  // half of the step from background to cloth: the edge is where the blurred step passes it
  return c;
}

Blob only_blob(const Sheet& sheet, const Camera& c, int seed = 1) {
  const std::vector<Blob> blobs = find_blobs(photograph(sheet.points, sheet.triangles, 0, c, seed), empty_picture(c, seed + 1000), c);
  EXPECT_EQ(blobs.size(), 1U);
  return blobs.at(0);
}

}  // namespace

TEST(VirtualCamera, EllipseOfKnownMoments) {
  // Requirement: area, centroid, ratio of axes and orientation of an ellipse to 0.5 % (0.2 degrees, 0.1 mm), at any angle.
  const double a = 0.11, b = 0.042;
  for (const double angle : {0.0, 0.3, 0.6, -0.9}) {
    const Silhouette seen = only_blob(ellipse(a, b, angle), camera()).seen;
    EXPECT_NEAR(seen.area / (std::numbers::pi * a * b), 1, 0.005) << angle;
    EXPECT_NEAR(seen.elongation_ratio / (a / b), 1, 0.005) << angle;
    EXPECT_NEAR(std::remainder(seen.orientation - angle, std::numbers::pi), 0, 0.2 * std::numbers::pi / 180) << angle;
    EXPECT_NEAR(seen.x, 0.012, 1e-4);
    EXPECT_NEAR(seen.y, -0.021, 1e-4);
  }
}

TEST(VirtualCamera, BlurAndNoiseStayWithinBounds) {
  // Requirement: a blur of 3 pixels and a noise of 8 of 255 grey levels, both smoothed before the threshold, change the area of an ellipse
  // of 1000 cm2 by less than 1 %, and its ratio of axes by less than 1 %.
  const double a = 0.11, b = 0.042;
  Camera c = camera();
  c.blur = 3, c.noise = 8, c.smoothing = 2;
  for (const int seed : {1, 2, 3}) {
    const Silhouette seen = only_blob(ellipse(a, b, 0.4), c, seed).seen;
    EXPECT_NEAR(seen.area / (std::numbers::pi * a * b), 1, 0.01);
    EXPECT_NEAR(seen.elongation_ratio / (a / b), 1, 0.01);
  }
}

TEST(VirtualCamera, ReflectionOfASmallSpotIsDropped) {
  // Requirement: a bright spot on the cloth is a hole and is filled; one beside it is smaller than the smallest rag and is dropped.
  const Sheet cloth = ellipse(0.11, 0.042, 0);
  const Camera c = camera();
  GreyPicture picture = photograph(cloth.points, cloth.triangles, 0, c, 1);
  const auto spot = [&](int column, int row) {
    for (int j = -8; j <= 8; ++j)
      for (int i = -8; i <= 8; ++i) picture.level[static_cast<std::size_t>(row + j) * picture.width + column + i] = 250;
  };
  const int column = static_cast<int>(960 + 0.012 / c.pixel), row = static_cast<int>(416 + 0.021 / c.pixel);
  spot(column, row);
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i) picture.level[static_cast<std::size_t>(30 + j) * picture.width + 30 + i] = 20;
  const std::vector<Blob> blobs = find_blobs(picture, empty_picture(c, 7), c);
  ASSERT_EQ(blobs.size(), 1U);
  EXPECT_NEAR(blobs[0].seen.area / (std::numbers::pi * 0.11 * 0.042), 1, 0.005);
}

TEST(VirtualCamera, PerspectiveEnlargesWhatIsNear) {
  // Requirement: at height z before the object plane lengths are larger by D/(D - z), the pipe's radius and 1 m here: 11 %.
  const double a = 0.08, b = 0.05, D = 1, z = 0.1;
  Camera c = camera();
  c.distance = D;
  const Silhouette seen = only_blob(ellipse(a, b, 0.2, z), c).seen;
  const double grown = D / (D - z);
  EXPECT_NEAR(seen.area / (std::numbers::pi * a * b * grown * grown), 1, 0.005);
  EXPECT_NEAR(seen.x / (0.012 * grown), 1, 0.01);
  EXPECT_TRUE(std::isnan(c.seen_at({0, 0, 1.5})[0]));
}

TEST(VirtualCamera, OtsuFindsTheThreshold) {
  // Requirement: with threshold = 0 the same area to 0.5 %, for faint cloth too.
  Camera c = camera();
  c.threshold = 0, c.cloth_level = 170, c.noise = 3;
  EXPECT_NEAR(only_blob(ellipse(0.11, 0.042, 0.7), c).seen.area / (std::numbers::pi * 0.11 * 0.042), 1, 0.005);
}

TEST(Blobs, SeveralAndAtTheBorder) {
  // Requirement: two rags are two blobs, the larger first; one that reaches the edge of the picture says so.
  Sheet two = ellipse(0.05, 0.03, 0);
  const Sheet other = ellipse(0.04, 0.02, 0);
  const int n = static_cast<int>(two.points.size());
  for (const Vec3& x : other.points) two.points.push_back(x + Vec3{0.235, 0, 0});
  for (const auto& [i, j, k] : other.triangles) two.triangles.push_back({i + n, j + n, k + n});
  const Camera c = camera();
  const std::vector<Blob> blobs = find_blobs(photograph(two.points, two.triangles, 0, c, 1), empty_picture(c, 2), c);
  ASSERT_EQ(blobs.size(), 2U);
  EXPECT_GT(blobs[0].n_pixels, blobs[1].n_pixels);
  EXPECT_FALSE(blobs[0].at_border);
  EXPECT_TRUE(blobs[1].at_border);
}

TEST(Pictures, AreReadAsTheyWereWritten) {
  // Requirement: a PNG keeps every level; the mean of pictures is their mean; sizes that differ and files that are no pictures are refused.
  const auto folder = std::filesystem::temp_directory_path() / ("snag-pictures-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  GreyPicture a{4, 3, {}}, b{4, 3, {}};
  for (int k = 0; k < 12; ++k)
    a.level.push_back(static_cast<std::uint8_t>(10 * k)), b.level.push_back(static_cast<std::uint8_t>(10 * k + 4));
  write_picture(folder / "a.png", a), write_picture(folder / "b.png", b);
  EXPECT_EQ(read_picture(folder / "a.png").level, a.level);
  const GreyPicture mean = mean_picture(picture_files(folder));
  for (int k = 0; k < 12; ++k) EXPECT_EQ(mean.level[k], 10 * k + 2);
  write_picture(folder / "c.png", {2, 1, {1, 2}});
  EXPECT_THROW(mean_picture(picture_files(folder)), Error);
  std::ofstream(folder / "d.png") << "no picture";
  EXPECT_THROW(read_picture(folder / "d.png"), Error);
  EXPECT_THROW(picture_files(folder / "none"), Error);
  std::filesystem::remove_all(folder);
}

TEST(CameraFile, RefusesWhatCannotBe) {
  // Requirement: one message that names the key.
  Camera parallel;
  parallel.right = {1, 0, 0}, parallel.up = {2, 0, 0};
  EXPECT_THROW(check_camera(parallel, "camera"), Error);
  Camera three;
  three.pixels = {1, 2, 3};
  EXPECT_THROW(check_camera(three, "camera"), Error);
}
