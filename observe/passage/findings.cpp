#include "observe/passage/findings.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "base/atomic_file.hpp"

namespace snag {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

nlohmann::ordered_json contours_json(const ExtentMap& extent) {
  nlohmann::ordered_json contours = nlohmann::ordered_json::array();
  for (const double share : contour_shares) {
    const Silhouette seen = extent.contour(share);
    if (seen.area > 0)
      contours.push_back({{"share", share},
                          {"area_m2", seen.area},
                          {"elongation_ratio", seen.elongation_ratio},
                          {"orientation_deg", degrees * seen.orientation}});
  }
  return contours;
}

}  // namespace

const std::vector<Quantity>& PictureFindings::quantities() {
  static const std::vector<Quantity> all{{"area", "m2"}, {"x", "m"}, {"y", "m"}, {"elongation_ratio", "1"}, {"orientation", "deg"}};
  return all;
}

void PictureFindings::add(const std::vector<Blob>& blobs) {
  ++n_pictures_, n_blobs_ += static_cast<int>(blobs.size());
  for (const Blob& blob : blobs) {
    if (blob.at_border) continue;
    const Silhouette& s = blob.seen;
    samples_.push_back({s.area, s.x, s.y, s.elongation_ratio, degrees * s.orientation});
    places_.add(blob), extent_.add(blob);
  }
}

void PictureFindings::add(const PictureFindings& other) {
  n_pictures_ += other.n_pictures_, n_blobs_ += other.n_blobs_;
  samples_.insert(samples_.end(), other.samples_.begin(), other.samples_.end());
  places_.add(other.places_), extent_.add(other.extent_);
}

std::vector<double> PictureFindings::column(std::size_t quantity) const {
  std::vector<double> values;
  for (const std::vector<double>& sample : samples_) values.push_back(sample[quantity]);
  return values;
}

void PictureFindings::write(const std::filesystem::path& folder) const {
  nlohmann::ordered_json all{{"pictures", n_pictures_}, {"blobs", n_blobs_}, {"whole_blobs", samples_.size()}};
  for (std::size_t o = 0; o < quantities().size() && !samples_.empty(); ++o) {
    const std::vector<double> values = column(o);
    const MeanAndSigma m = mean_and_sigma(values, quantities()[o]);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    all[quantities()[o].name] = {
        {"unit", quantities()[o].unit}, {"mean", m.mean}, {"sigma", m.sigma}, {"minimum", *low}, {"maximum", *high}, {"n", values.size()}};
  }
  if (!samples_.empty()) {
    all["extent"] = contours_json(extent_);
    places_.write_picture(folder / "coverage.png");
    extent_.write_picture(folder / "extent.png");
  }
  write_atomically(folder / "statistics.json", all.dump(2) + "\n");
}

std::string PictureFindings::words(bool statistics) const {
  std::ostringstream summary;
  summary << n_pictures_ << " pictures, " << n_blobs_ << " pieces of cloth, " << samples_.size() << " of them wholly in the picture";
  summary.precision(4);
  for (std::size_t o = 0; o < quantities().size() && statistics && !samples_.empty(); ++o) {
    const MeanAndSigma m = mean_and_sigma(column(o), quantities()[o]);
    summary << "\n  " << quantities()[o].name << ": mean " << m.mean << ", sigma " << m.sigma << " " << quantities()[o].unit;
  }
  if (n_blobs_ == 0)
    summary << "\n  no cloth was found in any picture: check [cloth] threshold and minimum_pixels, and what the camera looks at";
  return summary.str();
}

void Findings::add(const Findings& other) {
  if (!pictures)
    pictures = other.pictures;
  else if (other.pictures)
    pictures->add(*other.pictures);
  volute.add(other.volute), volute_seen.add(other.volute_seen);
}

void Findings::write(const std::filesystem::path& folder) const {
  if (pictures) pictures->write(folder);
  if (volute.n_rags() > 0) write_atomically(folder / "volute.csv", volute.csv());
  if (volute_seen.n_rags() > 0) write_atomically(folder / "volute_seen.csv", volute_seen.csv());
}

std::string Findings::words(bool statistics) const {
  std::string text;
  const auto add = [&](const std::string& line) { text += (text.empty() ? "" : "\n") + line; };
  if (pictures) add(pictures->words(statistics));
  if (volute.n_rags() > 0) add("in the volute: " + volute.words());
  if (volute_seen.n_rags() > 0) add("in the volute as it is seen: " + volute_seen.words());
  return text;
}

}  // namespace snag
