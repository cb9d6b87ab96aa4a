#include "observe/codecs/opencv.hpp"

#include <opencv2/imgcodecs.hpp>

bool snag_read_grey(const char* file, cv::Mat* grey) noexcept {
  try {
    *grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
    return !grey->empty();
  } catch (const cv::Exception&) {  // a width or height beyond what OpenCV takes
    return false;
  }
}

bool snag_write_picture(const char* file, const cv::Mat* picture) noexcept {
  try {
    return cv::imwrite(file, *picture);
  } catch (const cv::Exception&) {  // an ending that OpenCV does not know
    return false;
  }
}
