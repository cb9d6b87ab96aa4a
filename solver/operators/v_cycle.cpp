#include "solver/operators/v_cycle.hpp"

#include <petscmat.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr int largest_inverse = 256;       // rows of a level that is inverted and so the coarsest
constexpr double null_eigenvalue = 1e-12;  // of the largest: nothing but round-off

MPI_Comm comm_of(Mat matrix) { return PetscObjectComm(reinterpret_cast<PetscObject>(matrix)); }

}  // namespace

/// Rows of this rank of a matrix, columns in global numbers.
struct VCycle::GlobalRows {
  std::vector<int> start{0};
  std::vector<PetscInt> column;
  std::vector<double> value;
  PetscInt first_row = 0, first_column = 0, n_rows = 0, n_columns = 0;  // of this rank
  std::vector<PetscInt> row_ranges, column_ranges;                      // [ranks + 1]

  explicit GlobalRows(Mat matrix) {
    const int ranks = size_of(comm_of(matrix));
    PetscInt end = 0;
    check_petsc(MatGetOwnershipRange(matrix, &first_row, &end), "MatGetOwnershipRange");
    n_rows = end - first_row;
    check_petsc(MatGetOwnershipRangeColumn(matrix, &first_column, &end), "MatGetOwnershipRangeColumn");
    n_columns = end - first_column;
    const PetscInt* ranges = nullptr;
    check_petsc(MatGetOwnershipRanges(matrix, &ranges), "MatGetOwnershipRanges");
    row_ranges.assign(ranges, ranges + ranks + 1);
    check_petsc(MatGetOwnershipRangesColumn(matrix, &ranges), "MatGetOwnershipRangesColumn");
    column_ranges.assign(ranges, ranges + ranks + 1);
    for (PetscInt row = first_row; row < first_row + n_rows; ++row) {
      PetscInt n = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      check_petsc(MatGetRow(matrix, row, &n, &columns, &values), "MatGetRow");
      column.insert(column.end(), columns, columns + n), value.insert(value.end(), values, values + n);
      start.push_back(static_cast<int>(column.size()));
      check_petsc(MatRestoreRow(matrix, row, &n, &columns, &values), "MatRestoreRow");
    }
  }

  /// Adds the columns of other ranks to `ghosts`.
  void add_ghosts(std::vector<PetscInt>& ghosts) const {
    for (const PetscInt c : column)
      if (c < first_column || c >= first_column + n_columns) ghosts.push_back(c);
  }
};

/// Places of global numbers in the vectors of a level: owned ones, then ghosts.
class VCycle::Numbering {
 public:
  Numbering(const GlobalRows& matrix, std::vector<PetscInt> ghosts)
      : first_(matrix.first_column), n_(matrix.n_columns), ghosts_(std::move(ghosts)) {
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    ranges_ = matrix.column_ranges;
  }
  int place(PetscInt column) const {
    if (column >= first_ && column < first_ + n_) return static_cast<int>(column - first_);
    return static_cast<int>(n_ + (std::lower_bound(ghosts_.begin(), ghosts_.end(), column) - ghosts_.begin()));
  }
  std::size_t n_all() const { return static_cast<std::size_t>(n_) + ghosts_.size(); }
  Halo halo(MPI_Comm comm) const {
    std::vector<int> owner_rank, owner_index;
    for (const PetscInt g : ghosts_) {
      const auto next = std::upper_bound(ranges_.begin(), ranges_.end(), g);
      owner_rank.push_back(static_cast<int>(next - ranges_.begin()) - 1);
      owner_index.push_back(static_cast<int>(g - *(next - 1)));
    }
    return {comm, static_cast<int>(n_), owner_rank, owner_index};
  }

 private:
  PetscInt first_, n_;
  std::vector<PetscInt> ghosts_, ranges_;
};

template <int block>
void VCycle::SortedRows<block>::fill(const GlobalRows& from, const Numbering& numbers) {
  const auto blocks = [&](int i) { return (from.start[i + 1] - from.start[i] + block - 1) / block; };
  row_.resize(from.start.size() - 1);
  std::iota(row_.begin(), row_.end(), 0);
  std::stable_sort(row_.begin(), row_.end(), [&](int a, int b) { return blocks(a) < blocks(b); });
  for (const int i : row_) {
    const int length = blocks(i) * block;
    if (run_.empty() || run_.back().length != length) run_.push_back({length, 0});
    ++run_.back().n_rows;
    for (int e = from.start[i]; e < from.start[i + 1]; ++e)
      column_.push_back(numbers.place(from.column[e])), value_.push_back(static_cast<Value>(from.value[e]));
    for (int e = from.start[i + 1] - from.start[i]; e < length; ++e) column_.push_back(column_.back()), value_.push_back(0);
  }
  run_.shrink_to_fit(), column_.shrink_to_fit(), value_.shrink_to_fit();
}

template <int block>
template <class Act>
void VCycle::SortedRows<block>::multiply(const Value* x, const Act& act) const {
  const int *row = row_.data(), *column = column_.data();
  const Value* value = value_.data();
  const auto multiply_run = [&](int n_rows, auto length) {
    for (const int* const end = row + n_rows; row != end; ++row, column += length, value += length) {
      std::array<Value, block> part{};
      for (int e = 0; e < length; e += block)
        for (int k = 0; k < block; ++k) part[k] += value[e + k] * x[column[e + k]];
      for (int half = block / 2; half > 0; half /= 2)
        for (int k = 0; k < half; ++k) part[k] += part[k + half];
      act(*row, part[0]);
    }
  };
  for (const Run& run : run_) {
    if (run.length == 1)
      multiply_run(run.n_rows, std::integral_constant<int, 1>{});
    else if (run.length == 2)
      multiply_run(run.n_rows, std::integral_constant<int, 2>{});
    else
      multiply_run(run.n_rows, run.length);
  }
}

VCycle::VCycle(Mat finest, PC hierarchy, bool singular) : comm_(comm_of(finest)), singular_(singular) {
  PetscInt n_levels = 0;
  Mat *interpolations = nullptr, *coarse = nullptr;  // the coarsest first
  check_petsc(PCGetInterpolations(hierarchy, &n_levels, &interpolations), "PCGetInterpolations");
  check_petsc(PCGetCoarseOperators(hierarchy, &n_levels, &coarse), "PCGetCoarseOperators");
  std::optional<GlobalRows> prolongation, of_last;
  for (PetscInt l = 0; l < n_levels; ++l) {
    const bool is_in_use = coarsest_start_.empty();  // no small one is above it
    std::optional<GlobalRows> matrix, restriction;
    if (is_in_use) matrix.emplace(l == 0 ? finest : coarse[n_levels - 1 - l]);
    if (l > 0) check_petsc(MatDestroy(&coarse[n_levels - 1 - l]), "MatDestroy");
    of_last = std::exchange(prolongation, std::nullopt);
    const bool is_small = is_in_use && matrix->row_ranges.back() <= largest_inverse;
    if (l + 1 < n_levels) {
      Mat &interpolation = interpolations[n_levels - 2 - l], transposed = nullptr;
      if (is_in_use && !is_small) {
        prolongation.emplace(interpolation);
        check_petsc(MatTranspose(interpolation, MAT_INITIAL_MATRIX, &transposed), "MatTranspose");
      }
      check_petsc(MatDestroy(&interpolation), "MatDestroy");
      if (transposed) restriction.emplace(transposed);
      check_petsc(MatDestroy(&transposed), "MatDestroy");
    }
    if (is_in_use) add_level(*matrix, restriction ? &*restriction : nullptr, of_last ? &*of_last : nullptr);
    if (is_small) invert_coarsest(*matrix);
  }
  check_petsc(PetscFree(interpolations), "PetscFree");
  check_petsc(PetscFree(coarse), "PetscFree");
}

/// Below the last one.
void VCycle::add_level(const GlobalRows& matrix, const GlobalRows* restriction, const GlobalRows* prolongation_of_last) {
  std::vector<PetscInt> ghosts;
  for (const GlobalRows* rows : {&matrix, restriction, prolongation_of_last})
    if (rows) rows->add_ghosts(ghosts);
  const Numbering numbers(matrix, std::move(ghosts));
  if (prolongation_of_last) levels_.back().prolongation.fill(*prolongation_of_last, numbers);
  Level& level = levels_.emplace_back();
  level.n = static_cast<int>(matrix.n_rows);
  level.halo = numbers.halo(comm_);
  level.b.assign(static_cast<std::size_t>(level.n), 0);
  for (auto* vector : {&level.x, &level.residual}) vector->assign(numbers.n_all(), 0);
  fill_matrix(level, numbers, matrix);
  if (restriction) level.restriction.fill(*restriction, numbers);
}

void VCycle::fill_matrix(Level& level, const Numbering& numbers, const GlobalRows& from) {
  std::vector<std::pair<int, double>> row;
  level.over_diagonal.reserve(static_cast<std::size_t>(level.n));
  for (int i = 0; i < level.n; ++i) {
    row.clear();
    double diagonal = 0;
    for (int e = from.start[i]; e < from.start[i + 1]; ++e) {
      const int j = numbers.place(from.column[e]);
      if (j == i)
        diagonal += from.value[e];
      else
        row.emplace_back(j, from.value[e]);
    }
    std::sort(row.begin(), row.end());
    for (const auto& [j, value] : row) {
      level.matrix.add(j, value);
      if (j >= level.n) level.ghost_matrix.push_back({i, j, static_cast<Value>(value)});
    }
    level.matrix.end_row();
    level.over_diagonal.push_back(diagonal > 0 ? static_cast<Value>(1 / diagonal) : 0);
  }
  level.matrix.fit(), level.ghost_matrix.shrink_to_fit();
}

template <int block>
void VCycle::Rows<block>::end_row() {
  while ((static_cast<int>(column.size()) - start.back()) % block != 0) add(column.back(), 0);
  start.push_back(static_cast<int>(column.size()));
}

void VCycle::invert_coarsest(const GlobalRows& from) {
  const PetscInt n_all = from.row_ranges.back();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_all, n_all);
  for (PetscInt i = 0; i < from.n_rows; ++i)
    for (int e = from.start[i]; e < from.start[i + 1]; ++e) A(from.first_row + i, from.column[e]) += from.value[e];
  MPI_Allreduce(MPI_IN_PLACE, A.data(), static_cast<int>(A.size()), MPI_DOUBLE, MPI_SUM, comm_);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(0.5 * (A + A.transpose()));
  const Eigen::VectorXd& lambda = modes.eigenvalues();
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n_all);
  for (PetscInt m = singular_ ? 1 : 0; m < n_all; ++m)  // of the first one only round-off is left then
    if (lambda[m] > null_eigenvalue * lambda[n_all - 1]) inverse[m] = 1 / lambda[m];
  const Eigen::MatrixXd B = modes.eigenvectors() * inverse.asDiagonal() * modes.eigenvectors().transpose();
  for (PetscInt i = 0; i < from.n_rows; ++i)
    for (PetscInt j = 0; j < n_all; ++j) coarsest_inverse_.push_back(B(from.first_row + i, j));
  for (std::size_t r = 0; r + 1 < from.row_ranges.size(); ++r) {
    coarsest_start_.push_back(static_cast<int>(from.row_ranges[r]));
    coarsest_count_.push_back(static_cast<int>(from.row_ranges[r + 1] - from.row_ranges[r]));
  }
}

std::array<double, 2> VCycle::apply(std::span<const double> r, double mean, double rms) {
  Level& finest = levels_.front();
  const double taken_off = singular_ ? mean : 0, factor = 1 / rms;
  for (int i = 0; i < finest.n; ++i) finest.b[i] = static_cast<Value>((r[i] - taken_off) * factor);
  const Sums sums = descend(0);
  return {rms * sums.x, rms * (rms * sums.b_x + taken_off * sums.x)};
}

/// Solves on a level and those below; returns the sums of x and of b x.
VCycle::Sums VCycle::descend(std::size_t l) {
  if (l + 1 == levels_.size()) return solve_coarsest();
  Level &fine = levels_[l], &coarse = levels_[l + 1];
  sweep_forward(fine);
  fine.halo.exchange(std::span(fine.x));
  complete_residual(fine);
  fine.halo.exchange(std::span(fine.residual));
  fine.restriction.multiply(fine.residual.data(), [b = coarse.b.data()](int i, Value sum) { b[i] = sum; });
  descend(l + 1);
  coarse.halo.exchange(std::span(coarse.x));
  fine.prolongation.multiply(coarse.x.data(), [x = fine.x.data()](int i, Value sum) { x[i] += sum; });
  fine.halo.exchange(std::span(fine.x));
  return sweep_backward(fine);
}

/// From x = 0, ghosts too. The residual lacks - G x.
void VCycle::sweep_forward(Level& level) {
  std::fill(level.residual.begin(), level.residual.end(), Value{0});
  const auto& [start, column, value] = level.matrix;
  Value* const residual = level.residual.data();
  for (int i = 0; i < level.n; ++i) {
    const Value rest = level.b[i] + residual[i], x = rest * level.over_diagonal[i];
    level.x[i] = x;
    residual[i] = level.over_diagonal[i] > 0 ? 0 : rest;
    for (int e = start[i], end = start[i + 1]; e < end; e += 4)
      for (int k = 0; k < 4; ++k) residual[column[e + k]] -= value[e + k] * x;
  }
}

void VCycle::complete_residual(Level& level) {
  for (const auto& [row, column, value] : level.ghost_matrix) level.residual[row] -= value * level.x[column];
}

VCycle::Sums VCycle::sweep_backward(Level& level) {
  Sums sums;
  for (int i = level.n - 1; i >= 0; --i) {
    const Value b = level.b[i], x = (b - level.matrix.product(i, level.x.data())) * level.over_diagonal[i];
    level.x[i] = x;
    sums.x += x, sums.b_x += static_cast<double>(b) * x;
  }
  return sums;
}

VCycle::Sums VCycle::sums_of(const Level& level) {
  Sums sums;
  for (int i = 0; i < level.n; ++i) sums.x += level.x[i], sums.b_x += static_cast<double>(level.b[i]) * level.x[i];
  return sums;
}

VCycle::Sums VCycle::solve_coarsest() {
  Level& level = levels_.back();
  if (coarsest_start_.empty()) {
    sweep_forward(level);
    level.halo.exchange(std::span(level.x));
    return sweep_backward(level);
  }
  const int n_all = coarsest_start_.back() + coarsest_count_.back();
  std::vector<Value> b(n_all);
  MPI_Allgatherv(level.b.data(), level.n, MPI_FLOAT, b.data(), coarsest_count_.data(), coarsest_start_.data(), MPI_FLOAT, comm_);
  for (int i = 0; i < level.n; ++i)
    level.x[i] = static_cast<Value>(std::inner_product(b.begin(), b.end(), &coarsest_inverse_[static_cast<std::size_t>(i) * n_all], 0.0));
  return sums_of(level);
}

}  // namespace snag
