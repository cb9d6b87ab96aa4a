#pragma once
// What lies in a folder of the sources, to compare with what has registered itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace snag {

/// Number of .cpp files of a folder.
inline std::size_t n_sources(const std::string& folder) {
  const char* root = std::getenv("SNAG_SOURCE_DIR");
  EXPECT_NE(root, nullptr) << "run by ctest, or set SNAG_SOURCE_DIR";
  if (!root) return 0;
  const auto files = std::filesystem::directory_iterator(std::filesystem::path(root) / folder);
  return static_cast<std::size_t>(std::count_if(begin(files), end(files), [](const auto& f) { return f.path().extension() == ".cpp"; }));
}

}  // namespace snag
