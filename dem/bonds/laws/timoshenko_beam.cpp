// Beam bond: each bond is a straight, uniform beam of Timoshenko from centre to centre, clamped to both spheres,
//   k_n = E A/l,   1/k_s = l^3/(12 E I) + l/(kappa G A),   k_b = E I/l,   k_t = G J/l      (dem/bonds/elastic_bond.hpp)
// with the beam's constants from the properties of the piece, l = 2 r_p the length, r_p of the section A = pi r_p^2, I = pi r_p^4/4:
//   E A/l = S_n A,   G A/l = S_t A,   E I/l = S_nb I,   G J/l = 2 (S_t/S_n) S_nb I   (a round beam: J = 2 I, G/E = S_t/S_n)
// kappa is the shear factor of the section; 0: rigid in shear, the beam of Euler and Bernoulli. In the strains of this bond (shear s = r -
// g b about the mean direction of its ends, bend beta) the stiffness matrix of a beam is diagonal:
//   M_1 + M_2 = -F_s l,   M_1 - M_2 = 2 k_b beta.
// A chain is then exact at its particles for small deflections: n bonds under an end load P across them bend by
//   P L^3/(3 E I) + P L/(kappa G A),   L = n l, for every n.
// Strength is judged by the moment at the middle of the bond, as that of the parallel bond.
// Sources: stiffness matrix: Przemieniecki (1968), Theory of Matrix Structural Analysis, section 5.6; kappa: Cowper (1966), J. Appl. Mech.
// 33, 335, and Hutchinson (2001), J. Appl. Mech. 68, 87; beams as bonds: Andre et al. (2012), Comput. Methods Appl. Mech. Eng. 213-216,
// 113, and Obermayr et al. (2013), Comput. Geotech. 49, 299. The formulas are not checked against the last two papers.
#include <algorithm>

#include "dem/bonds/bond_law.hpp"

namespace snag {

namespace {

struct TimoshenkoBeam final : BondLaw {
  static constexpr const char* name = "timoshenko_beam";
  double shear_factor = 0.9;

  BondLawDescription description() const override {
    return {.name = name,
            .equation =
                "k_n = E A/l, 1/k_s = l^3/(12 E I) + l/(kappa G A), k_b = E I/l, k_t = G J/l; "
                "E A/l = S_n A, G A/l = S_t A, E I/l = S_nb I, G J/l = 2 (S_t/S_n) S_nb I",
            .source = "Obermayr et al. (2013), after Andre et al. (2012)",
            .valid_for = "fibres, and strips that bend out of their plane; a sheet shears in its plane as a grid of such beams does"};
  }
  std::vector<Parameter> parameters() override {
    return {{"shear_factor", &shear_factor, "1", 0, 1, Basis::literature,
             "kappa, shear factor of the beam's section; a round one with Poisson ratio 0.3 has 0.89 (Cowper 1966) or 0.93 (Hutchinson "
             "2001); 0: rigid in shear."}};
  }
  std::unique_ptr<PieceBonds> bonds(const Rag& rag) const override { return linear_bonds({coefficients(rag, 0), coefficients(rag, 1)}); }

  std::vector<BondReference> reference_cases() const override {
    // A beam of E = 1 GPa, nu = 0.25 and 0.1 mm between spheres of 1 mm: E I/l = 2.454369e-6 N m, 12 E I/l^3 = 7.363108 N/m, G A/l =
    // 1570.796 N/m.
    Rag rag;
    rag.radius = 1e-3, rag.mass = 1e-6, rag.inertia = 4e-13;
    rag.bond[0] = {1.25e9, 5e8, 3.125e6, 0, 0};
    const std::string source = "Przemieniecki (1968) Eq. 5.116";
    const double k_s = 1 / (1 / 7.363108 + 1 / (0.9 * 1570.796));
    return {{.what = "elongation by 1 um",
             .source = source,
             .rag = rag,
             .shift = {1e-6, 0, 0},
             .force = {-3.926991e-3, 0, 0},
             .tolerance = 1e-6},
            {.what = "one end moved across by 0.1 nm, no rotation",
             .source = source,
             .rag = rag,
             .shift = {0, 1e-10, 0},
             .force = {0, -k_s * 1e-10, 0},
             .torque = {{{0, 0, k_s * 1e-13}, {0, 0, k_s * 1e-13}}},
             .tolerance = 1e-4},
            {.what = "one end turned by 1e-5, the other clamped: k_b + k_s l^2/4 and k_b - k_s l^2/4",
             .source = source,
             .rag = rag,
             .turn = {{Vec3{}, {0, 0, 1e-5}}},
             .force = {0, k_s * 1e-8, 0},
             .torque = {{{0, 0, 1e-5 * (2.454369e-6 - k_s * 1e-6)}, {0, 0, -1e-5 * (2.454369e-6 + k_s * 1e-6)}}},
             .tolerance = 1e-5},
            {.what = "twist by 0.001: G J/l",
             .source = source,
             .rag = rag,
             .turn = {{{-5e-4, 0, 0}, {5e-4, 0, 0}}},
             .torque = {{{1.963495e-9, 0, 0}, {-1.963495e-9, 0, 0}}},
             .tolerance = 1e-5}};
  }

 private:
  BondCoefficients coefficients(const Rag& rag, int direction) const {
    const BondProperties& p = rag.bond[direction];
    const BondSection section(rag.radius);
    const double l = 2 * rag.radius, k_b = p.bending_stiffness * section.bending, rigid_in_shear = 12 * k_b / (l * l);
    const double sheared = shear_factor * p.tangential_stiffness * section.area;
    const double k_s = shear_factor > 0 ? rigid_in_shear * sheared / std::max(rigid_in_shear + sheared, 1e-300) : rigid_in_shear;
    const double G_over_E = p.normal_stiffness > 0 ? p.tangential_stiffness / p.normal_stiffness : 0;
    return bond_coefficients(rag, direction,
                             {.normal = p.normal_stiffness * section.area, .shear = k_s, .bending = k_b, .torsion = 2 * G_over_E * k_b});
  }
};
[[maybe_unused]] const bool registered = bond_laws().add<TimoshenkoBeam>();

}  // namespace
}  // namespace snag
