#pragma once
// A camera, real or virtual: how pixels and metres belong together, and what its pictures look like.
//
//   A point x is seen at   (right . d, up . d) D/(D - n . d),   d = x - centre,  n = right x up towards the camera,
//   in metres in the object plane through `centre`; D the distance of the camera from that plane (infinite: parallel projection).
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "observe/volute_view.hpp"

namespace snag {

struct Camera {
  std::vector<double> pixels{1920, 832};  // width, height
  double pixel = 0;                       // side of a pixel in the object plane, m
  Vec3 centre, right{1, 0, 0}, up{0, 1, 0};
  double distance = 0;                              // D, m; 0: parallel
  double interval = 0;                              // between recorded pictures, s; 0: unknown
  double blur = 0, noise = 0;                       // virtual: standard deviations, pixels and grey levels
  double background_level = 200, cloth_level = 60;  // virtual

  // what counts as cloth
  double threshold = 25;      // difference of grey levels from the background; 0: chosen by Otsu's method
  double smoothing = 0;       // of the difference before the threshold, pixels
  double minimum_pixels = 0;  // smaller blobs are dropped
  bool fill_holes = true;
  std::string background;  // picture, relative to the camera file; empty: mean of all pictures

  std::optional<VoluteView> volute;  // where the pump is in the picture

  int width() const { return static_cast<int>(pixels[0]); }
  int height() const { return static_cast<int>(pixels[1]); }
  /// How much larger a length at x is seen than one in the object plane; not a number at or behind the camera.
  double magnification(const Vec3& x) const;
  /// Where a point is seen, in metres from the middle of the picture, to the right and up. A point at or behind the camera: not a number.
  std::array<double, 2> seen_at(const Vec3& x) const;

  std::vector<Section> sections();
};

/// Reads [camera], [cloth] and [pump_in_picture] of a camera file. Throws Error(usage, io).
Camera read_camera(const std::filesystem::path& file);
/// Makes the directions unit vectors at right angles; throws Error(usage) naming `where` on what cannot be a camera.
void check_camera(Camera& camera, const std::string& where);

}  // namespace snag
