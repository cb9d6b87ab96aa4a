// Gauss-Seidel:   x_i <- (b_i - sum_{j /= i} a_ij x_j) / a_ii,   row residual  r_i = a_ii (x_i^new - x_i^old)
// The convection-diffusion matrix of upwind fluxes and a time derivative is diagonally dominant: sweeps converge, fast for Courant numbers
// to about 10.
#include "solver/operators/cell_matrix.hpp"

#include <algorithm>
#include <array>

namespace snag {

void CellMatrix::update(const Mesh& mesh) {
  row_start.assign(static_cast<std::size_t>(mesh.n_cells) + 1, 0);
  place_of_owner.resize(mesh.n_interior), place_of_neighbour.resize(mesh.n_interior);
  for (int f = 0; f < mesh.n_interior; ++f)
    for (const int c : {mesh.owner[f], mesh.neighbour[f]})
      if (c < mesh.n_cells) ++row_start[c + 1];
  for (int c = 0; c < mesh.n_cells; ++c) row_start[c + 1] += row_start[c];
  const int n_entries = row_start[mesh.n_cells];
  column.resize(n_entries);
  value.resize(static_cast<std::size_t>(n_entries) + 1);
  std::vector<int> next(row_start.begin(), row_start.end() - 1);
  const auto place = [&](int row, int col) {
    if (row >= mesh.n_cells) return n_entries;
    column[next[row]] = col;
    return next[row]++;
  };
  for (int f = 0; f < mesh.n_interior; ++f) {
    place_of_owner[f] = place(mesh.owner[f], mesh.neighbour[f]);
    place_of_neighbour[f] = place(mesh.neighbour[f], mesh.owner[f]);
  }
}

namespace {

inline double ratio(double a, double b) { return a / b; }
inline Vec3 ratio(const Vec3& a, const Vec3& b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
inline double times(double a, double b) { return a * b; }
inline Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double square(double a) { return a * a; }
inline double square(const Vec3& a) { return norm_squared(a); }

inline void exchange(const Mesh& mesh, std::vector<double>& x) { mesh.halo.exchange(x); }
inline void exchange(const Mesh& mesh, std::vector<Vec3>& x) { mesh.halo.exchange({x.empty() ? nullptr : &x[0].x, 3 * x.size()}, 3); }

/// One sweep; returns the sum of the squares of the row residuals.
template <class Value>
double sweep(int n_cells, const CellMatrix& matrix, const Value* diagonal, const Value* b, Value* x) {
  double squares = 0;
  for (int i = 0; i < n_cells; ++i) {
    Value rest = b[i];
    for (int k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k) rest -= matrix.value[k] * x[matrix.column[k]];
    squares += square(rest - times(diagonal[i], x[i]));
    x[i] = ratio(rest, diagonal[i]);
  }
  return squares;
}

}  // namespace

template <class Value>
SweepReport gauss_seidel(const Mesh& mesh, const CellMatrix& matrix, std::span<const Value> diagonal, std::span<const Value> b,
                         std::vector<Value>& x, double tolerance, int max_sweeps) {
  SweepReport report;
  double scale = 0;
  for (int c = 0; c < mesh.n_cells; ++c) scale += square(b[c]);
  for (report.sweeps = 0; report.sweeps < max_sweeps;) {
    std::array<double, 3> squares{0, 0, scale};
    for (int half = 0; half < 2; ++half, ++report.sweeps) {
      exchange(mesh, x);
      squares[half] = sweep(mesh.n_cells, matrix, diagonal.data(), b.data(), x.data());
    }
    std::array<double, 3> all{};
    MPI_Allreduce(squares.data(), all.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
    const double reference = all[2] > 0 ? std::sqrt(all[2]) : 1;
    if (report.sweeps == 2) report.initial = std::sqrt(all[0]) / reference;
    report.final = std::sqrt(all[1]) / reference;
    report.converged = report.final <= tolerance;
    if (report.converged || !std::isfinite(report.final)) break;
  }
  exchange(mesh, x);
  return report;
}

template SweepReport gauss_seidel(const Mesh&, const CellMatrix&, std::span<const double>, std::span<const double>, std::vector<double>&,
                                  double, int);
template SweepReport gauss_seidel(const Mesh&, const CellMatrix&, std::span<const Vec3>, std::span<const Vec3>, std::vector<Vec3>&, double,
                                  int);

}  // namespace snag
