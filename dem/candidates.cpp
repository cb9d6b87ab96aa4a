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
            .needs = {Need::bonds}}}};
}

}  // namespace snag
