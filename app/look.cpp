#include "app/look.hpp"

#include <algorithm>
#include <numbers>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/series.hpp"
#include "base/vtk_reader.hpp"
#include "observe/passage/volute_watch.hpp"
#include "observe/virtual_camera.hpp"

namespace snag {

namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr int n_outlines = 20;  // pictures that are written with what was found in them

std::filesystem::path numbered(const std::filesystem::path& folder, const char* name, std::size_t number) {
  char text[64];
  std::snprintf(text, sizeof text, "%s_%05zu.png", name, number);
  return folder / text;
}

GreyPicture photograph_of(const VtkPiece& sheets, const std::filesystem::path& file, const Camera& camera, std::uint64_t seed) {
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t p = 0; p < sheets.offsets.size(); ++p) {
    const std::int64_t begin = p == 0 ? 0 : sheets.offsets[p - 1];
    if (sheets.offsets[p] - begin != 3) continue;
    std::array<int, 3> nodes{};
    for (int k = 0; k < 3; ++k) nodes[k] = static_cast<int>(sheets.connectivity[begin + k]);
    triangles.push_back(nodes);
  }
  const std::vector<double>& radius = array_named(sheets.point_arrays, "radius", file);
  const double largest = radius.empty() ? 0 : *std::max_element(radius.begin(), radius.end());
  return photograph(sheets.points, triangles, largest, camera, seed);
}

/// Writes down what is seen, picture by picture, and collects it.
class Look {
 public:
  Look(const std::filesystem::path& folder, const Camera& camera)
      : folder_(folder),
        camera_(camera),
        found_(camera),
        rows_(folder / "observations.csv", {"time [s]", "picture [1]", "blob [1]", "area [m2]", "x [m]", "y [m]", "elongation_ratio [1]",
                                            "orientation [deg]", "pixels [1]", "at_border [1]"}) {
    std::filesystem::create_directories(folder / "outlines");
    if (camera.volute) watch_.emplace(camera);
  }

  /// `step`: time since the last picture, s.
  void add(const GreyPicture& picture, const GreyPicture& background, double time, double step) {
    const std::vector<Blob> blobs = find_blobs(picture, background, camera_);
    for (std::size_t b = 0; b < blobs.size(); ++b) {
      const Silhouette& s = blobs[b].seen;
      rows_.add({time, static_cast<double>(number_), static_cast<double>(b), s.area, s.x, s.y, s.elongation_ratio, degrees * s.orientation,
                 static_cast<double>(blobs[b].n_pixels), blobs[b].at_border ? 1.0 : 0.0});
    }
    rows_.check();
    found_.add(blobs);
    if (watch_) watch_->add(blobs, time, step);
    if (!blobs.empty() && n_drawn_ < n_outlines) {
      write_outlines(numbered(folder_ / "outlines", "found", number_), picture, blobs, camera_);
      ++n_drawn_;
    }
    ++number_;
  }

  Findings findings() const {
    Findings findings;
    findings.pictures = found_;
    if (watch_) findings.volute_seen = watch_->histogram();
    return findings;
  }

 private:
  std::filesystem::path folder_;
  const Camera& camera_;
  PictureFindings found_;
  std::optional<VoluteWatch> watch_;
  Series rows_;
  std::size_t number_ = 0;
  int n_drawn_ = 0;
};

Findings look_at_run(const std::filesystem::path& run, const Camera& camera, const std::filesystem::path& folder, std::uint64_t seed) {
  const std::vector<VtkInstant> instants = read_collection(run / "rags" / "rags.pvd");
  std::filesystem::create_directories(folder / "pictures");
  const GreyPicture background = camera.background.empty() ? empty_picture(camera, seed << 32) : read_picture(camera.background);
  Look look(folder, camera);
  for (std::size_t n = 0; n < instants.size(); ++n) {
    const VtkPiece sheets = read_polygons(instants[n].file);
    const GreyPicture picture = photograph_of(sheets, instants[n].file, camera, (seed << 32) + n + 1);
    write_picture(numbered(folder / "pictures", "view", n), picture);
    look.add(picture, background, instants[n].time, n == 0 ? 0 : instants[n].time - instants[n - 1].time);
  }
  return look.findings();
}

Findings look_at_pictures(const std::filesystem::path& subject, const Camera& camera, const std::filesystem::path& folder) {
  if (camera.volute && camera.interval == 0)
    throw Error(ExitCode::usage, "[pump_in_picture] of the camera: how long a rag stays in " + subject.string() +
                                     " is unknown for pictures without a time; give [camera] interval");
  const std::vector<std::filesystem::path> files = picture_files(subject);
  if (camera.background.empty() && files.size() < 3)
    throw Error(ExitCode::usage, subject.string() + ": " + std::to_string(files.size()) +
                                     " pictures are too few for a background by their mean; give [cloth] background");
  if (camera.background.empty())
    log::warning(
        "[cloth] background is not given: it is the mean of all pictures, so that cloth that stays near a place for much of the time "
        "is found too large; give a picture without cloth");
  const GreyPicture background = camera.background.empty() ? mean_picture(files) : read_picture(camera.background);
  const double interval = camera.interval > 0 ? camera.interval : 1;
  Look look(folder, camera);
  for (std::size_t n = 0; n < files.size(); ++n) look.add(read_picture(files[n]), background, static_cast<double>(n) * interval, interval);
  return look.findings();
}

}  // namespace

bool is_run(const std::filesystem::path& subject) {
  return std::filesystem::exists(subject / "rags" / "rags.pvd") || std::filesystem::exists(subject / "summary.json");
}

Findings analyse(const std::filesystem::path& subject, const Camera* camera, const std::filesystem::path& folder, std::uint64_t seed) {
  if (!is_run(subject)) return look_at_pictures(subject, *camera, folder);
  Findings findings;
  if (camera) findings = look_at_run(subject, *camera, folder, seed);
  findings.volute = volute_of_run(subject);
  if (!camera && findings.volute.n_rags() == 0)
    throw Error(
        ExitCode::usage,
        subject.string() +
            ": its summary.json has no residence times by volute angle (the run has not ended, or its case has no [rag_passage]); give "
            "--camera CAMERA.toml for pictures of it");
  return findings;
}

}  // namespace snag
