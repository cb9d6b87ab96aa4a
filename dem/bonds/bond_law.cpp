#include "dem/bonds/bond_law.hpp"

#include <algorithm>
#include <numbers>

namespace snag {

BondLaw bond_law(const Rag& rag, int direction) {
  const BondProperties& p = rag.bond[direction];
  const double r = rag.radius, pi = std::numbers::pi;
  const double I = pi * r * r * r * r / 4, J = 2 * I;
  BondLaw law;
  law.length = 2 * r;
  const double area = pi * r * r;
  law.per_area = 1 / area, law.per_bending_modulus = r / I, law.per_torsion_modulus = r / J;
  law.normal = p.normal_stiffness * area, law.shear = p.tangential_stiffness * area;
  law.bending = p.bending_stiffness * I, law.torsion = p.tangential_stiffness * J;

  // c_d sqrt(2 k m_eq) with m_eq = m/2
  const auto dashpot = [&](double stiffness, double mass) { return rag.bond_damping * std::sqrt(stiffness * mass); };
  law.normal_damping = dashpot(law.normal, rag.mass), law.shear_damping = dashpot(law.shear, rag.mass);
  law.bending_damping = dashpot(law.bending, rag.inertia), law.torsion_damping = dashpot(law.torsion, rag.inertia);
  law.friction_damping = std::sqrt(std::min(law.bending, law.torsion) * rag.inertia);
  law.friction_arm = law.friction_damping > 0 ? r * rag.rotation_friction : 0;

  if (rag.breakage) {
    if (p.normal_strength > 0) law.normal_strength = p.normal_strength;
    if (p.shear_strength > 0) law.shear_strength = p.shear_strength;
    law.longest = 2 * rag.contact_radius_ratio * r;
  }
  return law;
}

}  // namespace snag
