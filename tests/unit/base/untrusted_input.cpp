// Whatever an input holds, its message is short and in a user's words; what has no end is not read.
#include <gtest/gtest.h>

#include <filesystem>
#include <new>

#include "base/atomic_file.hpp"
#include "base/case_file.hpp"
#include "base/explained.hpp"
#include "base/units.hpp"

namespace snag {
namespace {

/// The message of the error that `act` ends with.
template <class Act>
std::string message_of(Act act) {
  try {
    act();
  } catch (const std::exception& failure) {
    return explained(failure).what();
  }
  return "no error";
}

TEST(UntrustedInput, LibrariesAreExplained) {
  EXPECT_NE(message_of([] { throw std::bad_alloc(); }).find("the memory of this machine"), std::string::npos);
  EXPECT_NE(message_of([] { std::vector<double>().reserve(std::size_t(-1)); }).find("smaller mesh"), std::string::npos);
  EXPECT_NE(message_of([] { throw std::domain_error("Error in function boost::math::f"); }).find("defect of the program"),
            std::string::npos);
  EXPECT_EQ(explained(Error(ExitCode::mesh, "a mesh")).code, ExitCode::mesh);
}

TEST(UntrustedInput, LongValuesAreCut) {
  const std::string huge(5000, 'x');
  double length = 1;
  const auto read = [&](const std::string& text) {
    const CaseFile file = CaseFile::parse(text, "case.toml");
    file.root().table("rag").read({{"length", &length, "m", 0, 1, Basis::assumed, "Length."}});
    file.reject_unread();
  };
  for (const std::string& text :
       {"[rag]\nlength = \"" + huge + "\"", "[rag]\nlength = \"1 " + huge + "\"", "[rag]\n" + huge + " = 1", "[" + huge + "]\na = 1",
        "[rag]\nlength_m = [" + std::string(3000, '1') + "]", "[rag]\nlength_m = \"" + huge + "\""}) {
    const std::string message = message_of([&] { read(text); });
    EXPECT_NE(message, "no error");
    EXPECT_LT(message.size(), 600U) << message;
  }
  const auto too_long = std::make_error_code(std::errc::filename_too_long);
  EXPECT_LT(message_of([&] { throw std::filesystem::filesystem_error("status", huge, too_long); }).size(), 300u);
  const std::string path = "results/" + std::string(200, 'x');
  EXPECT_NE(message_of([&] { throw std::filesystem::filesystem_error("status", path, too_long); }).find(path), std::string::npos);
}

TEST(UntrustedInput, DevicesAreNoFiles) { EXPECT_FALSE(file_text("/dev/zero")); }

}  // namespace
}  // namespace snag
