// A stiff slender fibre that falls through still water, in creeping flow, at any angle: the speeds along and across of slender bodies
// (Batchelor 1970, cylinder of the aspect ratio p, e = 1/ln(2 p)), and a drift to the side that no free sphere has.
//
//   weight = 2 pi mu L U_t e ((1 + 0.307 e)/(1 - e/2) + 0.426 e^2) = 4 pi mu L U_n e ((1 + 0.307 e)/(1 + e/2) + 0.119 e^2)
//   at the angle a to the vertical: tan(drift) = (1 - q) sin a cos a/(cos^2 a + q sin^2 a), q = U_n/U_t; at most sin(drift) = (1 - q)/(1 +
//   q) p -> infinity: q = 1/2, at most 19.5 degrees
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sphere_motion.hpp"

namespace snag {
namespace {

constexpr double mu = 1, diameter = 2e-3, excess = 100;  // Pa s, m, kg/m3 heavier than the water

/// Velocity, m/s, of a fibre of n particles in the plane x, z at an angle to the vertical.
Vec3 falls(int n, double angle) {
  RagSettings settings(RagSettings::Shape::fibre);
  settings.n_points = n, settings.length = n * diameter, settings.radius = diameter / 2;
  settings.density = 1000 + excess, settings.youngs_modulus = 1e5;
  settings.lengthwise = {std::sin(angle), 0, std::cos(angle)}, settings.crosswise = {0, 1, 0};
  PrescribedFlow flow;
  flow.density = 1000, flow.dynamic_viscosity = mu;
  PieceInFlow run(make_piece(settings, "test"),
                  "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nforces = [\"schiller_naumann\", \"fibre_drag\"]\n", flow);
  run.advance(0.05, 50);
  return run.velocity();
}

double of_slender_body(int n, bool along) {
  const double e = 1 / std::log(2.0 * n), top = 1 + 0.307 * e;
  const double f = along ? 2 * (top / (1 - e / 2) + 0.426 * e * e) : 4 * (top / (1 + e / 2) + 0.119 * e * e);
  return excess * 9.81 * std::numbers::pi / 4 * diameter * diameter / (std::numbers::pi * mu * e * f);
}

// Requirement: along and across its axis a fibre falls as slender bodies do, within 2 %.
TEST(FallingFibre, SpeedsOfSlenderBodies) {
  for (const int n : {12, 24, 48}) {
    const double U_t = -falls(n, 0).z, U_n = -falls(n, std::numbers::pi / 2).z;
    std::printf("  p = %d: along %.4f, across %.4f of slender bodies; across over along %.4f\n", n, U_t / of_slender_body(n, true),
                U_n / of_slender_body(n, false), U_n / U_t);
    EXPECT_NEAR(U_t / of_slender_body(n, true), 1, 0.02);
    EXPECT_NEAR(U_n / of_slender_body(n, false), 1, 0.02);
  }
}

// Requirement: at an angle it drifts to the side as the two speeds say, exactly.
TEST(FallingFibre, DriftsAtAnAngle) {
  constexpr int n = 24;
  const double q = falls(n, std::numbers::pi / 2).z / falls(n, 0).z;
  double most = 0;
  for (const double degrees : {20.0, 40.0, 54.0, 70.0}) {
    const double a = degrees * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
    const Vec3 v = falls(n, a);
    const double drift = std::atan2(v.x, v.z) - std::numbers::pi, exact = std::atan((1 - q) * s * c / (c * c + q * s * s));
    const double found = std::abs(std::remainder(drift, 2 * std::numbers::pi));
    std::printf("  %g degrees: drift %.4f degrees, exact %.4f\n", degrees, found * 180 / std::numbers::pi, exact * 180 / std::numbers::pi);
    EXPECT_NEAR(found, exact, 1e-3 * exact);
    EXPECT_LT(v.x, 0);  // towards the lower end
    most = std::max(most, found);
  }
  EXPECT_NEAR(std::sin(most), (1 - q) / (1 + q), 0.01 * (1 - q) / (1 + q));
}

}  // namespace
}  // namespace snag
