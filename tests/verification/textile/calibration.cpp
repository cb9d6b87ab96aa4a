// The simulated laboratory: a strip over an edge, a grab test.
#include "textile/calibration.hpp"

#include <functional>
#include <numbers>

#include "tests/verification/dem/pieces.hpp"
#include "tests/verification/textile/dust_cloth.hpp"

namespace snag {
namespace {

constexpr double pi = std::numbers::pi;

using namespace dust_cloth;

/// Tip of a heavy elastica over an edge: B theta'' = -w (L - s) cos(theta), theta(0) = 0, theta'(L) = 0, theta down from the horizontal;
/// by shooting (classical Runge-Kutta), exact to many digits more than are compared.
Vec3 heavy_elastica(double weight_over_B, double L) {
  constexpr int n = 4000;
  const double ds = L / n;
  struct State {
    double theta, slope, x, z;
  };
  const auto shoot = [&](double slope) {
    State y{0, slope, 0, 0};
    const auto rate = [&](double s, const State& a) {
      return State{a.slope, -weight_over_B * (L - s) * std::cos(a.theta), std::cos(a.theta), -std::sin(a.theta)};
    };
    const auto plus = [](const State& a, double h, const State& b) {
      return State{a.theta + h * b.theta, a.slope + h * b.slope, a.x + h * b.x, a.z + h * b.z};
    };
    for (int i = 0; i < n; ++i) {
      const double s = i * ds;
      const State a = rate(s, y), b = rate(s + ds / 2, plus(y, ds / 2, a)), c = rate(s + ds / 2, plus(y, ds / 2, b)),
                  d = rate(s + ds, plus(y, ds, c));
      y = plus(plus(plus(plus(y, ds / 6, a), ds / 3, b), ds / 3, c), ds / 6, d);
    }
    return y;
  };
  double low = 0, high = weight_over_B * L * L;  // theta' at the edge
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(middle).slope < 0 ? low : high) = middle;
  }
  const State end = shoot(0.5 * (low + high));
  return {end.x, 0, end.z};
}

/// A strip whose bonds neither stretch nor shear to speak of.
Strip stiff_strip(double radius, double overhang, double B) {
  Strip strip{radius, overhang, 0.42, {}};
  strip.bond.bending_stiffness = B / (pi / 4 * std::pow(radius, 4));
  strip.bond.normal_stiffness = strip.bond.tangential_stiffness = 1e3 / (pi * radius * radius);
  return strip;
}

TEST(CalibrationBending, StripIsAHeavyElastica) {
  // Requirement: the tip of the strip at rest tends to that of the heavy elastica with the second order of the particle radius, and is
  // within 1 % of the overhang at 1 mm.
  const double L = 0.0335, B = 2e-5;
  const Vec3 exact = heavy_elastica(0.42 * standard_gravity / B, L);
  const auto error = [&](double radius) { return norm(hanging_strip(stiff_strip(radius, L, B)).tip - exact) / L; };
  const double fine = error(1e-3), coarse = error(2e-3);
  std::printf("tip of the elastica (%.3f, %.3f) mm, error %.2e at 2 mm, %.2e at 1 mm\n", 1e3 * exact.x, 1e3 * exact.z, coarse, fine);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
}

TEST(CalibrationBending, TipIsContinuousInTheOverhang) {
  // Requirement: where one more particle comes over the edge the tip does not jump: less than 0.05 mm.
  const double r = 1.5e-3, edge = 10.5 * 2 * r;
  const Vec3 before = hanging_strip(stiff_strip(r, edge - 1e-7, 2e-5)).tip, after = hanging_strip(stiff_strip(r, edge + 1e-7, 2e-5)).tip;
  EXPECT_LT(norm(after - before), 5e-5);
}

TEST(CalibrationBending, RelaxedStripIsWhereTheMotionEnds) {
  // Requirement: dynamic relaxation and a damped motion with the strip's own masses end at the same shape, to 0.02 mm.
  const TextileTests tests = aro();
  const int n = 11;
  const double r = 1.5e-3;
  Strip strip{r, (n + 0.5) * 2 * r, 0.42, bonds_at(tests, {.radius = r}, 2e5)[0]};
  const StripShape relaxed = hanging_strip(strip);
  RagPiece piece = testing_pieces::cloth(n + 1, 1);
  Rag& rag = piece.rag;
  rag.radius = r, rag.mass = 0.42 * 4 * r * r, rag.inertia = 0.4 * rag.mass * r * r, rag.bond[0] = strip.bond, rag.bond_damping = 0.5;
  piece.centre = {n * r, 0, 0};
  RagSystem rags(MPI_COMM_SELF, {}, {piece});
  rags.clamp([](std::int64_t id) { return id == 0; });
  rags.set_gravity({0, 0, -standard_gravity});
  constexpr double rate = 30;
  rags.set_damping_rate(rate);
  testing_pieces::EachParticle air(rags, [&](Tile& tile, int k, std::int64_t) { testing_pieces::add_drag(rags, tile, k, rate); });
  rags.advance(1.5, &air);
  for (int k = 0; k <= n; ++k) EXPECT_LT(norm(testing_pieces::position(rags, k) - relaxed.centres[k]), 2e-5) << k;
}

TEST(CalibrationBending, TipComesToThePlane) {
  // Requirement: with the calibrated stiffness the tip is on the plane at 41.3 degrees to 0.1 mm at the measured overhang, both
  // directions, three radii; the ratio to the printed stiffness is that of a static chain (0.5 to 0.9).
  const TextileTests tests = aro();
  for (const PublishedBond& line : tests.published) {
    const auto bond = bonds_at(tests, {.radius = line.radius}, line.bond.tangential_stiffness)[line.direction];
    const BendingResult& measured = tests.bending[line.direction];
    const Vec3 tip = hanging_strip({line.radius, measured.overhang, measured.mass_per_area, bond}).tip;
    EXPECT_LT(std::abs(height_above_plane(tip, tests.plane_angle)), 1e-4);
    const double ratio = bond.bending_stiffness / line.bond.bending_stiffness;
    std::printf("%s, %.1f mm: S_nb %.3g N/m3, %.2f of the printed one\n", direction_name[line.direction], 1e3 * line.radius,
                bond.bending_stiffness, ratio);
    EXPECT_GT(ratio, 0.45);
    EXPECT_LT(ratio, 0.95);
  }
}

TEST(CalibrationIndependence, ParticleSizeAndStepDoNotMatter) {
  // Requirement: with the bonds calibrated for each of five radii about 6 mm the cloth tears within 1 % of the same strain and 10 % of the
  // same force (whole particles do not make up the clamps' width exactly), and the tip comes to the plane to 0.1 mm; with steps from a
  // fiftieth of the stable one to four fifths of it the grab test gives the same force and strain to 0.5 %, and the moving strip ends at
  // the same place to 0.1 % of its length.
  const TextileTests tests = aro();
  Calibration calibration;
  calibration.settings.radius = 6e-3;
  calibration.bond = bonds_at(tests, calibration.settings, 4e3);
  expect_independence_of_size_and_step(independence_of_size_and_step(tests, calibration));
}

TEST(CalibrationElongation, GrabTestTearsAtTheMeasuredForce) {
  // Requirement: the simulated grab test reaches its largest force within the measured range, at the measured strain (2 %), in both
  // directions; with the clamps counted twice it carries half of that.
  const TextileTests tests = aro();
  const double r = 1.5e-3;
  for (int d = 0; d < 2; ++d) {
    const ElongationResult& measured = tests.elongation[d];
    const auto bond = bonds_at(tests, {.radius = r}, 2e5);
    const GrabTest test = simulated_grab_test(tests, d, r, {bond[d], bond[1 - d]});
    std::printf("%s: %.1f N at a strain of %.3f\n", direction_name[d], test.max_force, test.strain_at_max);
    EXPECT_GT(test.max_force, measured.force_range.low);
    EXPECT_LT(test.max_force, measured.force_range.high);
    EXPECT_NEAR(test.strain_at_max / measured.max_strain, 1, 0.02);
    const auto half = bonds_at(tests, {.radius = r, .as_published = true}, 2e5);
    EXPECT_NEAR(simulated_grab_test(tests, d, r, {half[d], half[1 - d]}).max_force / test.max_force, 0.5, 0.02);
  }
}

}  // namespace
}  // namespace snag
