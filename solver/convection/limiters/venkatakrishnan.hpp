#pragma once
// Venkatakrishnan's factor of one change to a face, a, where the neighbours allow b of the same sign:
//
//   psi = ((b^2 + e^2) + 2 a b) / (b^2 + 2 a^2 + a b + e^2),    e^2 = K^3 (V/V_total) U^2
//
// e is Venkatakrishnan's threshold (K h)^3 made dimensionless with the volume of the domain and the speed U: a smooth extremum, where
// |b| ~ h^2 u'', is limited by O(h^2) only and the scheme stays second order.
// Source: Venkatakrishnan (1995), J. Comput. Phys. 118, 120. The value of K is not checked against the paper.
#include "mesh/mesh.hpp"
#include "parallel/sum.hpp"

namespace snag {

/// `Value`: double, or several in one instruction. e2: of the cell, m2/s2.
template <class Value>
[[gnu::always_inline]] inline Value venkatakrishnan_factor(const Value& a, const Value& b, double e2) {
  const Value b2 = b * b + e2, ab = a * b;
  return (b2 + 2 * ab) / (b2 + 2 * a * a + ab);
}

/// e^2/V, m2/s2 over m3. `reference_speed` U, m/s. Collective.
inline double venkatakrishnan_threshold(const Mesh& mesh, double reference_speed) {
  constexpr double smooth_cells = 5;  // K, in the range that is usual
  double volume = 0;
  for (int c = 0; c < mesh.n_cells; ++c) volume += mesh.cell_volume[c];
  return smooth_cells * smooth_cells * smooth_cells * reference_speed * reference_speed / sum(mesh.comm, volume);
}

}  // namespace snag
