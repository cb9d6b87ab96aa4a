// labels: long
// timeout: 1200
// The simulated laboratory where it takes many drapes: particle size, step and dashpots; relaxation against motion over many layings.
#include <cmath>

#include "tests/verification/textile/dust_cloth.hpp"

namespace snag {
namespace {

using namespace dust_cloth;

TEST(CalibrationLong, ParticleSizeStepAndDashpotsDoNotMatter) {
  // Requirement: what CalibrationIndependence asks of particle size and step; and dashpots and rotation friction change the drape's area by
  // less than 5 %, the same ones not at all.
  const TextileTests tests = aro();
  Calibration calibration;
  calibration.settings.radius = 6e-3;
  calibration.bond = bonds_at(tests, calibration.settings, 4e3);
  const Independence found = independence(MPI_COMM_SELF, tests, calibration);
  expect_independence_of_size_and_step(found);
  for (const auto& points : {found.dampings, found.frictions})
    for (const DampingPoint& point : points) EXPECT_NEAR(point.outline.area / found.dampings[2].outline.area, 1, 0.05);
  EXPECT_EQ(found.dampings[2].outline.area, found.frictions[1].outline.area);
}

TEST(CalibrationLong, RelaxationAndMotionDrapeAlikeInTheMean) {
  // Requirement: over eight layings of the cloth both ways give the same drapes: mean areas and mean wave sizes differ by less than three
  // standard errors of that difference and by less than 3 %, mean numbers of waves by less than half a wave.
  const TextileTests tests = aro();
  const double r = 5e-3;
  const DrapeCloth cloth = drape_cloth(tests, r, bonds_at(tests, {.radius = r}, 6.2e3));
  constexpr int n_seeds = 8;
  struct Mean {
    double sum = 0, squares = 0;
    void add(double x) { sum += x, squares += x * x; }
    double value() const { return sum / n_seeds; }
    double variance() const { return std::max(0.0, squares / n_seeds - value() * value()) / (n_seeds - 1); }  // of the mean
  } area[2], size[2], waves[2];
  for (int seed = 1; seed <= n_seeds; ++seed)
    for (int way = 0; way < 2; ++way) {
      const Drape drape = way == 0 ? relaxed_drape(drape_test(tests), cloth, seed) : moved_drape(drape_test(tests), cloth, seed, 2.5, 3);
      const Outline found = outline_from_above(drape.sheet, r);
      area[way].add(found.area), size[way].add(found.mean_wave_size()), waves[way].add(static_cast<double>(found.waves.size()));
    }
  std::printf("relaxed, moved: area %.2f, %.2f cm2; waves of %.2f, %.2f mm; %.2f, %.2f waves\n", 1e4 * area[0].value(),
              1e4 * area[1].value(), 1e3 * size[0].value(), 1e3 * size[1].value(), waves[0].value(), waves[1].value());
  for (const auto& pair : {area, size}) {
    const double difference = std::abs(pair[0].value() - pair[1].value());
    EXPECT_LT(difference, 3 * std::sqrt(pair[0].variance() + pair[1].variance()));
    EXPECT_LT(difference, 0.03 * pair[0].value());
  }
  EXPECT_LT(std::abs(waves[0].value() - waves[1].value()), 0.5);
}

void expect_same(const Drape& before, const Drape& after, double radius, const char* what) {
  const Outline a = outline_from_above(before.sheet, radius), b = outline_from_above(after.sheet, radius);
  std::printf("%s: %zu waves of %.2f mm, %.2f cm2, %lld steps; then %zu of %.2f mm, %.2f cm2, %lld steps\n", what, a.waves.size(),
              1e3 * a.mean_wave_size(), 1e4 * a.area, static_cast<long long>(before.cost.n_steps), b.waves.size(), 1e3 * b.mean_wave_size(),
              1e4 * b.area, static_cast<long long>(after.cost.n_steps));
  EXPECT_EQ(a.waves.size(), b.waves.size());
  EXPECT_NEAR(b.area / a.area, 1, 0.01);
  EXPECT_NEAR(b.mean_wave_size() / a.mean_wave_size(), 1, 0.01);
}

TEST(CalibrationLong, RelaxationAndMotionRestInTheSameDrapes) {
  // Requirement: where the motion has come to rest after 2.5 s relaxation stays, and where relaxation has come to rest the motion stays: as
  // many waves, areas and wave sizes within 1 %. (Which of its drapes a cloth falls into is another matter: it depends on the laying.)
  const TextileTests tests = aro();
  const double r = 5e-3, air = 3;
  const DrapeTest test = drape_test(tests);
  const DrapeCloth cloth{.radius = r, .bond = bonds_at(tests, {.radius = r}, 6.2e3)};
  const Drape moved = moved_drape(test, cloth, 1, 2.5, air), relaxed = relaxed_drape(test, cloth, 1);
  expect_same(moved, relaxed_drape(test, cloth, 1, &moved.sheet), r, "moved, then relaxed");
  expect_same(relaxed, moved_drape(test, cloth, 1, 1, air, &relaxed.sheet), r, "relaxed, then moved");
  EXPECT_LT(relaxed.cost.n_steps, moved.cost.n_steps);
}

}  // namespace
}  // namespace snag
