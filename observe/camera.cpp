#include "observe/camera.hpp"

#include <cmath>
#include <limits>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

double Camera::magnification(const Vec3& x) const {
  if (distance <= 0) return 1;
  const double to_camera = distance - dot(cross(right, up), x - centre);
  return to_camera > 0 ? distance / to_camera : std::numeric_limits<double>::quiet_NaN();
}

std::array<double, 2> Camera::seen_at(const Vec3& x) const {
  const double larger = magnification(x);
  return {larger * dot(right, x - centre), larger * dot(up, x - centre)};
}

std::vector<Section> Camera::sections() {
  const auto number = [](const char* key, ParameterTarget target, const char* unit, double minimum, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = unit, .minimum = minimum, .meaning = meaning};
  };
  Parameter size = number("pixel", &pixel, "m", 1e-9, "Side of a pixel in the object plane.");
  size.required = true;
  Parameter levels = number("pixels", &pixels, "1", 1, "Width and height of a picture.");
  return {{"camera",
           "A camera that looks at rags, in recorded pictures or in pictures of a run.",
           {levels, size, number("centre", &centre, "m", -infinity, "Point of the object plane in the middle of the picture."),
            number("right", &right, "1", -infinity, "Direction to the right in the picture."),
            number("up", &up, "1", -infinity, "Direction up in the picture; the camera stands on the side of right x up."),
            number("distance", &distance, "m", 0, "Distance of the camera from the object plane; 0: parallel projection."),
            number("interval", &interval, "s", 0, "Time between two recorded pictures; by default times are numbers of pictures."),
            number("blur", &blur, "1", 0, "Virtual camera: standard deviation of the blur, pixels."),
            number("noise", &noise, "1", 0, "Virtual camera: standard deviation of the noise, grey levels of 255."),
            number("background_level", &background_level, "1", 0, "Virtual camera: grey level without cloth."),
            number("cloth_level", &cloth_level, "1", 0, "Virtual camera: grey level of cloth.")}},
          {"cloth",
           "What counts as cloth in a picture.",
           {file_setting("background", &background, "Picture without cloth; by default the mean of all pictures."),
            number("threshold", &threshold, "1", 0, "Difference of the grey level from the background; 0: by Otsu's method."),
            number("smoothing", &smoothing, "1", 0, "Standard deviation of the blur taken before the threshold, pixels."),
            number("minimum_pixels", &minimum_pixels, "1", 0, "Number of pixels; smaller blobs are not cloth."),
            setting("fill_holes", &fill_holes, "true: the holes of a blob count as cloth.")}}};
}

void check_camera(Camera& camera, const std::string& where) {
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, where + ": " + what); };
  if (camera.pixels.size() != 2) refuse("pixels has " + std::to_string(camera.pixels.size()) + " numbers, must be width and height");
  if (camera.width() > 20000 || camera.height() > 20000) refuse("pixels must be at most 20000 x 20000");
  if (norm(cross(camera.right, camera.up)) < 1e-6 * norm(camera.right) * norm(camera.up))
    refuse("right and up are parallel or zero; give two directions of the picture");
  camera.right = unit(camera.right);
  camera.up = unit(camera.up - dot(camera.up, camera.right) * camera.right);
}

Camera read_camera(const std::filesystem::path& path) {
  const CaseFile file = CaseFile::read(path);
  Camera camera;
  for (const Section& section : camera.sections()) file.root().table(section.name).read(section.parameters);
  VoluteView volute;
  if (const Section section = volute.section(); file.root().has(section)) {
    file.root().table(section).read(section.parameters);
    check_volute_view(volute, file.root().table(section).where());
    camera.volute = volute;
  }
  file.reject_unread();
  check_camera(camera, file.root().table("camera").where());
  if (!camera.background.empty()) camera.background = file.path(camera.background).string();
  return camera;
}

}  // namespace snag
