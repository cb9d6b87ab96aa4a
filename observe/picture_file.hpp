#pragma once
// Picture files by OpenCV. Its codecs bring in 84 more libraries (of maps, films, medical pictures), and a program that is linked to them
// takes 0.2 s longer to start: they are in a module of their own, which is loaded with the first picture.
#include <filesystem>
#include <opencv2/core.hpp>

namespace snag {

/// Brightness of the pixels; empty if the file is no picture. Throws Error(io) if the module cannot be loaded.
cv::Mat read_grey(const std::filesystem::path& file);
/// The kind follows from the name's ending. Throws Error(io).
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace snag
