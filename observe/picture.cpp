#include "observe/picture.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/error.hpp"
#include "observe/picture_file.hpp"

namespace snag {

namespace {

constexpr std::array<const char*, 8> endings{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm", ".ppm"};

bool is_picture(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

}  // namespace

GreyPicture read_picture(const std::filesystem::path& file) {
  const cv::Mat read = std::filesystem::is_regular_file(file) ? read_grey(file) : cv::Mat();
  if (read.empty()) throw Error(ExitCode::io, file.string() + ": cannot be read as a picture; give PNG, JPEG, TIFF, BMP or PGM");
  GreyPicture picture{read.cols, read.rows, {}};
  for (int row = 0; row < read.rows; ++row) picture.level.insert(picture.level.end(), read.ptr(row), read.ptr(row) + read.cols);
  return picture;
}

void write_picture(const std::filesystem::path& file, const GreyPicture& picture) {
  const cv::Mat view(picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.level.data()));  // not written to
  write_picture(file, view);
}

std::vector<std::filesystem::path> picture_files(const std::filesystem::path& folder) {
  if (std::filesystem::is_regular_file(folder)) return {folder};
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.is_regular_file() && is_picture(entry.path())) files.push_back(entry.path());
  if (files.empty()) throw Error(ExitCode::io, folder.string() + ": there is no picture (PNG, JPEG, TIFF, BMP, PGM)");
  std::sort(files.begin(), files.end());
  return files;
}

GreyPicture mean_picture(const std::vector<std::filesystem::path>& files) {
  GreyPicture mean = read_picture(files.at(0));
  std::vector<double> sum(mean.level.begin(), mean.level.end());
  for (std::size_t f = 1; f < files.size(); ++f) {
    const GreyPicture one = read_picture(files[f]);
    if (one.width != mean.width || one.height != mean.height)
      throw Error(ExitCode::usage, files[f].string() + ": is " + std::to_string(one.width) + " x " + std::to_string(one.height) +
                                       " pixels, the first picture " + std::to_string(mean.width) + " x " + std::to_string(mean.height) +
                                       "; all must be of one camera");
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one.level[k];
  }
  for (std::size_t k = 0; k < sum.size(); ++k)
    mean.level[k] = static_cast<std::uint8_t>(std::lround(sum[k] / static_cast<double>(files.size())));
  return mean;
}

}  // namespace snag
