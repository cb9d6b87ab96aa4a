#include "dem/bonds/elastic_bond.hpp"

#include <algorithm>
#include <numbers>

namespace snag {

BondSection::BondSection(double r) : area(std::numbers::pi * r * r), bending(std::numbers::pi * r * r * r * r / 4), torsion(2 * bending) {}

BondCoefficients bond_coefficients(const Rag& rag, int direction, const BondStiffness& stiffness) {
  const BondProperties& p = rag.bond[direction];
  const double r = rag.radius;
  const BondSection section(r);
  BondCoefficients law{stiffness};
  law.length = 2 * r;
  law.per_area = 1 / section.area, law.per_bending_modulus = r / section.bending, law.per_torsion_modulus = r / section.torsion;

  // c_d sqrt(2 k m_eq) with m_eq = m/2
  const auto dashpot = [&](double k, double mass) { return rag.bond_damping * std::sqrt(k * mass); };
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
