// How far a run is: rewritten lines for a terminal, few plain ones for a batch log.
#include "base/progress.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmath>

namespace snag {
namespace {

/// What a piece of work prints to standard output, which is the terminal `slave` meanwhile.
template <class Work>
std::string printed_on_terminal(Work work) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) return "no terminal";
  const int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
  std::fflush(stdout);
  const int saved = dup(STDOUT_FILENO);
  dup2(slave, STDOUT_FILENO);
  work();
  std::fflush(stdout);
  dup2(saved, STDOUT_FILENO);
  close(saved);
  fcntl(master, F_SETFL, O_NONBLOCK);
  std::string text(4096, 0);
  const auto length = read(master, text.data(), text.size());
  close(slave);
  close(master);
  text.resize(std::max<long>(0, length));
  return text;
}

// A duration is written in the two largest units that matter to a person who waits.
TEST(Progress, DurationsAreReadable) {
  EXPECT_EQ(duration(0), "0.0 s");
  EXPECT_EQ(duration(9.94), "9.9 s");
  EXPECT_EQ(duration(9.96), "10 s");
  EXPECT_EQ(duration(12.3), "12 s");
  EXPECT_EQ(duration(119.4), "119 s");
  EXPECT_EQ(duration(119.6), "2 min 00 s");
  EXPECT_EQ(duration(3599.4), "59 min 59 s");
  EXPECT_EQ(duration(3599.6), "1 h 00 min");
  EXPECT_EQ(duration(3 * 3600 + 5 * 60), "3 h 05 min");
  EXPECT_EQ(duration(3 * 3600 - 20), "3 h 00 min");
  EXPECT_EQ(duration(NAN), "? s");
}

// A terminal gets one line, rewritten, with percent, time left and note, and not more than five times a second.
TEST(Progress, TerminalLineIsRewritten) {
  const auto text = printed_on_terminal([] {
    Progress progress("water", 2.0, 1.0);
    for (int i = 0; i < 1000; ++i) progress.update(1.5, "Co 0.8");
  });
  EXPECT_TRUE(text.starts_with("\r\033[Kwater  75.0 %")) << text;
  EXPECT_NE(text.find(" left, Co 0.8"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.find("water", 10), std::string::npos) << "printed more than once within a few milliseconds: " << text;
}

// A batch log is not filled: nothing in the first half minute, one plain line at the end.
TEST(Progress, BatchLogIsShort) {
  testing::internal::CaptureStdout();
  Progress progress("water", 1.0);
  for (int i = 0; i < 1000; ++i) progress.update(i / 1000.0);
  progress.finish();
  const auto text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(text, "water done in 0.0 s\n");
}

}  // namespace
}  // namespace snag
