// Parallel bond: two spheres are glued by springs spread over a round section of the particle's radius,
//   k_n = S_n A,   k_s = S_t A,   k_b = S_nb I,   k_t = S_t J      (dem/bonds/elastic_bond.hpp)
//   A = pi r_p^2,  I = pi r_p^4/4,  J = 2 I;   S_n, S_t, S_nb: normal, tangential, bending stiffness per unit area
// For small steps it is the incremental law of Potyondy and Cundall (2004), Int. J. Rock Mech. Min. Sci. 41, 1329; Jensen (2018) Eqs.
// 3.10-3.20, with S_n replaced by S_nb in bending (Eq. 3.24). A chain of n such bonds bends under an end load P across it by
//   P L^3/(3 E I) (1 - 1/(4 n^2)) + n P/k_s,   E I = k_b l0,  L = n l0:
// each bond bends at its middle and shears too.
#include "dem/bonds/bond_law.hpp"

namespace snag {

namespace {

BondCoefficients coefficients(const Rag& rag, int direction) {
  const BondProperties& p = rag.bond[direction];
  const BondSection section(rag.radius);
  return bond_coefficients(rag, direction,
                           {.normal = p.normal_stiffness * section.area,
                            .shear = p.tangential_stiffness * section.area,
                            .bending = p.bending_stiffness * section.bending,
                            .torsion = p.tangential_stiffness * section.torsion});
}

struct ParallelBond final : BondLaw {
  static constexpr const char* name = "parallel_bond";

  BondLawDescription description() const override {
    return {.name = name,
            .equation = "k_n = S_n A, k_s = S_t A, k_b = S_nb I, k_t = S_t J; A = pi r_p^2, I = pi r_p^4/4, J = 2 I",
            .source = "Potyondy and Cundall (2004); Jensen (2018) Eqs. 3.10-3.20, 3.24",
            .valid_for = "cloth and fibres; shear and bending of a bond are independent"};
  }
  std::unique_ptr<PieceBonds> bonds(const Rag& rag) const override { return linear_bonds({coefficients(rag, 0), coefficients(rag, 1)}); }

  std::vector<BondReference> reference_cases() const override {
    // Jensen (2018) Table 3.3 at 1 mm.
    Rag rag;
    rag.radius = 1e-3, rag.mass = 1e-6, rag.inertia = 4e-13;
    rag.bond[0] = {7.65e8, 5.0e6, 3.86e7, 0, 0};
    const std::string source = "Jensen (2018) Eqs. 3.13-3.20, Table 3.3";
    return {{.what = "elongation by 1 um",
             .source = source,
             .rag = rag,
             .shift = {1e-6, 0, 0},
             .force = {-2.40332e-3, 0, 0},
             .tolerance = 1e-5},
            {.what = "shear by 1 nm",
             .source = source,
             .rag = rag,
             .shift = {0, 1e-9, 0},
             .force = {0, -1.570796e-8, 0},
             .torque = {{{0, 0, 1.570796e-11}, {0, 0, 1.570796e-11}}},
             .tolerance = 1e-4},
            {.what = "bend by 0.02",
             .source = source,
             .rag = rag,
             .turn = {{{0, 0, -0.01}, {0, 0, 0.01}}},
             .torque = {{{0, 0, 6.063274e-7}, {0, 0, -6.063274e-7}}},
             .tolerance = 1e-6},
            {.what = "twist by 0.02",
             .source = source,
             .rag = rag,
             .turn = {{{-0.01, 0, 0}, {0.01, 0, 0}}},
             .torque = {{{1.570796e-7, 0, 0}, {-1.570796e-7, 0, 0}}},
             .tolerance = 1e-6}};
  }
};
[[maybe_unused]] const bool registered = bond_laws().add<ParallelBond>();

}  // namespace
}  // namespace snag
