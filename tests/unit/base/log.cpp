// What stands in log.txt.
#include "base/log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/atomic_file.hpp"

namespace {

using namespace snag;

// The file names the kind of a line before its text, once.
TEST(Log, WarningsAndErrorsAreMarkedOnce) {
  const auto file = std::filesystem::temp_directory_path() / ("snag-log-" + std::to_string(getpid()) + ".txt");
  log::open(file, false);
  log::info("a step"), log::warning("a large step"), log::error("too large a step");
  log::flush();
  const std::string text = file_text(file).value_or("");
  std::filesystem::remove(file);
  EXPECT_NE(text.find(" info: a step\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" warning: a large step\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("warning: warning:"), std::string::npos) << text;
  EXPECT_NE(text.find(" error: too large a step\n"), std::string::npos) << text;
}

}  // namespace
