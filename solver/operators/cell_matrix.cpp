// Gauss-Seidel:   x_i <- a_ii^-1 (b_i - sum_{j /= i} a_ij x_j),   row residual  r_i = a_ii (x_i^new - x_i^old)
// a_ii of a coupled row is a 3 x 3 block.
// The convection-diffusion matrix of upwind fluxes and a time derivative is diagonally dominant: sweeps, forward and backward in turn,
// converge, fast for Courant and diffusion numbers to about 10. In layers of thin cells at walls the diffusion number of a step reaches
// some hundreds, and a change crosses one cell a sweep.
//
// BiCGStab (van der Vorst 1992, SIAM J. Sci. Stat. Comput. 13, 631-644) takes over where sweeps would need many more at their present rate.
// Its preconditioner from the right is one symmetric Gauss-Seidel sweep over the cells of each rank. Sweeps follow it: they test the
// residual by the same measure, and take values that it left at zero or below back to positive ones, from those of the last sweep.
#include "solver/operators/cell_matrix.hpp"
#include "base/flat.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace snag {

namespace {
constexpr int spare_facets = 6;  // of a row at a sliding interface
}

CellMatrix::CellMatrix(const Mesh& mesh) { build(mesh); }

void CellMatrix::update(const Mesh& mesh) {
  if (!place_facets(mesh)) build(mesh);
}

/// All rows, with room for the facets of now and some more.
void CellMatrix::build(const Mesh& mesh) {
  const auto count = [&](int first, int end, std::vector<int>& n) {
    for (int f = first; f < end; ++f)
      for (const int c : {mesh.owner[f], mesh.neighbour[f]})
        if (c < mesh.n_cells) ++n[static_cast<std::size_t>(c)];
  };
  std::vector<int> next(static_cast<std::size_t>(mesh.n_cells)), n_facets(next.size());
  count(0, mesh.first_facet, next), count(mesh.first_facet, mesh.n_interior, n_facets);
  // A row keeps the room that it had: else one of thousands lacks some at nearly every angle.
  std::vector<int> room(next.size());
  for (const auto& [row, first] : facet_rows_) room[row] = row_start[row + 1] - first;
  row_start.assign(1, 0), facet_rows_.clear();
  row_start.reserve(next.size() + 1);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const int begin = row_start.back(), facets = begin + next[c];
    if (n_facets[c] > 0 || room[c] > 0) facet_rows_.push_back({c, facets});
    if (n_facets[c] > room[c]) room[c] = n_facets[c] + spare_facets;
    const int length = next[c] + room[c];
    row_start.push_back(begin + (length + 1) / 2 * 2);
    next[c] = begin;
  }
  column.assign(static_cast<std::size_t>(row_start.back()), 0);
  for (int c = 0; c < mesh.n_cells; ++c) std::fill(&column[row_start[c]], &column[row_start[c + 1]], c);
  value.assign(column.size() + 1, 0);
  place_of_owner.resize(static_cast<std::size_t>(mesh.n_interior)), place_of_neighbour.resize(place_of_owner.size());
  const auto place = [&](int row, int col) {
    if (row >= mesh.n_cells) return row_start.back();
    column[next[row]] = col;
    return next[row]++;
  };
  for (int f = 0; f < mesh.first_facet; ++f) {
    place_of_owner[f] = place(mesh.owner[f], mesh.neighbour[f]);
    place_of_neighbour[f] = place(mesh.neighbour[f], mesh.owner[f]);
  }
  place_facets(mesh);
}

/// Returns false where a row has no room for its facets.
bool CellMatrix::place_facets(const Mesh& mesh) {
  for (auto* place : {&place_of_owner, &place_of_neighbour}) resize_with_room(*place, static_cast<std::size_t>(mesh.n_interior));
  std::vector<int> next(row_start.begin() + 1, row_start.end());  // rows that had no facets are full
  for (const auto& [row, first] : facet_rows_) {
    next[row] = first;
    for (int e = first; e < row_start[row + 1]; ++e) column[e] = row, value[e] = 0;
  }
  bool fits = true;
  const auto place_in = [&](int row, int col) {
    if (row >= mesh.n_cells) return row_start.back();
    if (next[row] == row_start[row + 1]) {
      fits = false;
      return row_start.back();
    }
    column[next[row]] = col;
    return next[row]++;
  };
  for (int f = mesh.first_facet; f < mesh.n_interior; ++f) {
    place_of_owner[f] = place_in(mesh.owner[f], mesh.neighbour[f]);
    place_of_neighbour[f] = place_in(mesh.neighbour[f], mesh.owner[f]);
  }
  return fits;
}

namespace {

inline Vec3 ratio(const Vec3& a, const Vec3& b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
inline Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double square(double a) { return a * a; }
inline double square(const Vec3& a) { return norm_squared(a); }

inline void exchange(const Mesh& mesh, std::vector<double>& x) { mesh.halo.exchange(x); }
inline void exchange(const Mesh& mesh, std::vector<Vec3>& x) { mesh.halo.exchange(flat(x), 3); }

/// a_ii of a coupled row.
struct Block {
  int cell;
  Mat3 matrix, inverse;
};

std::vector<Block> blocks_of(std::span<const Vec3> diagonal, std::span<const CoupledRow> coupled) {
  std::vector<Block> blocks;
  blocks.reserve(coupled.size());
  for (const auto& [cell, off] : coupled) {
    const Vec3& d = diagonal[static_cast<std::size_t>(cell)];
    const Mat3 A{Vec3{d.x, off.z, off.y}, Vec3{off.z, d.y, off.x}, Vec3{off.y, off.x, d.z}};
    const Vec3 yz = cross(A[1], A[2]), zx = cross(A[2], A[0]), xy = cross(A[0], A[1]);
    const double determinant = dot(A[0], yz);
    blocks.push_back({cell, A, {yz / determinant, zx / determinant, xy / determinant}});  // the inverse of a symmetric matrix is symmetric
  }
  return blocks;
}
std::vector<Block> blocks_of(std::span<const double>, std::span<const CoupledRow>) { return {}; }

/// The blocks in the order of a sweep.
template <bool forward>
class BlockCursor {
 public:
  explicit BlockCursor(std::span<const Block> blocks) : blocks_(blocks), left_(blocks.size()) { find_next(); }
  /// That of row i, which is behind all rows that were asked for; null if it is not coupled.
  const Block* of(int i) {
    if (i != cell_) return nullptr;
    const Block* const found = &blocks_[next_];
    --left_, find_next();
    return found;
  }

 private:
  void find_next() {
    next_ = forward ? blocks_.size() - left_ : left_ - 1;
    cell_ = left_ > 0 ? blocks_[next_].cell : -1;
  }
  std::span<const Block> blocks_;
  std::size_t left_, next_ = 0;
  int cell_ = -1;
};

inline double product(const Block*, double diagonal, double x) { return diagonal * x; }
inline Vec3 product(const Block* block, const Vec3& diagonal, const Vec3& x) { return block ? block->matrix * x : times(diagonal, x); }
inline double solution(const Block*, double diagonal, double rest) { return rest / diagonal; }
inline Vec3 solution(const Block* block, const Vec3& diagonal, const Vec3& rest) {
  return block ? block->inverse * rest : ratio(rest, diagonal);
}

/// One sweep, forward or backward; returns the sum of the squares of the row residuals.
template <bool forward, class Value>
double sweep(int n_cells, const CellMatrix& matrix, const Value* diagonal, std::span<const Block> blocks, const Value* b, Value* x) {
  double squares = 0;
  BlockCursor<forward> block(blocks);
  for (int row = 0; row < n_cells; ++row) {
    const int i = forward ? row : n_cells - 1 - row;
    const Value rest = b[i] - matrix.product(i, x);
    const Block* const coupled = block.of(i);
    squares += square(rest - product(coupled, diagonal[i], x[i]));
    x[i] = solution(coupled, diagonal[i], rest);
  }
  return squares;
}

inline double scalar_product(double a, double b) { return a * b; }
inline double scalar_product(const Vec3& a, const Vec3& b) { return dot(a, b); }
inline bool is_positive(double a) { return a > 0; }
inline bool is_positive(const Vec3&) { return true; }

constexpr int first_look = 8;    // sweeps before their rate is judged
constexpr double patience = 40;  // sweeps that are still accepted
constexpr int sweeps_of_iteration = 6;

template <class Value>
class BiCgStab {
 public:
  BiCgStab(const Mesh& mesh, const CellMatrix& matrix, std::span<const Value> diagonal, std::span<const Block> blocks)
      : mesh_(mesh), matrix_(matrix), diagonal_(diagonal), blocks_(blocks), n_(static_cast<std::size_t>(mesh.n_cells)) {
    for (auto* vector : {&r_, &shadow_, &p_, &v_, &t_}) vector->resize(n_);
    for (auto* vector : {&p_hat_, &s_hat_}) vector->resize(static_cast<std::size_t>(mesh.n_all_cells()));
  }

  /// Until |b - A x| <= target, or for so many iterations, or until it breaks down; x stays as it was if that does not bring the residual
  /// down, which is not monotonic. Returns the number of iterations.
  int solve(std::span<const Value> b, std::vector<Value>& x, double target, int most_iterations) {
    multiply(x, r_);
    for (std::size_t i = 0; i < n_; ++i) r_[i] = b[i] - r_[i];
    shadow_ = r_, p_ = r_;
    const std::vector<Value> begun = x;
    double rho = product(shadow_, r_);
    const double before = std::sqrt(rho);
    double residual = before;
    int iterations = 0;
    while (iterations < most_iterations && residual > target && std::abs(rho) > std::numeric_limits<double>::min()) {
      ++iterations;
      precondition(p_, p_hat_);
      multiply(p_hat_, v_);
      const double alpha = rho / product(shadow_, v_);
      if (!std::isfinite(alpha)) break;
      for (std::size_t i = 0; i < n_; ++i) r_[i] -= alpha * v_[i];
      precondition(r_, s_hat_);
      multiply(s_hat_, t_);
      const double t_r = product(t_, r_), t_t = product(t_, t_), step = t_t > 0 ? t_r / t_t : 0;
      for (std::size_t i = 0; i < n_; ++i) x[i] += alpha * p_hat_[i] + step * s_hat_[i], r_[i] -= step * t_[i];
      residual = std::sqrt(product(r_, r_));
      if (step == 0) break;
      const double rho_new = product(shadow_, r_), beta = rho_new / rho * alpha / step;
      rho = rho_new;
      for (std::size_t i = 0; i < n_; ++i) p_[i] = r_[i] + beta * (p_[i] - step * v_[i]);
    }
    if (!(residual < before)) x = begun;
    return iterations;
  }

 private:
  void multiply(std::vector<Value>& x, std::vector<Value>& y) const {
    exchange(mesh_, x);
    BlockCursor<true> block(blocks_);
    for (int i = 0; i < mesh_.n_cells; ++i) y[i] = snag::product(block.of(i), diagonal_[i], x[i]) + matrix_.product(i, x.data());
  }
  /// z of (D + L) D^-1 (D + U) z = r among the cells of this rank.
  void precondition(const std::vector<Value>& r, std::vector<Value>& z) const {
    std::fill(z.begin(), z.end(), Value{});
    const auto relax = [&](int i, auto& block) { z[i] = solution(block.of(i), diagonal_[i], r[i] - matrix_.product(i, z.data())); };
    BlockCursor<true> next(blocks_);
    for (int i = 0; i < mesh_.n_cells; ++i) relax(i, next);
    BlockCursor<false> back(blocks_);
    for (int i = mesh_.n_cells - 1; i >= 0; --i) relax(i, back);
  }
  double product(const std::vector<Value>& a, const std::vector<Value>& b) const {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += scalar_product(a[i], b[i]);
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return sum;
  }
  const Mesh& mesh_;
  const CellMatrix& matrix_;
  std::span<const Value> diagonal_;
  std::span<const Block> blocks_;
  std::size_t n_;
  std::vector<Value> r_, shadow_, p_, v_, t_;  // [n_cells]
  std::vector<Value> p_hat_, s_hat_;           // [n_all_cells]
};

/// True if sweeps that brought the residual from `first` to `last` in two would need too many more to bring it to `wanted`.
bool stalls(double first, double last, double wanted) {
  if (last >= first) return true;
  return 2 * std::log(wanted / last) / std::log(last / first) > patience;
}

}  // namespace

template <class Value>
SweepReport solve_rows(const Mesh& mesh, const CellMatrix& matrix, std::span<const Value> diagonal, std::span<const Value> b,
                       std::vector<Value>& x, double tolerance, int max_sweeps, bool positive, std::span<const CoupledRow> coupled) {
  SweepReport report;
  const std::vector<Block> blocks = blocks_of(diagonal, coupled);
  double scale = 0, before = 0, share_of_tolerance = 1;  // before: the residual two sweeps ago
  int since_look = 0;
  for (int c = 0; c < mesh.n_cells; ++c) scale += square(b[c]);
  bool forward = true;
  while (report.sweeps < max_sweeps) {
    exchange(mesh, x);
    const double squares = forward ? sweep<true>(mesh.n_cells, matrix, diagonal.data(), blocks, b.data(), x.data())
                                   : sweep<false>(mesh.n_cells, matrix, diagonal.data(), blocks, b.data(), x.data());
    std::array<double, 2> all{squares, scale};
    MPI_Allreduce(MPI_IN_PLACE, all.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
    const double reference = all[1] > 0 ? std::sqrt(all[1]) : 1;
    const double two_before = std::exchange(before, report.final);
    report.final = std::sqrt(all[0]) / reference;
    if (++report.sweeps == 1) report.initial = report.final;
    report.converged = report.final <= tolerance;
    if (report.converged || !std::isfinite(report.final)) break;
    forward = !forward;
    // Sweeps to and fro are not alike: each is compared with the last of its kind.
    if (++since_look < first_look || report.sweeps >= max_sweeps || !stalls(two_before, report.final, tolerance)) continue;
    const std::vector<Value> swept = x;
    const int most = (max_sweeps - report.sweeps) / sweeps_of_iteration;
    // Along a row of thin cells what a sweep meets is the sum of the residuals that lie behind it.
    share_of_tolerance *= 0.1;
    report.sweeps +=
        sweeps_of_iteration * BiCgStab<Value>(mesh, matrix, diagonal, blocks).solve(b, x, share_of_tolerance * tolerance * reference, most);
    if (positive)
      for (std::size_t c = 0; c < x.size(); ++c)
        if (!is_positive(x[c])) x[c] = swept[c];
    since_look = 0;
    max_sweeps = std::max(max_sweeps, report.sweeps + 2);  // a sweep tests what came out
  }
  exchange(mesh, x);
  return report;
}

template SweepReport solve_rows(const Mesh&, const CellMatrix&, std::span<const double>, std::span<const double>, std::vector<double>&,
                                double, int, bool, std::span<const CoupledRow>);
template SweepReport solve_rows(const Mesh&, const CellMatrix&, std::span<const Vec3>, std::span<const Vec3>, std::vector<Vec3>&, double,
                                int, bool, std::span<const CoupledRow>);

}  // namespace snag
