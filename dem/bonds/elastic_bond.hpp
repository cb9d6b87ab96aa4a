#pragma once
// Elastic bond between two spheres of equal radius r_p, as a function of their present relative pose.
//
// Ends 1 and 2 at x1, x2 turn with the unit quaternions q1, q2; a_i = q_i a0 is the lattice direction a0 of the bond, carried by end i.
//   r = x2 - x1,  l = |r|,  l0 = 2 r_p,  b = a1 + a2,  c = a1.a2,  |b|^2 = 2 (1 + c)
//
// Energies, and the force on end 2 (end 1: the opposite) and torques that follow by differentiation:
//   normal   U = 1/2 k_n (l - l0)^2    F2 = -k_n (l - l0) r/l         (a law may put another tension N(l - l0) there)
//   shear    U = 1/2 k_s |s|^2         F2 = -k_s s,  T_i = k_s g (a_i x s),         s = r - g b,  g = r.b/|b|^2
//   bending  U = 1/2 k_b beta^2        T1 = k_b beta/sin(beta) (a1 x a2) = -T2,     cos(beta) = c
//   torsion  U = 1/2 k_t psi^2         T1 = k_t psi b/(1 + c) = -T2,                tan(psi/2) = p.a0/p_w,  p = conj(q1) q2
// The bond has no history, so it cannot drift; a rigid motion of both ends turns forces with it; exchanging the ends exchanges forces and
// torques; linear and angular momentum of the pair are kept to round-off. What the stiffnesses are, a law says (dem/bonds/laws/).
//
// With S = cos(beta/2) = |b|/2 both angles need one square root, and stay regular up to beta = pi:
//   tan(beta/4) = sin(beta/2)/(1 + S),   tan(psi/4) = sign(p_w) p.a0/(|p_w| + S)
//
// Dashpots, Guo et al. (2013a), Jensen (2018) App. Eqs. 1.1-1.4: c = c_d sqrt(2 k m_eq), k the stiffness of the mode, m_eq = m/2 the
// equivalent mass of two equal spheres (so that c_d is the damping ratio of the shortest wave of a chain), on the relative velocity of the
// two ends at the middle of the bond, v = v2 - v1 - 1/2 (w1 + w2) x r, split along and across r; the tangential force acts at the middle:
// each end gets the torque 1/2 r x c_t v_t. Bending and torsion alike, with the moment of inertia for the mass, on w2 - w1 across and along
// r: the published model damps translation only and leaves the rotations of a cloth ringing.
//
// Rotation friction, Jensen (2018) App. Eqs. 1.5, 1.6: a moment M = |F_n| r_p c_r against w = w2 - w1, F_n the total normal force; smooth
// about zero, w -> M w/sqrt(w^2 + (M/c_f)^2): below M/c_f it is a dashpot c_f = sqrt(k i), k the smaller of the two rotational stiffnesses
// and i the moment of inertia, so that it cannot reverse a rotation within a stable step.
#include <cmath>

#include "base/vec3.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

/// Stiffnesses of the four strains; of a law that is not linear the largest that it reaches.
struct BondStiffness {
  double normal = 0, shear = 0;     // k_n, k_s; N/m
  double bending = 0, torsion = 0;  // k_b, k_t; N m
};

/// Coefficients of all bonds of one lattice direction of one rag.
struct BondCoefficients : BondStiffness {
  double length = 0;                                                                    // l0, m
  double normal_damping = 0, shear_damping = 0;                                         // N s/m
  double bending_damping = 0, torsion_damping = 0;                                      // N m s
  double friction_arm = 0;                                                              // r_p c_r, m
  double friction_damping = 0;                                                          // c_f, N m s
  double per_area = 0, per_bending_modulus = 0, per_torsion_modulus = 0;                // 1/A, r_p/I, r_p/J; 1/m2, 1/m3, 1/m3
  double normal_strength = infinity_, shear_strength = infinity_, longest = infinity_;  // Pa, Pa, m

  bool damped() const { return normal_damping > 0 || shear_damping > 0 || bending_damping > 0 || torsion_damping > 0 || friction_arm > 0; }

 private:
  static constexpr double infinity_ = __builtin_inf();
};

/// Section of a bond: that of a round rod of the particle's radius.
struct BondSection {
  explicit BondSection(double radius);
  double area, bending, torsion;  // A, m2; I, J, m4
};

/// Dashpots, friction and strengths of a rag with bonds of this stiffness. `direction`: 0 along the row, 1 between rows.
BondCoefficients bond_coefficients(const Rag& rag, int direction, const BondStiffness& stiffness);

/// State of one end: position, velocity, angular velocity, orientation and carried lattice direction a.
struct BondEnd {
  Vec3 x, v, w;
  double qw = 1, qx = 0, qy = 0, qz = 0;
  Vec3 a;
};

/// Lattice direction 0 (x) or 1 (y), turned by a unit quaternion.
template <int direction>
inline Vec3 carried_direction(double w, double x, double y, double z) {
  if constexpr (direction == 0) return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  return {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
}

struct BondForce {
  Vec3 force;             // on end 2, N; on end 1 the opposite
  Vec3 torque1, torque2;  // N m
  // elastic parts
  double tension = 0;           // N
  double length = 0;            // l, m
  double shear_squared = 0;     // (k_s |s|)^2, N2
  double bending_squared = 0;   // moment^2, N2 m2
  double torsion_moment = 0;    // N m
  double energy_parts[4] = {};  // normal, shear, bending, torsion; J
};

/// h(u) = atan(sqrt u)/sqrt u for 0 <= u <= 1, relative error below 2e-16: polynomial through the Chebyshev nodes of [0, 1].
inline double arc_tangent_ratio(double u) {
  const double v = u * u;
  double even = 0.00021423810738603946, odd = -1.93423475928923e-05;
  even = even * v + 0.003751138483965141, odd = odd * v - 0.0011252544302234645;
  even = even * v + 0.01671959606350739, odd = odd * v - 0.00899108054265826;
  even = even * v + 0.03387126702700675, odd = odd * v - 0.02556862364437174;
  even = even * v + 0.04668745304848529, odd = odd * v - 0.040811247503178855;
  even = even * v + 0.058768281144872724, odd = odd * v - 0.052374234719188166;
  even = even * v + 0.07692198997458294, odd = odd * v - 0.06665764910689723;
  even = even * v + 0.11111110578002083, odd = odd * v - 0.09090899793217341;
  even = even * v + 0.1999999999964796, odd = odd * v - 0.14285714266926733;
  even = even * v + 1.0, odd = odd * v - 0.333333333333307;
  return even + odd * u;
}

/// Force and energy of a bond by its elongation.
struct Tension {
  double force = 0, energy = 0;  // N, J
};

/// One bond whose tension is `tension_of(l - l0)`, a Tension; damping and shear, bending, torsion by `law`. A pure function without
/// branches: inlined into loops over rows it vectorises.
template <int direction, bool damped, class TensionOf>
[[gnu::always_inline]] inline BondForce bond_force(const BondCoefficients& law, const BondEnd& one, const BondEnd& two,
                                                   const TensionOf& tension_of) {
  BondForce bond;
  const Vec3 r = two.x - one.x;
  const double l = std::sqrt(dot(r, r)), inverse_l = 1 / l;
  const Tension tension = tension_of(l - law.length);
  bond.length = l, bond.tension = tension.force;

  const Vec3 b = one.a + two.a, d = two.a - one.a;
  const double half_S2 = 0.125 * dot(b, b);  // S^2/2 = (1 + c)/4
  const double sin2 = 0.25 * dot(d, d);      // sin^2(beta/2), accurate for small angles
  const double S = std::sqrt(2 * half_S2);   // cos(beta/2)
  // scalar part and a0 component of conj(q1) q2
  const double pw = one.qw * two.qw + one.qx * two.qx + one.qy * two.qy + one.qz * two.qz;
  const double pa = direction == 0 ? one.qw * two.qx - one.qx * two.qw - one.qy * two.qz + one.qz * two.qy
                                   : one.qw * two.qy - one.qy * two.qw - one.qz * two.qx + one.qx * two.qz;
  // Three quotients by one division: divisions and roots are what the loops over bonds wait for.
  const double S1S = S * (1 + S), turn = std::fabs(pw) + S;
  const double inverse = 1 / (S1S * turn);
  const double inverse_S1S = turn * inverse;       // 1/(S (1 + S))
  const double inverse_1S = S * inverse_S1S;       // 1/(1 + S)
  const double inverse_S = (1 + S) * inverse_S1S;  // 1/S

  // shear
  const double g = 0.25 * dot(r, b) * inverse_S * inverse_S;
  const Vec3 s = r - g * b;
  const double lever = law.shear * g;
  // bending
  const double u_bend = sin2 * inverse_1S * inverse_1S;  // tan^2(beta/4)
  const double h_bend = arc_tangent_ratio(u_bend);
  const double bend = 2 * law.bending * h_bend * inverse_S1S;  // k_b beta/sin(beta)
  // torsion
  const double e = std::copysign(pa, pa * pw) * S1S * inverse;  // tan(psi/4)
  const double psi = 4 * e * arc_tangent_ratio(e * e);
  bond.torsion_moment = law.torsion * psi;
  const double twist = 0.5 * bond.torsion_moment * inverse_S * inverse_S;  // k_t psi/(1 + c)

  Vec3 pair_torque = bend * cross(one.a, two.a) + twist * b;  // on 1; on 2 the opposite
  Vec3 force = (-tension.force * inverse_l) * r - law.shear * s;
  Vec3 shear_torque1 = lever * cross(one.a, s), shear_torque2 = lever * cross(two.a, s);

  if constexpr (damped) {
    const Vec3 n = inverse_l * r;
    const Vec3 v = two.v - one.v - 0.5 * cross(one.w + two.w, r);
    const double v_n = dot(v, n);
    const Vec3 v_t = v - v_n * n;
    force -= law.normal_damping * v_n * n + law.shear_damping * v_t;
    const Vec3 torque = (0.5 * law.shear_damping) * cross(r, v_t);
    shear_torque1 += torque, shear_torque2 += torque;

    const Vec3 w = two.w - one.w;
    const double w_n = dot(w, n);
    const double moment = law.friction_arm * std::fabs(bond.tension + law.normal_damping * v_n);  // M
    constexpr double tiny = 1e-200;                                                               // keeps 0/0 out
    const double cw2 = law.friction_damping * law.friction_damping * dot(w, w);
    const double friction = moment * law.friction_damping / std::sqrt(cw2 + moment * moment + tiny);
    pair_torque += (law.bending_damping + friction) * w + ((law.torsion_damping - law.bending_damping) * w_n) * n;
  }

  bond.force = force;
  bond.torque1 = shear_torque1 + pair_torque;
  bond.torque2 = shear_torque2 - pair_torque;
  const double shear2 = dot(s, s), beta2 = 16 * u_bend * h_bend * h_bend;
  bond.shear_squared = law.shear * law.shear * shear2;
  bond.bending_squared = law.bending * law.bending * beta2;
  bond.energy_parts[0] = tension.energy, bond.energy_parts[1] = 0.5 * law.shear * shear2;
  bond.energy_parts[2] = 0.5 * law.bending * beta2, bond.energy_parts[3] = 0.5 * law.torsion * psi * psi;
  return bond;
}

/// The same with the tension k_n (l - l0): linear in all four strains.
template <int direction, bool damped>
[[gnu::always_inline]] inline BondForce bond_force(const BondCoefficients& law, const BondEnd& one, const BondEnd& two) {
  return bond_force<direction, damped>(law, one, two, [&law](double stretch) {
    return Tension{law.normal * stretch, 0.5 * law.normal * stretch * stretch};
  });
}

/// True where a bond holds: tensile stress N/A + |M_b| r/I below the normal strength, shear stress |F_s|/A + |M_t| r/J below the shear
/// strength (extreme fibre of a beam, Potyondy and Cundall 2004), and no longer than twice the contact radius.
[[gnu::always_inline]] inline bool bond_holds(const BondCoefficients& law, const BondForce& bond) {
  // Squares are compared: no roots.
  const double bending = law.normal_strength - bond.tension * law.per_area;  // what is left for it, Pa
  const double shear = law.shear_strength - std::fabs(bond.torsion_moment) * law.per_torsion_modulus;
  const double bending_squared = bond.bending_squared * (law.per_bending_modulus * law.per_bending_modulus);
  const double shear_squared = bond.shear_squared * (law.per_area * law.per_area);
  return (bending > 0) & (bending_squared < bending * bending) & (shear > 0) & (shear_squared < shear * shear) &
         (bond.length < law.longest);
}

}  // namespace snag
