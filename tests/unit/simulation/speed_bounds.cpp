#include "simulation/setup/speed_bounds.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace snag {
namespace {

// Requirement: a particle that is faster than anything in the case can make it ends the run, and is named with its place.
TEST(SpeedBounds, FastParticleIsNamed) {
  RagSettings sphere(RagSettings::Shape::particle);
  sphere.name = "marble", sphere.position = {1, 2, 3}, sphere.velocity = {0, -200, 0};
  const RagSystem rags(MPI_COMM_SELF, {}, {make_piece(sphere, "test")});
  EXPECT_NO_THROW(check_speeds(rags, {250, "fall"}));
  try {
    check_speeds(rags, {100, "fall"});
    FAIL() << "200 m/s are beyond the bound";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::diverged);
    const std::string message = error.what();
    EXPECT_NE(message.find("marble diverged: particle 0 moves with 200 m/s at (1, 2, 3)"), std::string::npos) << message;
    EXPECT_NE(message.find("must not exceed 100 m/s (fall)"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace snag
