#include "dem/candidates.hpp"

namespace snag {

std::vector<Candidate> dem_candidates() {
  return {{"friction",
           {.key = "contact.wall_friction",
            .meaning = "Coulomb coefficient with walls, beyond that of the case",
            .mean = 0.3,
            .sd = 0.15,
            .minimum = 0,
            .maximum = 5,
            .needs = {Need::wall, Need::contact}}},
          {"bond_damping",
           {.key = "rag.bond_damping",
            .meaning = "damping ratio of the shortest wave of the bonds, beyond that of the case",
            .mean = 0.5,
            .sd = 0.25,
            .minimum = 0,
            .maximum = 5,
            .needs = {Need::bonds}}},
          // Without adhesion the law of Derjaguin, Muller and Toporov is that of Hertz and Mindlin.
          {.name = "wall_adhesion",
           .prior = {.key = "contact.hertz_dmt.wall_adhesion_J_m2",
                     .meaning = "work of adhesion of cloth and wall, beyond that of the case",
                     .unit = "J/m2",
                     .mean = 0.05,
                     .sd = 0.05,
                     .minimum = 0,
                     .maximum = 10,
                     .needs = {Need::wall, Need::contact, Need::hertz}},
           .with = {"contact.law=\"hertz_dmt\""}},
          {.name = "folding_speed",
           .prior = {.key = "coupling.reconfiguration.reference_speed_m_s",
                     .meaning = "relative change of the speed above which parts fold",
                     .mean = 0.5,
                     .sd = 0.5,
                     .minimum = -0.9,
                     .maximum = 9,
                     .needs = {Need::bonds}},
           .is_relative = true,
           .of_force = "reconfiguration"},
          {.name = "crumple_size",
           .prior = {.key = "rag.confine_radius_m",
                     .meaning = "relative change of the radius to which the rag was crumpled",
                     .mean = -0.15,
                     .sd = 0.2,
                     .minimum = -0.4,
                     .maximum = 2,
                     .needs = {Need::crumple}},
           .is_relative = true}};
}

}  // namespace snag
