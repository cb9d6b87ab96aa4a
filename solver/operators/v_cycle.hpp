#pragma once
// One V-cycle of algebraic multigrid from zero, z = M^-1 r, on a hierarchy that another program has set up. On each level, in single
// precision:
//
//   (D + L) x = b                       forward Gauss-Seidel on the rows of the rank, b = r on the finest level
//   r = b - A x = -(U + G) x            G: columns of other ranks; (D + L) x = b holds already
//   b_coarse = P^T r,   x += P x_coarse
//   (D + U) x' = b - (L + G) x          backward
//
// In front r is divided by its rms value, and z multiplied by it, for the range of single precision; where the constants are the null space
// of A the mean of r is taken off, which the cycle would answer with its round-off, of either sign.
//
// M is symmetric and positive where A is, as conjugate gradients want: the backward sweep is the transpose of the forward one. The coarsest
// level is solved by the inverse of its matrix without the null space where it is small, else by a sweep forward and one backward. Against
// a cycle of hypre's own, which runs through each matrix three times in double precision, it runs twice in single precision.
#include <petscpc.h>

#include <span>
#include <vector>

#include "parallel/halo.hpp"

namespace snag {

class VCycle {
 public:
  /// Takes the interpolations and coarse operators of `hierarchy`, which is set up for `finest` and cannot be applied afterwards.
  /// `singular`: the constants are the null space. Collective.
  VCycle(Mat finest, PC hierarchy, bool singular);
  /// z = M^-1 r, both [rows of this rank]. Collective.
  void apply(const double* r, double* z);
  int n_levels() const { return static_cast<int>(levels_.size()); }

 private:
  using Value = float;
  struct Rows {  // compressed; columns are owned entries of a vector, then its ghosts
    std::vector<int> start, column;
    std::vector<Value> value;
  };
  struct Level {
    int n = 0;                               // rows of this rank
    std::vector<int> upper;                  // [n] where in a row the columns behind the diagonal begin
    Rows matrix, restriction, prolongation;  // without the diagonal; from this level to the next coarser one; from that to this
    std::vector<Value> inverse_diagonal;     // [n]
    Halo halo;
    std::vector<Value> b, x, residual;  // [n and ghosts]
  };
  struct GlobalRows;
  class Numbering;
  static void fill_matrix(Level& level, const Numbering& numbers, const GlobalRows& from);
  void invert_coarsest(const GlobalRows& from);
  void descend(std::size_t level);
  void solve_coarsest();
  static void sweep_forward(Level& level);
  static void sweep_backward(Level& level);

  MPI_Comm comm_;
  bool singular_;
  double n_rows_;                         // of all ranks
  std::vector<Level> levels_;             // the finest first
  std::vector<double> coarsest_inverse_;  // [rows of this rank][all rows], empty where sweeps take its place
  std::vector<int> coarsest_count_, coarsest_start_;
};

}  // namespace snag
