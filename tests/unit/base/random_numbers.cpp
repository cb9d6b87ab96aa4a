#include "base/random_numbers.hpp"

#include <gtest/gtest.h>

namespace snag {
namespace {

// Requirement: the mixing function is the published one: first and second number of the generator begun at 0, and begun at 1234567.
TEST(RandomNumbers, AreThoseOfSplitmix64) {
  EXPECT_EQ(mixed(0), 0xe220a8397b1dcdafU);
  EXPECT_EQ(mixed(0x9e3779b97f4a7c15U), 0x6e789e6aa1b965f4U);
  EXPECT_EQ(mixed(1234567), 6457827717110365317U);
}

}  // namespace
}  // namespace snag
