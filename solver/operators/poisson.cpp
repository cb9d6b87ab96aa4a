// Each rank fills the rows of its own cells in the matrix of the preconditioner.
// Iterations are measured per decade of the residual, so that solves with different tolerances can be compared.
#include "solver/operators/poisson.hpp"

#include <petscksp.h>

#include <array>
#include <cmath>

#include "base/error.hpp"
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

// Measured on tetrahedra: the hierarchy with which conjugate gradients are three to five times faster than with BoomerAMG's defaults.
const char* const boomeramg_options =
    "-snag_hierarchy_pc_type hypre -snag_hierarchy_pc_hypre_type boomeramg -snag_hierarchy_pc_hypre_boomeramg_coarsen_type HMIS "
    "-snag_hierarchy_pc_hypre_boomeramg_interp_type ext+i -snag_hierarchy_pc_hypre_boomeramg_P_max 4 "
    "-snag_hierarchy_pc_hypre_boomeramg_strong_threshold 0.25 -snag_hierarchy_pc_hypre_boomeramg_agg_nl 1";
const char* const gamg_options =
    "-snag_pressure_pc_type gamg -snag_pressure_pc_gamg_threshold 0.02 -snag_pressure_pc_gamg_aggressive_coarsening 2";

}  // namespace

struct Poisson::Petsc {
  Mat matrix = nullptr, preconditioner = nullptr;  // applied face by face; assembled
  Vec b = nullptr, x = nullptr;
  KSP solver = nullptr;
  std::unique_ptr<VCycle> cycle;
  Petsc() = default;
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;
  ~Petsc() {
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (finalized) return;
    KSPDestroy(&solver), VecDestroy(&x), VecDestroy(&b), MatDestroy(&preconditioner), MatDestroy(&matrix);
  }

  static PetscErrorCode precondition(PC pc, Vec r, Vec z) {
    void* self = nullptr;
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    PetscCall(PCShellGetContext(pc, &self));
    PetscCall(VecGetArrayRead(r, &from));
    PetscCall(VecGetArrayWrite(z, &to));
    static_cast<Petsc*>(self)->cycle->apply(from, to);
    PetscCall(VecRestoreArrayWrite(z, &to));
    PetscCall(VecRestoreArrayRead(r, &from));
    return 0;
  }
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

}  // namespace

Poisson::Poisson(const Mesh& mesh, Multigrid multigrid, bool singular)
    : mesh_(mesh),
      multigrid_(multigrid),
      singular_(singular),
      coefficient_(mesh.n_faces),
      x_all_(mesh.n_all_cells()),
      y_all_(mesh.n_all_cells()),
      petsc_(std::make_unique<Petsc>()) {
  Petsc& p = *petsc_;
  const PetscInt n = mesh.n_cells;
  check_petsc(MatCreateShell(mesh.comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, this, &p.matrix), "MatCreateShell");
  const auto multiply = [](Mat matrix, Vec x, Vec y) -> PetscErrorCode {
    void* self = nullptr;
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    PetscCall(MatShellGetContext(matrix, &self));
    PetscCall(VecGetArrayRead(x, &from));
    PetscCall(VecGetArrayWrite(y, &to));
    static_cast<Poisson*>(self)->apply(from, to);
    PetscCall(VecRestoreArrayWrite(y, &to));
    PetscCall(VecRestoreArrayRead(x, &from));
    return 0;
  };
  check_petsc(MatShellSetOperation(p.matrix, MATOP_MULT, reinterpret_cast<void (*)()>(+multiply)), "MatShellSetOperation");
  declare(p.matrix, mesh.comm, singular);
  check_petsc(VecCreateMPIWithArray(mesh.comm, 1, n, PETSC_DETERMINE, nullptr, &p.b), "VecCreateMPIWithArray");
  check_petsc(VecCreateMPIWithArray(mesh.comm, 1, n, PETSC_DETERMINE, nullptr, &p.x), "VecCreateMPIWithArray");
  check_petsc(PetscOptionsInsertString(nullptr, multigrid == Multigrid::gamg ? gamg_options : boomeramg_options),
              "PetscOptionsInsertString");
  check_petsc(KSPCreate(mesh.comm, &p.solver), "KSPCreate");
  check_petsc(KSPSetOptionsPrefix(p.solver, "snag_pressure_"), "KSPSetOptionsPrefix");
  check_petsc(KSPSetType(p.solver, KSPCG), "KSPSetType");
  check_petsc(KSPSetNormType(p.solver, KSP_NORM_UNPRECONDITIONED), "KSPSetNormType");
  check_petsc(KSPSetInitialGuessNonzero(p.solver, PETSC_TRUE), "KSPSetInitialGuessNonzero");
  check_petsc(KSPSetResidualHistory(p.solver, nullptr, max_iterations + 1, PETSC_TRUE), "KSPSetResidualHistory");
  if (multigrid == Multigrid::boomeramg) {
    PC cycle = nullptr;
    check_petsc(KSPGetPC(p.solver, &cycle), "KSPGetPC");
    check_petsc(PCSetType(cycle, PCSHELL), "PCSetType");
    check_petsc(PCShellSetContext(cycle, &p), "PCShellSetContext");
    check_petsc(PCShellSetApply(cycle, &Petsc::precondition), "PCShellSetApply");
  }
  check_petsc(KSPSetFromOptions(p.solver), "KSPSetFromOptions");
}

Poisson::~Poisson() = default;

void Poisson::set_coefficients(std::span<const double> k) { coefficient_.assign(k.begin(), k.end()); }

void Poisson::apply(const double* x, double* y) {
  std::copy(x, x + mesh_.n_cells, x_all_.begin());
  mesh_.halo.exchange(x_all_);
  std::fill(y_all_.begin(), y_all_.end(), 0.0);
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const double flux = coefficient_[f] * (x_all_[P] - x_all_[N]);
    y_all_[P] += flux;
    y_all_[N] -= flux;
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) y_all_[mesh_.owner[f]] += coefficient_[f] * x_all_[mesh_.owner[f]];
  std::copy(y_all_.begin(), y_all_.begin() + mesh_.n_cells, y);
}

/// A new matrix each time: its pattern follows the facets. Row by row: the sorting of coordinate lists took a twentieth of a pump's step.
void Poisson::set_up_preconditioner() {
  Petsc& p = *petsc_;
  const PetscInt n = mesh_.n_cells;
  const auto& k = coefficient_;
  CellMatrix rows(mesh_);
  std::vector<double> diagonal(mesh_.n_all_cells());
  for (int f = 0; f < mesh_.n_interior; ++f) {
    rows.value[rows.place_of_owner[f]] = rows.value[rows.place_of_neighbour[f]] = -k[f];
    diagonal[mesh_.owner[f]] += k[f], diagonal[mesh_.neighbour[f]] += k[f];
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) diagonal[mesh_.owner[f]] += k[f];

  const auto number = global_numbers(mesh_);
  std::vector<PetscInt> column(rows.column.size()), n_own(n, 1), n_other(n, 0);
  for (PetscInt c = 0; c < n; ++c) {
    for (int e = rows.row_start[c]; e < rows.row_start[c + 1]; ++e) {
      column[e] = number[rows.column[e]];
      ++(rows.column[e] < n ? n_own : n_other)[c];
    }
  }
  check_petsc(MatDestroy(&p.preconditioner), "MatDestroy");
  check_petsc(MatCreate(mesh_.comm, &p.preconditioner), "MatCreate");
  check_petsc(MatSetSizes(p.preconditioner, n, n, PETSC_DETERMINE, PETSC_DETERMINE), "MatSetSizes");
  check_petsc(MatSetType(p.preconditioner, MATAIJ), "MatSetType");
  check_petsc(MatXAIJSetPreallocation(p.preconditioner, 1, n_own.data(), n_other.data(), nullptr, nullptr), "MatXAIJSetPreallocation");
  for (PetscInt c = 0; c < n; ++c) {
    const int begin = rows.row_start[c];
    // Added: two cells may meet in several facets.
    check_petsc(
        MatSetValues(p.preconditioner, 1, &number[c], rows.row_start[c + 1] - begin, &column[begin], &rows.value[begin], ADD_VALUES),
        "MatSetValues");
    check_petsc(MatSetValue(p.preconditioner, number[c], number[c], diagonal[c], ADD_VALUES), "MatSetValue");
  }
  check_petsc(MatAssemblyBegin(p.preconditioner, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check_petsc(MatAssemblyEnd(p.preconditioner, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  declare(p.preconditioner, mesh_.comm, singular_);
  if (multigrid_ == Multigrid::boomeramg) {
    PC hierarchy = nullptr;
    check_petsc(PCCreate(mesh_.comm, &hierarchy), "PCCreate");
    check_petsc(PCSetOptionsPrefix(hierarchy, "snag_hierarchy_"), "PCSetOptionsPrefix");
    check_petsc(PCSetFromOptions(hierarchy), "PCSetFromOptions");
    check_petsc(PCSetOperators(hierarchy, p.preconditioner, p.preconditioner), "PCSetOperators");
    check_petsc(PCSetUp(hierarchy), "PCSetUp");
    p.cycle = std::make_unique<VCycle>(p.preconditioner, hierarchy, singular_);
    check_petsc(PCDestroy(&hierarchy), "PCDestroy");
  }
  check_petsc(KSPSetReusePreconditioner(p.solver, PETSC_FALSE), "KSPSetReusePreconditioner");
  check_petsc(KSPSetOperators(p.solver, p.matrix, p.preconditioner), "KSPSetOperators");
  check_petsc(KSPSetUp(p.solver), "KSPSetUp");
  check_petsc(KSPSetReusePreconditioner(p.solver, PETSC_TRUE), "KSPSetReusePreconditioner");
}

void Poisson::restore(double fresh_cost, bool rebuild_due) {
  set_up_preconditioner();
  fresh_cost_ = fresh_cost, rebuild_ = rebuild_due;
}

/// Shifts x by the constant that makes the sum of all residuals zero. A common level of x is felt by the few fixed faces only: its residual
/// is small however wrong it is.
void Poisson::fix_level(std::span<const double> b, std::span<double> x) const {
  std::array<double, 2> local{0, 0};
  for (int c = 0; c < mesh_.n_cells; ++c) local[0] += b[c];
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
    local[0] -= coefficient_[f] * x[mesh_.owner[f]];
    local[1] += coefficient_[f];
  }
  std::array<double, 2> all{};
  MPI_Allreduce(local.data(), all.data(), 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  const double shift = all[0] / all[1];
  for (double& value : x) value += shift;
}

void Poisson::remove_mean(std::span<double> x) const {
  double local = 0;
  for (const double value : x) local += value;
  const double mean = sum(mesh_.comm, local) / static_cast<double>(mesh_.n_cells_global);
  for (double& value : x) value -= mean;
}

/// Conjugate gradients from the given x; returns PETSc's word for what stopped them early, null if nothing did.
const char* Poisson::iterate(std::span<const double> b, std::span<double> x, double target, PoissonReport& report) {
  Petsc& p = *petsc_;
  // An absolute target; the relative one is out of reach. The divergence test is left to the number of iterations.
  check_petsc(KSPSetTolerances(p.solver, 1e-50, target, 1e30, max_iterations), "KSPSetTolerances");
  if (!singular_) fix_level(b, x);
  check_petsc(VecPlaceArray(p.b, b.data()), "VecPlaceArray");
  check_petsc(VecPlaceArray(p.x, x.data()), "VecPlaceArray");
  const auto error = KSPSolve(p.solver, p.b, p.x);
  check_petsc(VecResetArray(p.b), "VecResetArray");
  check_petsc(VecResetArray(p.x), "VecResetArray");
  check_petsc(error, "KSPSolve");

  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0, n_history = 0;
  const PetscReal* history = nullptr;
  KSPGetConvergedReason(p.solver, &reason);
  KSPGetIterationNumber(p.solver, &iterations);
  KSPGetResidualNorm(p.solver, &report.final);
  KSPGetResidualHistory(p.solver, &history, &n_history);
  if (report.iterations == 0) report.initial = n_history > 0 ? history[0] : report.final;
  report.iterations += static_cast<int>(iterations);
  return reason < 0 ? KSPConvergedReasons[reason] : nullptr;
}

PoissonReport Poisson::solve(std::span<const double> b, std::vector<double>& x, double target) {
  PoissonReport report{.rebuilt = rebuild_};
  if (rebuild_) set_up_preconditioner();
  const std::span<double> owned{x.data(), static_cast<std::size_t>(mesh_.n_cells)};
  const char* stopped = iterate(b, owned, target, report);
  if (stopped && !rebuild_) {  // that of another matrix may be indefinite for this one
    report.rebuilt = rebuild_ = true;
    set_up_preconditioner();
    stopped = iterate(b, owned, target, report);
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
  if (singular_)
    remove_mean(owned);
  else
    fix_level(b, owned);
  mesh_.halo.exchange(x);
  return report;
}

}  // namespace snag
