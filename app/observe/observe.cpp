#include "app/observe.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/series.hpp"
#include "base/vtk_reader.hpp"
#include "observe/coverage_map.hpp"
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

bool is_run(const std::filesystem::path& subject) { return std::filesystem::exists(subject / "rags" / "rags.pvd"); }

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

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Mean direction of axes given in degrees: an axis at 89 and one at -89 degrees lie around 90.
double mean_of_axes(const std::vector<double>& values) {
  double c = 0, s = 0;
  for (const double value : values) c += std::cos(2 * value / degrees), s += std::sin(2 * value / degrees);
  return 0.5 * degrees * std::atan2(s, c);
}

double square_of(double value) { return value * value; }

/// Collects what is seen, and its statistics.
class Observation {
 public:
  Observation(const std::filesystem::path& folder, const Camera& camera)
      : folder_(folder),
        camera_(camera),
        map_(camera),
        rows_(folder / "observations.csv", {"time [s]", "picture [1]", "blob [1]", "area [m2]", "x [m]", "y [m]", "elongation_ratio [1]",
                                            "orientation [deg]", "pixels [1]", "at_border [1]"}) {}

  void add(std::size_t number, double time, const GreyPicture& picture, const GreyPicture& background) {
    const std::vector<Blob> blobs = find_blobs(picture, background, camera_);
    for (std::size_t b = 0; b < blobs.size(); ++b) {
      const Blob& blob = blobs[b];
      const Silhouette& s = blob.seen;
      rows_.add({time, static_cast<double>(number), static_cast<double>(b), s.area, s.x, s.y, s.elongation_ratio, degrees * s.orientation,
                 static_cast<double>(blob.n_pixels), blob.at_border ? 1.0 : 0.0});
      ++n_blobs_;
      if (blob.at_border) continue;
      const std::array<double, 5> values{s.area, s.x, s.y, s.elongation_ratio, degrees * s.orientation};
      for (std::size_t v = 0; v < values.size(); ++v) values_[v].push_back(values[v]);
      map_.add(blob);
    }
    if (!blobs.empty() && n_drawn_ < n_outlines) {
      write_outlines(numbered(folder_ / "outlines", "found", number), picture, blobs, camera_);
      ++n_drawn_;
    }
  }

  void finish(std::size_t n_pictures) const {
    nlohmann::ordered_json all{{"pictures", n_pictures}, {"blobs", n_blobs_}, {"whole_blobs", map_.n_blobs()}};
    std::ostringstream told;
    told << n_pictures << " pictures, " << n_blobs_ << " pieces of cloth, " << map_.n_blobs() << " of them wholly in the picture";
    told.precision(4);
    for (std::size_t v = 0; v < values_.size(); ++v) {
      const std::vector<double>& values = values_[v];
      if (values.empty()) continue;
      const double mean = std::string(names[v]) == "orientation" ? mean_of_axes(values) : mean_of(values);
      double square = 0;
      for (const double value : values)
        square += square_of(std::string(names[v]) == "orientation" ? std::remainder(value - mean, 180) : value - mean);
      const double deviation = values.size() > 1 ? std::sqrt(square / static_cast<double>(values.size() - 1)) : std::nan("");
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      all[names[v]] = {{"unit", units[v]}, {"mean", mean},     {"sigma", deviation},
                       {"minimum", *low},  {"maximum", *high}, {"n", values.size()}};
      told << "\n  " << names[v] << ": mean " << mean << ", sigma " << deviation << " " << units[v];
    }
    write_atomically(folder_ / "statistics.json", all.dump(2) + "\n");
    if (map_.n_blobs() > 0) map_.write_picture(folder_ / "coverage.png");
    log::info(told.str());
  }

 private:
  static constexpr std::array<const char*, 5> names{"area", "x", "y", "elongation_ratio", "orientation"};
  static constexpr std::array<const char*, 5> units{"m2", "m", "m", "1", "deg"};
  std::filesystem::path folder_;
  Camera camera_;
  CoverageMap map_;
  Series rows_;
  std::array<std::vector<double>, 5> values_;
  int n_blobs_ = 0, n_drawn_ = 0;
};

void observe_run(const ObserveOptions& options, const Camera& camera, Observation& observation, const std::filesystem::path& folder) {
  const std::vector<VtkInstant> instants = read_collection(options.subject / "rags" / "rags.pvd");
  std::filesystem::create_directories(folder / "pictures");
  const auto first_seed = static_cast<std::uint64_t>(options.seed) << 32;
  const GreyPicture background = camera.background.empty() ? empty_picture(camera, first_seed) : read_picture(camera.background);
  for (std::size_t n = 0; n < instants.size(); ++n) {
    const VtkPiece sheets = read_polygons(instants[n].file);
    const GreyPicture picture = photograph_of(sheets, instants[n].file, camera, first_seed + n + 1);
    write_picture(numbered(folder / "pictures", "view", n), picture);
    observation.add(n, instants[n].time, picture, background);
  }
  observation.finish(instants.size());
}

void observe_pictures(const ObserveOptions& options, const Camera& camera, Observation& observation) {
  const std::vector<std::filesystem::path> files = picture_files(options.subject);
  if (camera.background.empty() && files.size() < 3)
    throw Error(ExitCode::usage, options.subject.string() + ": " + std::to_string(files.size()) +
                                     " pictures are too few for a background by their mean; give [cloth] background");
  const GreyPicture background = camera.background.empty() ? mean_picture(files) : read_picture(camera.background);
  for (std::size_t n = 0; n < files.size(); ++n) observation.add(n, static_cast<double>(n), read_picture(files[n]), background);
  observation.finish(files.size());
}

}  // namespace

void observe(const ObserveOptions& options) {
  const Camera camera = read_camera(options.camera_file);
  if (!std::filesystem::exists(options.subject))
    throw Error(ExitCode::io, options.subject.string() + ": is neither a picture, nor a folder of pictures, nor that of a run");
  const auto name = std::filesystem::weakly_canonical(options.subject).filename();
  const std::filesystem::path folder = options.out.empty() ? "results" / std::filesystem::path("observe-" + name.string()) : options.out;
  std::filesystem::create_directories(folder / "outlines");
  Observation observation(folder, camera);
  if (is_run(options.subject)) {
    observe_run(options, camera, observation, folder);
  } else {
    observe_pictures(options, camera, observation);
  }
  log::info("observations: " + (folder / "observations.csv").string());
}

}  // namespace snag
