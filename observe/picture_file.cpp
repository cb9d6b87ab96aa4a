#include "observe/picture_file.hpp"

#include <dlfcn.h>

#include "base/error.hpp"
#include "observe/codecs/opencv.hpp"

namespace snag {

namespace {

template <class Function>
Function* codec(const char* name) {
  void* const module = dlopen("snag-pictures.so", RTLD_NOW);
  void* const found = module ? dlsym(module, name) : nullptr;
  if (!found) throw Error(ExitCode::io, std::string("the module for picture files is missing, build it with ./snag build: ") + dlerror());
  return reinterpret_cast<Function*>(found);
}

}  // namespace

cv::Mat read_grey(const std::filesystem::path& file) {
  cv::Mat grey;
  const bool is_read = codec<decltype(snag_read_grey)>("snag_read_grey")(file.c_str(), &grey);
  return is_read ? grey : cv::Mat();
}

void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
  if (!codec<decltype(snag_write_picture)>("snag_write_picture")(file.c_str(), &picture))
    throw Error(ExitCode::io, file.string() + ": the picture could not be written; is the folder there, and the ending known?");
}

}  // namespace snag
