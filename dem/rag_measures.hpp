#pragma once
// What is to be known of the rags while they move: sums and extremes for monitors, and sheets for pictures. The rings are up to date after
// RagSystem::advance, migrate and load; bonds are counted by the tile of their first end.
#include <array>
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "dem/rag_system.hpp"

namespace snag {

/// State of one rag as a whole, the same on every rank; all zero while it has no particles.
struct RagState {
  std::int64_t n_particles = 0;     // that exist now
  Vec3 centre, velocity;            // of mass; m, m/s
  Vec3 lower, upper;                // corners of its bounding box, m
  Vec3 momentum, angular_momentum;  // kg m/s; kg m2/s about the origin, spins included
  double kinetic_energy = 0;        // J, spins included
  double bond_energy = 0;           // J, elastic
  double end_to_end = 0;            // distance of the first and the last particle of the middle row, m; nan if one does not exist
  double elongation_ratio = 0;      // largest over second axis of the ellipsoid with the same second moments; 1 for a point, inf for a line
  double max_bond_tension = 0;      // N, elastic
  Vec3 max_bond_tension_place;      // middle of that bond, m
  double max_bond_strain = 0;       // (l - l0)/l0
};
/// State of each rag. Collective.
std::vector<RagState> rag_states(const RagSystem& rags);

/// Strain below which a share p of the whole bonds of a rag stays, for instance p = 0.99; 0 without bonds. The same on any number of ranks.
/// Collective.
double bond_strain_quantile(const RagSystem& rags, int rag, double p);

/// All particles and the triangles between them, gathered on rank 0 (empty on the others).
struct RagSheet {
  std::vector<std::int64_t> id;  // ascending
  std::vector<int> rag;
  std::vector<Vec3> position, velocity;            // m, m/s
  std::vector<std::array<double, 4>> orientation;  // w, x, y, z
  std::vector<double> tension;  // largest elastic tension of the particle's bonds, N (negative: all are compressed); 0 without bonds
  std::vector<double> strain;   // largest strain of the particle's bonds
  std::vector<std::array<int, 3>> triangles;  // places in the arrays; two for each lattice cell with four whole bonds
  std::vector<std::vector<Vec3>> more;        // as given
};
/// `more`: vectors of this rank's particles in the order of tiles and for_particles, gathered as well. Collective.
RagSheet gather_sheet(const RagSystem& rags, const std::vector<const std::vector<Vec3>*>& more = {});

/// Sum of the bond, contact and outside forces of the last sub-step on the clamped particles of a rag, N: what the clamp holds. Collective.
Vec3 force_on_clamped(const RagSystem& rags, int rag);

}  // namespace snag
