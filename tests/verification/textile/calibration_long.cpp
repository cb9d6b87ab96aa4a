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

}  // namespace
}  // namespace snag
