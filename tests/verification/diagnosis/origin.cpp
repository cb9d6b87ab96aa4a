// timeout: 300
// Requirement: a gap that one window makes is told from one that later windows only carry on, by runs that go on from the measured state at
// the begin of a window.
#include <gtest/gtest.h>

#include "diagnosis/attribution/gap_origin.hpp"
#include "diagnosis/localisation/gap_cells.hpp"
#include "tests/verification/diagnosis/formula.hpp"

using namespace snag;

namespace {

std::vector<GapCell> cells_of(const formula::Truth& truth, std::uint64_t seed) {
  const Experiment experiment = formula::experiment(truth, 6, 0, 3, 3e-4, seed);
  formula::Sphere sphere(experiment);
  Responses model(experiment, sphere);
  Fitter fitter(model);
  std::vector<GapCell> cells = gap_cells(model, fitter, FittedGap(model, fitter.fit({}, Eigen::VectorXd())));
  judge_origins(model, fitter, cells);
  return cells;
}

struct Count {
  int born = 0, inherited = 0;
  int judged() const { return born + inherited; }
};

/// By window: 0 to 3.
std::array<Count, 4> counted(const formula::Truth& truth, int n_sets) {
  std::array<Count, 4> counts;
  for (int i = 0; i < n_sets; ++i) {
    for (const GapCell& cell : cells_of(truth, 300 + i)) {
      Count& count = counts[static_cast<std::size_t>(cell.window[0] / 0.2)];
      count.born += cell.origin == GapOrigin::born, count.inherited += cell.origin == GapOrigin::inherited;
    }
  }
  for (const Count& count : counts) std::printf("born %d, inherited %d; ", count.born, count.inherited);
  std::printf("\n");
  return counts;
}

}  // namespace

// A gust between 0.30 s and 0.38 s, in the second of four windows of 0.2 s: born there, carried on by the third and the fourth.
TEST(Origin, OfAGustInOneWindow) {
  const auto counts = counted({.gust = 4}, 5);
  EXPECT_EQ(counts[0].judged(), 0);  // the start is given, there is nothing to inherit from
  EXPECT_GE(counts[1].judged(), 20);
  EXPECT_GE(counts[1].born, 0.8 * counts[1].judged());
  for (int window : {2, 3}) {
    EXPECT_GE(counts[window].judged(), 30);
    EXPECT_GE(counts[window].inherited, 0.95 * counts[window].judged());
  }
}

// A flow that is faster by two thirds makes new gaps after the start at every point, whatever it hands on from window to window.
TEST(Origin, OfAFlowThatIsWrongAllTheTime) {
  int with_new_gap = 0, n = 0;
  for (int i = 0; i < 5; ++i) {
    std::map<std::string, int> born;  // by point
    for (const GapCell& cell : cells_of({.effects = {{"operating_point", 0.67}}}, 300 + i))
      born[cell.point] += cell.origin == GapOrigin::born;
    for (const auto& [point, cells] : born) with_new_gap += cells > 0, ++n;
  }
  std::printf("%d of %d points with a gap born after the start\n", with_new_gap, n);
  EXPECT_EQ(n, 30);
  EXPECT_GE(with_new_gap, 27);
}
