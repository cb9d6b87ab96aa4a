// The lock of an output folder: one holder at a time, named to others, gone with its process.
#include "base/folder_lock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "base/error.hpp"

namespace snag {
namespace {

class LockedFolder : public testing::Test {
 protected:
  std::filesystem::path outer = std::filesystem::temp_directory_path() / ("snag_lock_" + std::to_string(getpid())), folder = outer / "run";
  void TearDown() override { std::filesystem::remove_all(outer); }
};

// A second lock is refused with host and process of the first, until that one ends.
TEST_F(LockedFolder, HasOneHolder) {
  std::optional<FolderLock> first(folder);
  try {
    const FolderLock second(folder);
    ADD_FAILURE() << "locked twice";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.code, ExitCode::io);
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    EXPECT_NE(message.find("process " + std::to_string(getpid()) + " on host " + host), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(folder.string())) << message;
  }
  first.reset();
  EXPECT_NO_THROW(FolderLock{folder});
}

// What a killed process leaves is a file without a lock: it stops nobody.
TEST_F(LockedFolder, IsNotLockedByAFile) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / ".lock") << "process 1 on host elsewhere";
  EXPECT_NO_THROW(FolderLock{folder});
}

// A run that wrote nothing leaves nothing; one that did leaves what it wrote.
TEST_F(LockedFolder, LeavesNothingOfItsOwn) {
  { const FolderLock lock(folder); }
  EXPECT_FALSE(std::filesystem::exists(outer));
  {
    const FolderLock lock(folder);
    std::ofstream(folder / "summary.json") << "{}";
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / ".lock"));
}

// A folder that cannot be made is an input/output error.
TEST_F(LockedFolder, CannotBeInsideAFile) {
  std::filesystem::create_directories(outer);
  std::ofstream(folder) << "a file";
  EXPECT_THROW(FolderLock{folder / "out"}, Error);
}

}  // namespace
}  // namespace snag
