#pragma once
// Symmetric positive (semi-)definite equation on the cells, conjugate gradients with a multigrid preconditioner that is kept while it is
// good:
//
//   sum_f k_f (x_P - x_N) + sum_b k_b x_P = b_P
//
//   p = M^-1 r + beta p,   x += alpha p,   r -= alpha A p
//   alpha = r.M^-1 r / p.A p,   beta = r.M^-1 r / that of the iteration before
//
// The operator is applied face by face, so that it follows a turning mesh at no cost; a matrix is assembled for the set-up of the
// preconditioner only, which is repeated when iterations grow beyond 1.8 times those of a fresh one.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct PoissonReport {
  double initial = 0, final = 0;  // norms of the residual
  int iterations = 0;
  bool rebuilt = false;  // the preconditioner was set up in this solve
};

/// Preconditioner: Snag's cycle on the hierarchy of hypre's BoomerAMG, or GAMG of PETSc.
enum class Multigrid { boomeramg, gamg };

class Poisson {
 public:
  /// Arrays to work in while solving, [n_all_cells].
  struct Arrays {
    std::span<double> residual, direction, product;
  };
  /// `singular`: no boundary value is fixed; x is then taken with zero mean. Collective.
  Poisson(const Mesh& mesh, Multigrid multigrid, bool singular, const Arrays& arrays);
  ~Poisson();

  /// Coefficients k of all faces (boundary faces: 0 where nothing is fixed), [n_faces]; they stay with the caller until others are given.
  /// Local.
  void set_coefficients(std::span<const double> k) { coefficient_ = k; }
  /// Solve until the residual norm is below `target`, from x [n_all_cells] as first guess; ghosts filled. Throws Error(diverged).
  /// Collective.
  PoissonReport solve(std::span<const double> b, std::vector<double>& x, double target);

  /// True if the next solve sets the preconditioner up from the coefficients as they stand then.
  bool rebuild_is_due() const { return rebuild_; }
  double fresh_cost() const { return fresh_cost_; }
  /// Set the preconditioner up from the present mesh and coefficients, as it was when `fresh_cost` was measured (a resume). Collective.
  void restore(double fresh_cost, bool rebuild_due);

 private:
  class Preconditioner;
  class OwnCycle;
  class Gamg;
  double apply(std::span<const double> x);
  std::array<double, 2> shorten_residual(double alpha);
  void set_up_preconditioner();
  const char* iterate(std::span<const double> b, std::vector<double>& x, double target, PoissonReport& report);
  double local_sum(std::span<const double> x) const;
  void fix_level(std::span<double> x);
  void remove_mean(std::span<double> x) const;
  const Mesh& mesh_;
  Multigrid multigrid_;
  bool singular_;
  std::span<const double> coefficient_;  // [n_faces]
  std::span<double> residual_, p_, Ap_;
  std::unique_ptr<Preconditioner> preconditioner_;
  bool rebuild_ = true;
  double fresh_cost_ = 0;  // iterations a decade after a set-up
};

}  // namespace snag
