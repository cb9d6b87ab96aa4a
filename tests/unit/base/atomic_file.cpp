// Files that are replaced as a whole: what is renamed is on the disk before, and its name after.
#include "base/atomic_file.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

namespace {

std::vector<std::string> calls;  // of the two functions below, which stand before those of the C library

template <class Function, class... Arguments>
int passed_on(const char* name, Arguments... arguments) {
  calls.emplace_back(name);
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name))(arguments...);
}

}  // namespace

extern "C" int fsync(int file) { return passed_on<int(int)>("fsync", file); }
extern "C" int rename(const char* from, const char* to) noexcept { return passed_on<int(const char*, const char*)>("rename", from, to); }

namespace snag {
namespace {

// After a power cut the name stands for the old content or the new one.
TEST(AtomicFile, IsOnTheDiskBeforeItIsRenamed) {
  const auto file = std::filesystem::temp_directory_path() / ("snag_atomic_" + std::to_string(getpid()));
  write_atomically(file, "old");
  calls.clear();
  write_atomically(file, "new");
  EXPECT_EQ(calls, (std::vector<std::string>{"fsync", "rename", "fsync"})) << "content, name, folder";
  EXPECT_EQ(file_text(file), "new");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace snag
