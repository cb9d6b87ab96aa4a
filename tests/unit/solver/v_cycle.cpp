// ranks: 1 3
// long ranks: 2 5
// The multigrid cycle of the pressure equation, on the seven-point matrix of a box of cells.
#include "solver/operators/v_cycle.hpp"

#include <gtest/gtest.h>
#include <petscmat.h>

#include <cmath>
#include <random>

#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// n x n x n cells, layers stretched along the third axis; closed, or with a value fixed at one wall.
class BoxEquation {
 public:
  BoxEquation(int n, bool is_closed) : n_(n), is_closed_(is_closed) {
    check_petsc(MatCreateAIJ(world, PETSC_DECIDE, PETSC_DECIDE, n * n * n, n * n * n, 7, nullptr, 6, nullptr, &matrix_), "MatCreateAIJ");
    check_petsc(MatGetOwnershipRange(matrix_, &first_, &end_), "MatGetOwnershipRange");
    for (PetscInt row = first_; row < end_; ++row) {
      const PetscInt at[] = {row % n, row / n % n, row / (n * n)}, step[] = {1, n, n * n};
      double diagonal = at[0] == 0 && !is_closed ? 2 : 0;
      for (int axis = 0; axis < 3; ++axis)
        for (const int way : {-1, 1}) {
          const PetscInt next = at[axis] + way;
          if (next < 0 || next >= n) continue;
          const double k = axis == 2 ? 0.3 : 1;
          diagonal += k;
          check_petsc(MatSetValue(matrix_, row, row + way * step[axis], -k, INSERT_VALUES), "MatSetValue");
        }
      check_petsc(MatSetValue(matrix_, row, row, diagonal, INSERT_VALUES), "MatSetValue");
    }
    check_petsc(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
    check_petsc(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  }
  BoxEquation(const BoxEquation&) = delete;
  BoxEquation& operator=(const BoxEquation&) = delete;
  ~BoxEquation() { MatDestroy(&matrix_); }

  VCycle cycle() const {
    PC hierarchy = nullptr;
    check_petsc(PCCreate(world, &hierarchy), "PCCreate");
    check_petsc(PCSetType(hierarchy, PCHYPRE), "PCSetType");
    check_petsc(PCHYPRESetType(hierarchy, "boomeramg"), "PCHYPRESetType");
    check_petsc(PCSetOperators(hierarchy, matrix_, matrix_), "PCSetOperators");
    check_petsc(PCSetUp(hierarchy), "PCSetUp");
    VCycle cycle(matrix_, hierarchy, is_closed_);
    check_petsc(PCDestroy(&hierarchy), "PCDestroy");
    return cycle;
  }

  /// z = M^-1 r.
  static std::vector<double> answer(VCycle& cycle, const std::vector<double>& r) {
    const auto n = static_cast<double>(sum(world, static_cast<std::int64_t>(r.size())));
    const double rms = std::sqrt(inner(r, r) / n), mean = inner(r, std::vector<double>(r.size(), 1.0)) / n;
    cycle.apply(r, mean, rms);
    std::vector<double> z(cycle.solution().begin(), cycle.solution().end());
    for (double& value : z) value *= rms;
    return z;
  }

  /// Numbers between -1 and 1, of zero mean, the same on any ranks; this rank's.
  std::vector<double> random_vector(unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> one(-1, 1);
    std::vector<double> all(static_cast<std::size_t>(n_) * n_ * n_);
    double mean = 0;
    for (double& value : all) value = one(random), mean += value / static_cast<double>(all.size());
    for (double& value : all) value -= mean;
    return {all.begin() + first_, all.begin() + end_};
  }
  std::vector<double> product(std::vector<double> x) const {
    Vec from = nullptr, to = nullptr;
    std::vector<double> y(x.size());
    check_petsc(VecCreateMPIWithArray(world, 1, end_ - first_, PETSC_DETERMINE, x.data(), &from), "VecCreateMPIWithArray");
    check_petsc(VecCreateMPIWithArray(world, 1, end_ - first_, PETSC_DETERMINE, y.data(), &to), "VecCreateMPIWithArray");
    check_petsc(MatMult(matrix_, from, to), "MatMult");
    VecDestroy(&from), VecDestroy(&to);
    return y;
  }
  /// Factor of the residual in one of several cycles x += M^-1 (b - A x).
  double convergence(int n_cycles = 6) const {
    VCycle cycle = this->cycle();
    const std::vector<double> b = random_vector(1);
    std::vector<double> x(b.size(), 0.0), residual = b;
    for (int i = 0; i < n_cycles; ++i) {
      const std::vector<double> change = answer(cycle, residual);
      for (std::size_t c = 0; c < x.size(); ++c) x[c] += change[c];
      residual = product(x);
      for (std::size_t c = 0; c < x.size(); ++c) residual[c] = b[c] - residual[c];
    }
    return std::pow(inner(residual, residual) / inner(b, b), 0.5 / n_cycles);
  }
  static double inner(const std::vector<double>& a, const std::vector<double>& b) {
    double local = 0;
    for (std::size_t c = 0; c < a.size(); ++c) local += a[c] * b[c];
    return sum(world, local);
  }

 private:
  int n_;
  bool is_closed_;
  Mat matrix_ = nullptr;
  PetscInt first_ = 0, end_ = 0;
};

class VCycles : public testing::TestWithParam<bool> {};

// Requirement: the cycle is symmetric and positive, as conjugate gradients want it, to single precision.
TEST_P(VCycles, SymmetricAndPositive) {
  const BoxEquation equation(12, GetParam());
  VCycle cycle = equation.cycle();
  EXPECT_GE(cycle.n_levels(), 3);
  const std::vector<double> a = equation.random_vector(2), b = equation.random_vector(3);
  const std::vector<double> Ma = BoxEquation::answer(cycle, a), Mb = BoxEquation::answer(cycle, b);
  const double scale = std::sqrt(BoxEquation::inner(a, Ma) * BoxEquation::inner(b, Mb));
  EXPECT_GT(BoxEquation::inner(a, Ma), 0);
  EXPECT_NEAR(BoxEquation::inner(a, Mb), BoxEquation::inner(b, Ma), 1e-5 * scale);
}

// Requirement: the cycle is the same for small and large numbers; where the constants are the null space it does not feel them, also where
// they are all but the whole of what it is given.
TEST_P(VCycles, SmallNumbersAndConstants) {
  const BoxEquation equation(12, GetParam());
  VCycle cycle = equation.cycle();
  const std::vector<double> r = equation.random_vector(2);
  const std::vector<double> z = BoxEquation::answer(cycle, r);
  std::vector<double> scaled = r;
  for (const double factor : {1e-60, 1e60}) {
    for (std::size_t c = 0; c < r.size(); ++c) scaled[c] = factor * r[c];
    const std::vector<double> answer = BoxEquation::answer(cycle, scaled);
    for (std::size_t c = 0; c < r.size(); ++c) EXPECT_NEAR(answer[c], factor * z[c], 1e-5 * factor);
  }
  if (!GetParam()) return;
  for (std::size_t c = 0; c < r.size(); ++c) scaled[c] = r[c] + 1e3;
  EXPECT_GT(BoxEquation::inner(r, BoxEquation::answer(cycle, scaled)), 0.9 * BoxEquation::inner(r, z));
}

// Requirement: a cycle takes four fifths off the residual, whatever the number of cells, with and without a fixed value.
TEST_P(VCycles, ConvergesAlikeOnAllMeshes) {
  for (const int n : {8, 16, 24}) EXPECT_LT(BoxEquation(n, GetParam()).convergence(), 0.2) << n << " cells a side";
}

// Requirement: the cycle ends at the first level that is small enough to be inverted; where that is the finest, it is the inverse.
TEST_P(VCycles, EndsAtTheFirstSmallLevel) {
  const BoxEquation small(6, GetParam());
  EXPECT_EQ(small.cycle().n_levels(), 1);
  EXPECT_LT(small.convergence(1), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Walls, VCycles, testing::Bool(), [](const auto& one) { return one.param ? "closed" : "fixed"; });

}  // namespace
}  // namespace snag
