#pragma once
// Functions of the module snag-pictures.so, by the names under which they are looked up.
#include <opencv2/core.hpp>

extern "C" {
/// False if the file is no picture that OpenCV reads.
bool snag_read_grey(const char* file, cv::Mat* grey) noexcept;
/// The kind follows from the name's ending. False if the file could not be written.
bool snag_write_picture(const char* file, const cv::Mat* picture) noexcept;
}
