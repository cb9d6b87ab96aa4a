// The loops, in the order of a step. Numbers a face, then a cell; Vec3 is 24 bytes, a velocity gradient 72, owner and neighbour 8.
// S face vector, d way between the centres, x_f and x_P centres, w weight, V volume, m mobility, F flux, G gradient of velocity.
#include "benchmark/speed/traffic.hpp"

namespace snag {

namespace {

struct Bytes {
  double face = 0, cell = 0;
};
constexpr Bytes operator+(const Bytes& a, const Bytes& b) { return {a.face + b.face, a.cell + b.cell}; }
constexpr Bytes operator*(double n, const Bytes& a) { return {n * a.face, n * a.cell}; }

// Gauss-Seidel: two entries a face of value and column; row, right side, diagonal, x read and written.
constexpr Bytes sweep_vector{2 * 12, 4 + 24 + 24 + 48};
constexpr Bytes sweep_scalar{2 * 12, 4 + 8 + 8 + 16};

// Least-squares gradients: d; phi, G cleared, added to, multiplied by the inverse matrix of 48 bytes.
constexpr Bytes gradient_vector{8 + 24, 24 + 72 + 144 + 48 + 144};
constexpr Bytes gradient_scalar{8 + 24, 8 + 24 + 48 + 48 + 48};
// Of pressure: the same, then the Gauss form with x_f, d, S, and x_P, p, slope, V.
constexpr Bytes gradient_pressure = gradient_scalar + Bytes{8 + 8 + 72, 24 + 8 + 24 + 24 + 48 + 48 + 8};

constexpr Bytes limiter{8 + 8 + 24, 4 + 24 + 72 + 8 + 8 + 24};  // faces of cells, x_f; u, G, psi, V, x_P

// Momentum
constexpr Bytes momentum_guess = Bytes{24, 0} + limiter;                             // fluxes; from the second corrector on
constexpr Bytes momentum_rows{0, 8 + 24 + 48 + 48};                                  // V, grad p, old velocities, diagonal and right side
constexpr Bytes momentum_faces{8 + 72 + 8 + 8 + 8 + 8 + 16, 48 + 48 + 72 + 8 + 24};  // S, d, x_f, w, F, mu, places, entries
constexpr Bytes momentum_assembly = momentum_rows + momentum_faces;

// Pressure
constexpr Bytes pressure_flux{8 + 8 + 72 + 8 + 8 + 8, 24 + 72 + 24 + 8 + 8 + 24};
constexpr Bytes pressure_imbalance{8 + 8, 8 + 16};
constexpr Bytes pressure_right_side{0, 8 + 8};
constexpr Bytes pressure_cross_flux{8 + 48 + 8 + 8, 16 + 24};  // not in the first solution
constexpr Bytes pressure_new_flux{8 + 48 + 8 + 8 + 16, 8 + 8 + 24};
constexpr Bytes pressure_new_cells{0, 48 + 8 + 24 + 16 + 8 + 48 + 24};
constexpr Bytes pressure_once = pressure_flux + pressure_imbalance + pressure_new_flux + gradient_pressure + pressure_new_cells;
// A step of conjugate gradients: the operator face by face, and loops over vectors for r into the cycle, x and the direction, and r.
constexpr Bytes pressure_operator{8 + 8, 8 + 8 + 16};
constexpr Bytes pressure_vectors{0, (8 + 4) + (4 + 16 + 16) + (16 + 8)};
// A cycle of multigrid, in single precision, passes twice over the matrix of each level: down with the residual, and up. Two entries a
// face; row, b, 1/D, x, residual. Levels hold 1.6 times the entries of the finest (one level of aggressive coarsening); prolongation and
// restriction one and a half entries a cell each.
constexpr double multigrid_complexity = 1.6;
constexpr Bytes pressure_cycle =
    multigrid_complexity * (Bytes{2 * 8, 4 + 4 + 4 + 4 + 12} + Bytes{2 * 8, 4 + 4 + 4 + 8}) + 2 * Bytes{0, 1.5 * 8 + 4 + 8};
constexpr Bytes pressure_iteration = pressure_operator + pressure_vectors + pressure_cycle;

// Turbulence: k and epsilon
constexpr Bytes turbulence_rate{16 + 8, 8 + 24};  // in the first corrector
constexpr Bytes turbulence_guess{0, 32 + 24 + 72 + 8};
constexpr Bytes turbulence_diffusivity{8 + 8 + 8, 8};
constexpr Bytes turbulence_sources{0, 40};
constexpr Bytes turbulence_rows{0, 8 + 16 + 16 + 8 + 16};
constexpr Bytes turbulence_faces{8 + 48 + 8 + 8 + 16 + 8 + 16, 8 + 24 + 16 + 16};
constexpr Bytes turbulence_scaling{32, 8 + 16 + 16 + 4 + 16};
constexpr Bytes turbulence_viscosity{8 + 8 + 8, 16 + 8 + 8};
constexpr Bytes turbulence_once =
    turbulence_guess + turbulence_viscosity +
    2 * (turbulence_diffusivity + turbulence_sources + gradient_scalar + turbulence_rows + turbulence_faces + turbulence_scaling);

// The rest of a step: guesses from the history with their rates and limiter, history of the fluxes before and after, Courant numbers,
// balances.
constexpr Bytes history_flux{8 + 8 + 72 + 16 + 8 + 24, 48 + 72 + 24};
constexpr Bytes history_rates{8 + 48 + 8 + 8, 16 + 32};
constexpr Bytes history_cells{0, 16 + 8 + 3 * 72 + 3 * 24};
constexpr Bytes history_begin{8 + 16 + 8, 16 + 8};
constexpr Bytes history_end{8 + 8 + 24 + 8 + 16, 24};  // with what gradients add, of the last fluxes
constexpr Bytes courant_numbers{8 + 16, 16 + 32 + 8};
// Balances: guess, prediction and factors of the limiter kept and put back; the fluxes once more, and what they do to their cells.
constexpr Bytes balances_kept{0, 2 * (48 + 12) + 24 + 12 + 2 * (12 + 24 + 24) + 12 + 24};
constexpr Bytes balances_fluxes{8 + 72 + 8 + 8 + 8, 24 + 24 + 72 + 24 + 24};
constexpr Bytes balances_cells{0, 24 + 8 + 4 * 24};
constexpr Bytes rest_once = history_flux + history_rates + history_cells + limiter + history_begin + history_end + courant_numbers +
                            balances_kept + balances_fluxes + balances_cells;

}  // namespace

Traffic traffic_of(const StepReport& step, double n_cells, double n_faces) {
  const auto bytes = [&](const Bytes& each) { return n_faces * each.face + n_cells * each.cell; };
  Traffic traffic{.rest = bytes(rest_once)};
  for (std::size_t i = 0; i < step.outer.size(); ++i) {
    const OuterReport& outer = step.outer[i];
    if (i > 0) traffic.momentum += bytes(momentum_guess);
    if (i == 0) traffic.turbulence += bytes(turbulence_rate);
    traffic.momentum += bytes(momentum_assembly + outer.momentum.sweeps * sweep_vector);
    const int n_solves = outer.continuity.solves;
    traffic.pressure += bytes(pressure_once + n_solves * pressure_right_side + (n_solves - 1) * (gradient_pressure + pressure_cross_flux) +
                              outer.continuity.iterations * pressure_iteration);
    traffic.turbulence += bytes(turbulence_once + outer.turbulence.sweeps() * sweep_scalar);
    traffic.rest += bytes(gradient_vector);
  }
  return traffic;
}

}  // namespace snag
