#pragma once
// The folder of the sources: files that tests read, and what lies in a folder, to compare with what has registered itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace snag {

/// A file or folder of the sources.
inline std::filesystem::path in_sources(const std::string& name) {
  const char* root = std::getenv("SNAG_SOURCE_DIR");
  EXPECT_NE(root, nullptr) << "run by ctest, or set SNAG_SOURCE_DIR";
  return std::filesystem::path(root ? root : ".") / name;
}

/// Number of .cpp files of a folder.
inline std::size_t n_sources(const std::string& folder) {
  const auto files = std::filesystem::directory_iterator(in_sources(folder));
  return static_cast<std::size_t>(std::count_if(begin(files), end(files), [](const auto& f) { return f.path().extension() == ".cpp"; }));
}

}  // namespace snag
