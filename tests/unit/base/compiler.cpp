// What the compiler makes of constants at the flags of the tree.
#include <gtest/gtest.h>

#include <vector>

namespace snag {
namespace {

[[gnu::noinline]] std::vector<double> four() { return std::vector<double>{1, 1, 1, 0}; }
[[gnu::noinline]] std::vector<double> eight() { return std::vector<double>{1, 1, 1, 1, 0, 0, 0, 0}; }
[[gnu::noinline]] std::vector<int> integers() { return std::vector<int>{7, 7, 7, 7, 7, 7, 0, 0}; }

/// GCC 12 with AVX-512 stores ones and sevens to the end, unless the build leaves out what does it.
TEST(Compiler, KeepsZerosAtTheEndOfConstants) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(four()[i], i < 3 ? 1 : 0) << i;
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(eight()[i], i < 4 ? 1 : 0) << i;
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(integers()[i], i < 6 ? 7 : 0) << i;
}

}  // namespace
}  // namespace snag
