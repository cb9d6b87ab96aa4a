#pragma once
// One piece of cloth: its lattice, its place, and the properties that all its particles and bonds share.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "dem/particles/cut.hpp"

namespace snag {

class BondLaw;

/// Stiffness and strength of the bonds of one lattice direction, per unit area of the bond (A = pi r^2, I = pi r^4/4, J = 2 I).
struct BondProperties {
  double normal_stiffness = 0;      // S_n, N/m3
  double tangential_stiffness = 0;  // S_t, N/m3: shear and torsion
  double bending_stiffness = 0;     // S_nb, N/m3
  double normal_strength = 0;       // Pa; 0: never breaks
  double shear_strength = 0;        // Pa; 0: never breaks
};

struct Rag {
  std::string name;
  int n_columns = 1, n_rows = 1;  // lattice; columns run along the length (x of the lattice frame), rows along the width (y)
  double mask_radius = 0;         // > 0: only places within this distance of the lattice's centre exist (disc), m
  std::vector<Cut> cuts;
  std::int64_t first_particle =
      0;  // id of the lattice's first place; id = first_particle + row * n_columns + column, places outside the mask included
  std::int64_t n_particles = 0, n_bonds = 0;  // that exist
  double radius = 0;                          // r_p, m; lattice spacing 2 r_p
  double mass = 0;                            // of one particle, kg
  double inertia = 0;                         // 2/5 m r^2, kg m2
  double hydrodynamic_volume = 0;    // V_h: thickness (2 r)^2 of the cloth it stands for; a sphere's own volume for a single particle, m3
  double hydrodynamic_diameter = 0;  // d of the drag law: 2 r_p, m
  std::array<BondProperties, 2> bond{};     // along the row (lengthwise), between rows (crosswise)
  std::shared_ptr<const BondLaw> bond_law;  // none: default_bond_law (dem/bonds/bond_law.hpp)
  double bond_damping = 0.5;                // c_d of Guo et al. (2013a), thesis Eqs. 1.1, 1.2
  double rotation_friction = 0.001;         // c_r, thesis Eqs. 1.5, 1.6
  double contact_radius_ratio = 2.2;        // r_c / r_p: a bond ends when 2 r_c is exceeded (if breakage is on)
  bool breakage = false;
  // contacts: where they begin; the laws have the mass and the radius of the particle
  double contact_thickness = 0;  // with walls: the surface of the cloth is half of it from its particles, m; 0: 2 r_p
  double layer_thickness = 0;    // the same with other cloth, m; 0: 2 r_p
  std::optional<double> wall_friction, cloth_friction;  // Coulomb coefficients with walls, with other cloth; none: those of [contact]
  double shear_modulus = 1e6;                           // Pa
  double poisson_ratio = 0.25;

  /// Whether the lattice has a particle in this column and row.
  bool exists(int column, int row) const {
    if (column < 0 || row < 0 || column >= n_columns || row >= n_rows) return false;
    if (mask_radius <= 0) return true;
    const auto [x, y] = place(column, row);
    return x * x + y * y <= mask_radius * mask_radius * (1 + 1e-12);
  }
  /// Of a particle from the centre of the flat lattice, lengthwise and crosswise, m.
  std::array<double, 2> place(int column, int row) const {
    return {(2 * column - (n_columns - 1)) * radius, (2 * row - (n_rows - 1)) * radius};
  }
  /// Whether a bond is made from this place to the next one of its row (direction 0) or of its column (1): both particles are there, and no
  /// cut lies between them.
  bool has_bond(int column, int row, int direction) const;
  /// Distance from a wall below which a particle touches it, and its share of that from another particle, m.
  double wall_reach() const { return contact_thickness > 0 ? contact_thickness / 2 : radius; }
  double layer_reach() const { return layer_thickness > 0 ? layer_thickness / 2 : radius; }
  /// Along the sheet, how far from a particle another piece may touch the surface that it carries, m.
  double surface_reach() const { return 2 * radius * std::sqrt((n_columns > 1 ? 1.0 : 0.0) + (n_rows > 1 ? 1.0 : 0.0)); }
};

/// Distance of the centres below which particles of two rags may touch, m.
inline double contact_distance(const Rag& a, const Rag& b) {
  return std::hypot(std::max(a.surface_reach(), b.surface_reach()), a.layer_reach() + b.layer_reach());
}

}  // namespace snag
