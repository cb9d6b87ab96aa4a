#pragma once
// One V-cycle of algebraic multigrid from zero, z = M^-1 r, on a hierarchy that another program has set up. On each level, in single
// precision:
//
//   (D + L) x = b                       forward Gauss-Seidel on the rows of the rank, b = r on the finest level
//   r = b - A x = - (U + G) x           G: columns of other ranks
//   b_coarse = P^T r,   x += P x_coarse
//   (D + U) x' = b - (L + G) x          backward
//
// The forward sweep and its residual are one pass over the matrix: row i, once x_i is known, adds - a_ij x_i to the residual of each j.
// What row j has got before its turn is - L x, which it needs for x_j; what it gets afterwards is - U x.
//
// In front r is divided by its rms value, and z multiplied by it, for the range of single precision; where the constants are the null space
// of A the mean of r is taken off, which the cycle would answer with its round-off, of either sign.
//
// M is symmetric and positive where A is, as conjugate gradients want: the backward sweep is the transpose of the forward one. The first
// level that is small is the coarsest: it is solved by the inverse of its matrix without the null space. Without a small one the coarsest
// has a sweep forward and one backward.
//
// Rows are padded with zeros to a multiple of a few entries: the length of a row is then nearly always the same, four on tetrahedra. Loops
// over the entries below the diagonal alone, whose number is as good as random, read half as much and take longer, because the processor
// guesses nearly each end of them wrongly. Rows of restriction and prolongation differ in length: they are sorted by it.
#include <petscpc.h>

#include <array>
#include <span>
#include <vector>

#include "parallel/halo.hpp"

namespace snag {

class VCycle {
 public:
  /// Takes the interpolations and coarse operators of `hierarchy`, which is set up for `finest` and cannot be applied afterwards.
  /// `singular`: the constants are the null space. Collective.
  VCycle(Mat finest, PC hierarchy, bool singular);
  /// Solves for r [rows of this rank] with its mean (read where the constants are the null space) and its rms value over all ranks, above
  /// 0: z_i = rms solution()[i]. Returns the sums over this rank of z, and of r z (r in single precision). Collective.
  std::array<double, 2> apply(std::span<const double> r, double mean, double rms);
  std::span<const float> solution() const { return {levels_.front().x.data(), static_cast<std::size_t>(levels_.front().n)}; }
  int n_levels() const { return static_cast<int>(levels_.size()); }

 private:
  using Value = float;
  struct GlobalRows;
  class Numbering;
  template <int block>
  struct Rows {  // compressed, each a multiple of `block` long; columns are owned entries of a vector, then its ghosts
    std::vector<int> start{0}, column;
    std::vector<Value> value;
    void add(int c, double v) { column.push_back(c), value.push_back(static_cast<Value>(v)); }
    void end_row();
    void fit() { start.shrink_to_fit(), column.shrink_to_fit(), value.shrink_to_fit(); }
    [[gnu::always_inline]] Value product(int i, const Value* x) const {
      Value sum = 0;
      const int end = start[i + 1];
      for (int e = start[i]; e < end; e += block) {
        Value part[block];
        for (int k = 0; k < block; ++k) part[k] = value[e + k] * x[column[e + k]];
        for (int half = block / 2; half > 0; half /= 2)
          for (int k = 0; k < half; ++k) part[k] += part[k + half];
        sum += part[0];
      }
      return sum;
    }
  };
  /// Rows of a product with a vector of another level, sorted by length, each padded to a multiple of `block`; n rows of one length follow
  /// each other without a jump that the processor could not foresee.
  template <int block>
  class SortedRows {
   public:
    /// Columns by `place`, of their global number.
    void fill(const GlobalRows& from, const Numbering& place);
    /// act(i, sum_j a_ij x_j) for all rows i.
    template <class Act>
    void multiply(const Value* x, const Act& act) const;

   private:
    struct Run {
      int length = 0, n_rows = 0;
    };
    std::vector<Run> run_;
    std::vector<int> row_, column_;
    std::vector<Value> value_;
  };
  struct GhostEntry {
    int row, column;
    Value value;
  };
  struct Level {
    int n = 0;                             // rows of this rank
    Rows<4> matrix;                        // without the diagonal
    std::vector<GhostEntry> ghost_matrix;  // of it those of other ranks' columns once more
    SortedRows<4> restriction;             // from this level to the next coarser one
    SortedRows<1> prolongation;            // from that to this
    std::vector<Value> over_diagonal;      // [n] 1/D, 0 where D is not positive
    Halo halo;
    std::vector<Value> b, x, residual;  // [n], and ghosts of x and residual
  };
  struct Sums {
    double x = 0, b_x = 0;
  };
  void add_level(const GlobalRows& matrix, const GlobalRows* restriction, const GlobalRows* prolongation_of_last);
  static void fill_matrix(Level& level, const Numbering& numbers, const GlobalRows& from);
  void invert_coarsest(const GlobalRows& from);
  Sums descend(std::size_t level);
  Sums solve_coarsest();
  static void sweep_forward(Level& level);
  static void complete_residual(Level& level);
  static Sums sweep_backward(Level& level);
  static Sums sums_of(const Level& level);

  MPI_Comm comm_;
  bool singular_;
  std::vector<Level> levels_;             // the finest first
  std::vector<double> coarsest_inverse_;  // [rows of this rank][all rows], empty where sweeps take its place
  std::vector<int> coarsest_count_, coarsest_start_;
};

}  // namespace snag
