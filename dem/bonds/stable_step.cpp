// Linear stability of leapfrog for a flat, infinite lattice of bonded spheres.
//
// A wave of displacements u and rotations w with phases kx, ky from particle to particle, w a quarter of a period behind u, strains the
// bonds along x by (d = 2 sin(kx/2), e = l0 cos(kx/2))
//   stretch d u_x,   shear d u_y - e w_z,  d u_z + e w_y,   twist d w_x,   bend d w_y, d w_z
// and those along y alike. With strains B the stiffness matrix is K = sum k B B^T and the dashpots' C = sum c B B^T, both divided by mass
// or moment of inertia. Leapfrog with the dashpots' velocity half a step late,
//   (z - 1)^2 + dt^2 K z + dt C (z - 1) = 0     for every mode,
// is stable while the largest eigenvalue of dt^2/4 K + dt/2 C is below 1 (z = -1 there). The largest over all phases is found on a grid of
// phases that holds 0 and pi, where it lies when one mechanism dominates.
//
// For stretch alone this is dt = (2/omega)(sqrt(1 + zeta^2) - zeta), omega^2 = 4 k/m.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false alarm of GCC 12 in its own AVX-512 headers, bug 105593
#endif
#include "dem/bonds/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>
#include <vector>

#include "dem/bonds/bond_law.hpp"

namespace snag {

namespace {

using Matrix = Eigen::Matrix<double, 6, 6>;
using Vector = Eigen::Matrix<double, 6, 1>;

enum Component { stretch, shear, twist, bend, n_components };
constexpr const char* component_name[n_components] = {"normal stiffness", "tangential stiffness (shear)", "tangential stiffness (torsion)",
                                                      "bending stiffness"};

/// One strain of the bonds of one direction under a wave, scaled by sqrt(1/m), sqrt(1/i).
struct StrainMode {
  int direction;
  Component component;
  Vector row;
  double stiffness, damping;
};

struct Scale {
  double translation, rotation;
};

void add_modes(const BondCoefficients& law, int direction, double phase, Scale scale, std::vector<StrainMode>& modes) {
  const double difference = 2 * std::sin(phase / 2), mean = law.length * std::cos(phase / 2);
  const int a = direction, b = 1 - direction, z = 2;  // along, across in the plane, normal to it
  const double side = direction == 0 ? 1 : -1;        // (a, b, z) is left-handed for direction 1
  const auto add = [&](Component component, int u, double of_u, int w, double of_w, double k, double c) {
    Vector row = Vector::Zero();
    if (u >= 0) row(u) = of_u * scale.translation;
    if (w >= 0) row(3 + w) = of_w * scale.rotation;
    modes.push_back({direction, component, row, k, c});
  };
  // A dashpot of friction adds to those of bending and torsion.
  const double friction = law.friction_arm > 0 ? law.friction_damping : 0;
  add(stretch, a, difference, -1, 0, law.normal, law.normal_damping);
  add(shear, b, difference, z, -side * mean, law.shear, law.shear_damping);
  add(shear, z, difference, b, side * mean, law.shear, law.shear_damping);
  add(twist, -1, 0, a, difference, law.torsion, law.torsion_damping + friction);
  add(bend, -1, 0, b, difference, law.bending, law.bending_damping + friction);
  add(bend, -1, 0, z, difference, law.bending, law.bending_damping + friction);
}

/// a K + b C
Matrix sum_of_modes(const std::vector<StrainMode>& modes, double damping_rate, double a, double b) {
  Matrix m = Matrix::Zero();
  for (const StrainMode& mode : modes) m += (a * mode.stiffness + b * mode.damping) * (mode.row * mode.row.transpose());
  for (int i = 0; i < 3; ++i) m(i, i) += b * damping_rate;
  return m;
}

/// dt^2/4 K + dt/2 C
Matrix step_matrix(const std::vector<StrainMode>& modes, double damping_rate, double dt) {
  return sum_of_modes(modes, damping_rate, dt * dt / 4, dt / 2);
}

double largest_eigenvalue(const Matrix& m) { return Eigen::SelfAdjointEigenSolver<Matrix>(m, Eigen::EigenvaluesOnly).eigenvalues()(5); }

/// Step at which the largest eigenvalue is 1; it grows with dt.
double critical_step(const std::vector<StrainMode>& modes, double damping_rate, double upper) {
  double low = 0, high = upper;
  for (int k = 0; k < 50 && high - low > 1e-12 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (largest_eigenvalue(step_matrix(modes, damping_rate, middle)) < 1 ? low : high) = middle;
  }
  return low;
}

std::string dominant(const std::vector<StrainMode>& modes, double damping_rate, double dt) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(step_matrix(modes, damping_rate, dt));
  const Vector wave = solver.eigenvectors().col(5);
  double share[2][n_components] = {};
  for (const StrainMode& mode : modes)
    share[mode.direction][mode.component] += (dt * dt / 4 * mode.stiffness + dt / 2 * mode.damping) * std::pow(mode.row.dot(wave), 2);
  double most = dt / 2 * damping_rate * wave.head<3>().squaredNorm();
  std::string name = "drag";
  for (int d = 0; d < 2; ++d)
    for (int c = 0; c < n_components; ++c)
      if (share[d][c] > most) most = share[d][c], name = std::string(component_name[c]) + (d == 0 ? " lengthwise" : " crosswise");
  return name;
}

/// The modes of waves with phases on a grid over 0 .. pi: f(modes).
template <class F>
void for_waves(const Rag& rag, const PieceBonds& bonds, const F& f) {
  const Scale scale{1 / std::sqrt(rag.mass), 1 / std::sqrt(rag.inertia)};
  const bool is_chain = rag.n_rows == 1;
  constexpr int n_phases = 4;  // intervals
  for (int p = 0; p <= n_phases; ++p) {
    for (int q = 0; q <= (is_chain ? 0 : n_phases); ++q) {
      std::vector<StrainMode> modes;
      if (rag.n_columns > 1) add_modes(bonds.coefficients(0), 0, std::numbers::pi * p / n_phases, scale, modes);
      if (!is_chain) add_modes(bonds.coefficients(1), 1, std::numbers::pi * q / n_phases, scale, modes);
      f(modes);
    }
  }
}

}  // namespace

StepRates bond_rates(const Rag& rag, double damping_rate) {
  StepRates rates{0, damping_rate, 0};
  if (rag.n_columns == 1 && rag.n_rows == 1) return rates;
  for_waves(rag, *bonds_of(rag), [&](const std::vector<StrainMode>& modes) {
    rates = largest(rates, {largest_eigenvalue(sum_of_modes(modes, damping_rate, 1, 0)),
                            largest_eigenvalue(sum_of_modes(modes, damping_rate, 0, 1)), 0});
  });
  return rates;
}

StepLimit stable_bond_step(const Rag& rag, double damping_rate) {
  const auto bonds = bonds_of(rag);
  const bool is_chain = rag.n_rows == 1;
  StepLimit limit{damping_rate > 0 ? 2 / damping_rate : std::numeric_limits<double>::infinity(), "drag on " + rag.name};
  if (rag.n_columns == 1 && rag.n_rows == 1) return limit;
  // Upper bound of the search: undamped stretch of the stiffer direction, doubled, or less.
  const double stiffest = std::max(bonds->coefficients(0).normal, is_chain ? 0 : bonds->coefficients(1).normal);
  if (stiffest > 0) limit.step = std::min(limit.step, 2 * std::sqrt(rag.mass / stiffest));
  for_waves(rag, *bonds, [&](const std::vector<StrainMode>& modes) {
    if (largest_eigenvalue(step_matrix(modes, damping_rate, limit.step)) < 1) return;
    limit.step = critical_step(modes, damping_rate, limit.step);
    limit.reason = "bonds of " + rag.name + ": " + dominant(modes, damping_rate, limit.step);
  });
  return limit;
}

}  // namespace snag
