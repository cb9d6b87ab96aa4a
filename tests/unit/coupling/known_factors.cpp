// ranks: 1 3
#include "coupling/known_factors.hpp"

#include <gtest/gtest.h>

#include "parallel/sum.hpp"
#include "tests/unit/coupling/kernel_box.hpp"

namespace snag {
namespace {

class KnownFactorsTest : public testing::Test {
 protected:
  /// Averages at points near the walls.
  std::vector<double> averages(double width, KnownFactors* known) {
    Kernel kernel(*shape, width, mesh, known);
    kernel.locate(dealt(points));
    return averaged(kernel, field_of(mesh, wave));
  }

  const Mesh mesh = box(world);
  const std::vector<Vec3> points = scattered_points(100);
  const std::unique_ptr<KernelShape> shape = kernel_shapes().make("gaussian", "test");
};

// Requirement: a kernel that takes the factors of one before it is that kernel, to the last bit, and looks for none.
TEST_F(KnownFactorsTest, GiveTheSameKernel) {
  KnownFactors known;
  const auto first = averages(h, &known);
  EXPECT_EQ(averages(h, &known), first);
  EXPECT_EQ(averages(h, nullptr), first);

  KnownFactors of_another;
  of_another.keep(*shape, h, std::vector<double>(mesh.n_cells, 1.0));
  const auto uneven = averages(h, &of_another);
  double largest = 0;
  for (std::size_t b = 0; b < first.size(); ++b) largest = std::max(largest, std::abs(uneven[b] - first[b]));
  EXPECT_GT(maximum(world, largest), 1e-3) << "the kernel did not take what was known";
}

// Requirement: factors hold for one kernel and width only; those that were used last are kept.
TEST_F(KnownFactorsTest, AreOfOneKernelAndWidthAndTheLatest) {
  const auto other = kernel_shapes().make("wendland", "test");
  KnownFactors known;
  known.keep(*shape, 1, {1});
  EXPECT_EQ(known.find(*shape, 2), nullptr);
  EXPECT_EQ(known.find(*other, 1), nullptr);
  for (int width = 2; width < 100; ++width) {
    known.keep(*shape, width, {1.0 * width});
    ASSERT_NE(known.find(*shape, 1), nullptr) << "in use, but forgotten";
  }
  EXPECT_EQ(known.find(*shape, 1)->front(), 1);
  EXPECT_EQ(known.find(*shape, 2), nullptr) << "out of use, but kept";
  ASSERT_NE(known.find(*shape, 99), nullptr);
  EXPECT_EQ(known.find(*shape, 99)->front(), 99);
}

}  // namespace
}  // namespace snag
