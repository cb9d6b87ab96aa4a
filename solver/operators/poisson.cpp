// Each rank fills the rows of its own cells in the matrix of the preconditioner.
// Iterations are measured per decade of the residual, so that solves with different tolerances can be compared.
#include "solver/operators/poisson.hpp"

#include <petscpc.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "solver/operators/cell_matrix.hpp"
#include "solver/operators/v_cycle.hpp"

namespace snag {

namespace {

constexpr double rebuild_ratio = 1.8;  // of iterations a decade: a set-up costs as much as some twenty iterations
constexpr double few_iterations = 3;   // by which short solves differ anyway
constexpr int max_iterations = 500;
constexpr double round_off = 1e-15;  // of the first residual: the recursion goes on below it, the residual of x does not

// Measured on tetrahedra: the hierarchy with which conjugate gradients are three to five times faster than with BoomerAMG's defaults.
const char* const boomeramg_options =
    "-snag_hierarchy_pc_type hypre -snag_hierarchy_pc_hypre_type boomeramg -snag_hierarchy_pc_hypre_boomeramg_coarsen_type HMIS "
    "-snag_hierarchy_pc_hypre_boomeramg_interp_type ext+i -snag_hierarchy_pc_hypre_boomeramg_P_max 4 "
    "-snag_hierarchy_pc_hypre_boomeramg_strong_threshold 0.25 -snag_hierarchy_pc_hypre_boomeramg_agg_nl 1";
const char* const gamg_options =
    "-snag_pressure_pc_type gamg -snag_pressure_pc_gamg_threshold 0.02 -snag_pressure_pc_gamg_aggressive_coarsening 2";

}  // namespace

/// z = M^-1 r.
class Poisson::Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Finds z for r [n_cells] of this mean and rms value over all ranks; returns sums over this rank: of z, and of r z. Collective.
  virtual std::array<double, 2> apply(std::span<const double> r, double mean, double rms) = 0;
  /// Goes along the direction and turns it: x += alpha p, then p = z - mean + beta p; one loop, because p is read only once so. Local.
  virtual void go_and_turn(double alpha, double mean, double beta, std::span<double> x, std::span<double> p) const = 0;
};

class Poisson::OwnCycle final : public Preconditioner {
 public:
  OwnCycle(Mat matrix, PC hierarchy, bool singular) : cycle_(matrix, hierarchy, singular) {}
  std::array<double, 2> apply(std::span<const double> r, double mean, double rms) override {
    rms_ = rms;
    return cycle_.apply(r, mean, rms);
  }
  void go_and_turn(double alpha, double mean, double beta, std::span<double> x, std::span<double> p) const override {
    const std::span<const float> z = cycle_.solution();
    for (std::size_t c = 0; c < z.size(); ++c) x[c] += alpha * p[c], p[c] = rms_ * z[c] - mean + beta * p[c];
  }

 private:
  VCycle cycle_;
  double rms_ = 1;
};

class Poisson::Gamg final : public Preconditioner {
 public:
  Gamg(MPI_Comm comm, Mat matrix) {
    check_petsc(PCCreate(comm, &cycle_), "PCCreate");
    check_petsc(PCSetOptionsPrefix(cycle_, "snag_pressure_"), "PCSetOptionsPrefix");
    check_petsc(PCSetFromOptions(cycle_), "PCSetFromOptions");
    check_petsc(PCSetOperators(cycle_, matrix, matrix), "PCSetOperators");
    check_petsc(PCSetUp(cycle_), "PCSetUp");
    check_petsc(MatCreateVecs(matrix, &z_, &r_), "MatCreateVecs");
  }
  Gamg(const Gamg&) = delete;
  Gamg& operator=(const Gamg&) = delete;
  ~Gamg() override {
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (!finalized) PCDestroy(&cycle_), VecDestroy(&r_), VecDestroy(&z_);
  }
  std::array<double, 2> apply(std::span<const double> r, double, double) override {
    check_petsc(VecPlaceArray(r_, r.data()), "VecPlaceArray");
    const auto error = PCApply(cycle_, r_, z_);
    check_petsc(VecResetArray(r_), "VecResetArray");
    check_petsc(error, "PCApply");
    std::array<double, 2> sums{};
    read([&](const double* z) {
      for (std::size_t c = 0; c < r.size(); ++c) sums[0] += z[c], sums[1] += r[c] * z[c];
    });
    return sums;
  }
  void go_and_turn(double alpha, double mean, double beta, std::span<double> x, std::span<double> p) const override {
    PetscInt n = 0;
    check_petsc(VecGetLocalSize(z_, &n), "VecGetLocalSize");
    read([&](const double* z) {
      for (PetscInt c = 0; c < n; ++c) x[c] += alpha * p[c], p[c] = z[c] - mean + beta * p[c];
    });
  }

 private:
  template <class Act>
  void read(const Act& act) const {
    const PetscScalar* z = nullptr;
    check_petsc(VecGetArrayRead(z_, &z), "VecGetArrayRead");
    act(z);
    check_petsc(VecRestoreArrayRead(z_, &z), "VecRestoreArrayRead");
  }
  PC cycle_ = nullptr;
  Vec r_ = nullptr, z_ = nullptr;
};

namespace {

/// Global numbers of the cells of this rank and of its ghosts, in the order of ranks and cells.
std::vector<PetscInt> global_numbers(const Mesh& mesh) {
  std::int64_t first = 0, n_cells = mesh.n_cells;
  MPI_Exscan(&n_cells, &first, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
  if (rank_of(mesh.comm) == 0) first = 0;
  std::vector<std::int64_t> number(mesh.n_all_cells());
  for (int c = 0; c < mesh.n_cells; ++c) number[c] = first + c;
  mesh.halo.exchange(std::span(number));
  return {number.begin(), number.end()};
}

/// Symmetric, and with the constants as null space if `singular`.
void declare(Mat matrix, MPI_Comm comm, bool singular) {
  check_petsc(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  if (!singular) return;
  MatNullSpace constants = nullptr;
  check_petsc(MatNullSpaceCreate(comm, PETSC_TRUE, 0, nullptr, &constants), "MatNullSpaceCreate");
  check_petsc(MatSetNullSpace(matrix, constants), "MatSetNullSpace");
  check_petsc(MatNullSpaceDestroy(&constants), "MatNullSpaceDestroy");
}

/// The matrix of these coefficients, for the preconditioner; the caller destroys it. Row by row: the sorting of coordinate lists took a
/// twentieth of a pump's step.
Mat assembled(const Mesh& mesh, std::span<const double> coefficient, bool singular) {
  const PetscInt n = mesh.n_cells;
  CellMatrix rows(mesh);
  std::vector<double> diagonal(mesh.n_all_cells());
  for (int f = 0; f < mesh.n_interior; ++f) {
    const double k = coefficient[f];
    rows.value[rows.place_of_owner[f]] = rows.value[rows.place_of_neighbour[f]] = -k;
    diagonal[mesh.owner[f]] += k, diagonal[mesh.neighbour[f]] += k;
  }
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) diagonal[mesh.owner[f]] += coefficient[f];

  const auto number = global_numbers(mesh);
  std::vector<PetscInt> column(rows.column.size()), n_own(n, 1), n_other(n, 0);
  for (PetscInt c = 0; c < n; ++c) {
    for (int e = rows.row_start[c]; e < rows.row_start[c + 1]; ++e) {
      column[e] = number[rows.column[e]];
      ++(rows.column[e] < n ? n_own : n_other)[c];
    }
  }
  Mat matrix = nullptr;
  check_petsc(MatCreate(mesh.comm, &matrix), "MatCreate");
  check_petsc(MatSetSizes(matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE), "MatSetSizes");
  check_petsc(MatSetType(matrix, MATAIJ), "MatSetType");
  check_petsc(MatXAIJSetPreallocation(matrix, 1, n_own.data(), n_other.data(), nullptr, nullptr), "MatXAIJSetPreallocation");
  for (PetscInt c = 0; c < n; ++c) {
    const int begin = rows.row_start[c];
    // Added: two cells may meet in several facets.
    check_petsc(MatSetValues(matrix, 1, &number[c], rows.row_start[c + 1] - begin, &column[begin], &rows.value[begin], ADD_VALUES),
                "MatSetValues");
    check_petsc(MatSetValue(matrix, number[c], number[c], diagonal[c], ADD_VALUES), "MatSetValue");
  }
  check_petsc(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check_petsc(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  declare(matrix, mesh.comm, singular);
  return matrix;
}

}  // namespace

Poisson::Poisson(const Mesh& mesh, Multigrid multigrid, bool singular, const Arrays& arrays)
    : mesh_(mesh), multigrid_(multigrid), singular_(singular), residual_(arrays.residual), p_(arrays.direction), Ap_(arrays.product) {
  check_petsc(PetscOptionsInsertString(nullptr, multigrid == Multigrid::gamg ? gamg_options : boomeramg_options),
              "PetscOptionsInsertString");
}

Poisson::~Poisson() = default;

/// A x into Ap_, of x [n_all_cells] whose ghosts are up to date; returns the part of this rank in x.A x.
double Poisson::apply(std::span<const double> x) {
  std::fill(Ap_.begin(), Ap_.end(), 0.0);
  const int n = mesh_.n_cells, n_pairs = mesh_.n_interior / 2;
  const auto add_face = [&](int f) {  // twice its part of the product: a face between ranks belongs to both in halves
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const double change = x[P] - x[N], flux = coefficient_[f] * change;
    Ap_[P] += flux;
    Ap_[N] -= flux;
    return ((P < n) + (N < n)) * (flux * change);
  };
  double even = 0, odd = 0;  // two sums: one would wait for itself at each face
  for (int pair = 0; pair < n_pairs; ++pair) even += add_face(2 * pair), odd += add_face(2 * pair + 1);
  if (mesh_.n_interior > 2 * n_pairs) even += add_face(2 * n_pairs);
  double product = 0.5 * (even + odd);
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
    const int P = mesh_.owner[f];
    Ap_[P] += coefficient_[f] * x[P];
    product += coefficient_[f] * x[P] * x[P];
  }
  return product;
}

void Poisson::set_up_preconditioner() {
  preconditioner_.reset();
  Mat matrix = assembled(mesh_, coefficient_, singular_);
  if (multigrid_ == Multigrid::boomeramg) {
    PC hierarchy = nullptr;
    check_petsc(PCCreate(mesh_.comm, &hierarchy), "PCCreate");
    check_petsc(PCSetOptionsPrefix(hierarchy, "snag_hierarchy_"), "PCSetOptionsPrefix");
    check_petsc(PCSetFromOptions(hierarchy), "PCSetFromOptions");
    check_petsc(PCSetOperators(hierarchy, matrix, matrix), "PCSetOperators");
    check_petsc(PCSetUp(hierarchy), "PCSetUp");
    preconditioner_ = std::make_unique<OwnCycle>(matrix, hierarchy, singular_);
    check_petsc(PCDestroy(&hierarchy), "PCDestroy");
  } else {
    preconditioner_ = std::make_unique<Gamg>(mesh_.comm, matrix);
  }
  check_petsc(MatDestroy(&matrix), "MatDestroy");
  return_free_memory();  // several times what the cycle keeps
}

void Poisson::restore(double fresh_cost, bool rebuild_due) {
  set_up_preconditioner();
  fresh_cost_ = fresh_cost, rebuild_ = rebuild_due;
}

/// Of the owned cells, in several sums: one would wait for itself at each cell.
double Poisson::local_sum(std::span<const double> x) const {
  double total = 0;
  const double* const value = x.data();
#pragma omp simd reduction(+ : total)
  for (int c = 0; c < mesh_.n_cells; ++c) total += value[c];
  return total;
}

/// Shifts x by the constant that makes the sum of all residuals zero; the residual follows. A common level of x is felt by the few fixed
/// faces only: its residual is small however wrong it is.
void Poisson::fix_level(std::span<double> x) {
  std::array<double, 2> sums{local_sum(residual_)};
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) sums[1] += coefficient_[f];
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  const double shift = sums[0] / sums[1];
  for (double& value : x) value += shift;
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) residual_[mesh_.owner[f]] -= coefficient_[f] * shift;
}

void Poisson::remove_mean(std::span<double> x) const {
  const double mean = sum(mesh_.comm, local_sum(x)) / static_cast<double>(mesh_.n_cells_global);
  for (double& value : x) value -= mean;
}

/// r -= alpha A p; returns the parts of this rank in the sums of r and of r^2.
std::array<double, 2> Poisson::shorten_residual(double alpha) {
  double total = 0, squares = 0;
  double* const r = residual_.data();
  const double* const Ap = Ap_.data();
#pragma omp simd reduction(+ : total, squares)
  for (int c = 0; c < mesh_.n_cells; ++c) {
    r[c] -= alpha * Ap[c];
    total += r[c], squares += r[c] * r[c];
  }
  return {total, squares};
}

/// Conjugate gradients from the given x; returns what stopped them early, null if nothing did: x then lacks the last step. Ghosts of x are
/// up to date in front and behind.
const char* Poisson::iterate(std::span<const double> b, std::vector<double>& x, double target, PoissonReport& report) {
  const auto n = static_cast<double>(mesh_.n_cells_global);
  const std::span<const double> owned{residual_.data(), static_cast<std::size_t>(mesh_.n_cells)};
  if (std::all_of(x.begin(), x.end(), [](double value) { return value == 0; }))
    std::fill(Ap_.begin(), Ap_.end(), 0.0);
  else
    apply(x);
  for (int c = 0; c < mesh_.n_cells; ++c) residual_[c] = b[c] - Ap_[c];
  if (!singular_) fix_level(x);
  std::array<double, 2> of_residual = shorten_residual(0);  // sums of r and of r^2
  std::fill(p_.begin(), p_.end(), 0.0);
  double rho = 0, alpha = 0;
  for (int iteration = 0;; ++iteration) {
    MPI_Allreduce(MPI_IN_PLACE, of_residual.data(), 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    // Without a fixed face no x reaches the mean of b; round-off leaves one.
    const double beyond_reach = singular_ ? of_residual[0] * of_residual[0] / n : 0;
    report.final = std::sqrt(std::max(of_residual[1] - beyond_reach, 0.0));  // a NaN stays one
    if (report.iterations == 0) report.initial = report.final;
    if (!std::isfinite(report.final)) return "the residual is not a number";
    if (iteration == 0) target = std::max(target, round_off * report.final);
    if (report.final <= target) break;
    if (iteration == max_iterations) return "too slow";

    auto of_answer = preconditioner_->apply(owned, of_residual[0] / n, report.final / std::sqrt(n));  // sums of z and of r z
    MPI_Allreduce(MPI_IN_PLACE, of_answer.data(), 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    if (!(of_answer[1] > 0)) return "the preconditioner is not positive";
    preconditioner_->go_and_turn(alpha, singular_ ? of_answer[0] / n : 0, iteration > 0 ? of_answer[1] / rho : 0, x, p_);
    rho = of_answer[1];

    mesh_.halo.exchange(p_);
    double curvature = apply(p_);  // p.A p
    MPI_Allreduce(MPI_IN_PLACE, &curvature, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    if (!(curvature > 0)) return "the matrix is not positive";
    alpha = rho / curvature;
    of_residual = shorten_residual(alpha);
    ++report.iterations;
  }
  for (int c = 0; c < mesh_.n_cells; ++c) x[c] += alpha * p_[c];
  if (singular_)
    remove_mean(x);
  else if (rho > 0)
    fix_level(x);
  mesh_.halo.exchange(x);
  return nullptr;
}

PoissonReport Poisson::solve(std::span<const double> b, std::vector<double>& x, double target) {
  PoissonReport report{.rebuilt = rebuild_};
  if (rebuild_) set_up_preconditioner();
  mesh_.halo.exchange(x);
  const char* stopped = iterate(b, x, target, report);
  if (stopped && !rebuild_) {  // that of another matrix may be indefinite for this one
    report.rebuilt = rebuild_ = true;
    set_up_preconditioner();
    mesh_.halo.exchange(x);
    stopped = iterate(b, x, target, report);
  }
  if (stopped)
    throw Error(ExitCode::diverged, "pressure equation: conjugate gradients stopped after " + std::to_string(report.iterations) +
                                        " iterations (" + stopped + ", residual " + number_text(report.final) + ", wanted " +
                                        number_text(target) + "); check the mesh (snag mesh --info), or take smaller steps");
  const double decades = report.final > 0 && report.initial > report.final ? std::log10(report.initial / report.final) : 0;
  if (decades > 0.5) {
    const double cost = report.iterations / decades;
    if (rebuild_) fresh_cost_ = cost;
    rebuild_ = !rebuild_ && report.iterations > rebuild_ratio * fresh_cost_ * decades + few_iterations;
  } else if (rebuild_ && report.iterations > 0) {
    rebuild_ = false;
  }
  return report;
}

}  // namespace snag
