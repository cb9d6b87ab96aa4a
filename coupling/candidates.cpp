#include "coupling/candidates.hpp"

namespace snag {

std::vector<Candidate> coupling_candidates() {
  return {{.name = "averaging_length",
           .prior = {.key = "coupling.kernel_width_m",
                     .meaning = "relative change of the width over which the rag feels the water",
                     .mean = 1,
                     .sd = 1,
                     .minimum = -0.9,
                     .maximum = 9,
                     .needs = {Need::averaging}},
           .is_relative = true},
          // Acceptance tests of pump intakes allow a swirl angle of 5 degrees (ANSI/HI 9.8): 0.09.
          {"swirl",
           {.key = "pipe_flow.swirl",
            .meaning = "speed of the water about the pipe's axis at the wall over its mean speed, beyond that of the case",
            .mean = 0.05,
            .sd = 0.1,
            .minimum = -3,
            .maximum = 3,
            .needs = {Need::pipe}}},
          // Developed turbulent flow (power of 1/7) has 1.22 of the mean speed on its axis: 0.22 from flat to developed. Laminar and
          // turbulent profiles are the two forms.
          {.name = "flow_profile",
           .prior = {.key = "pipe_flow.profile",
                     .meaning = "excess of the speed on the axis over the mean speed that is added to the profile at the same flow rate",
                     .mean = 0.1,
                     .sd = 0.2,
                     .minimum = -2,
                     .maximum = 2,
                     .needs = {Need::pipe}},
           .other_keys = {"pipe_flow.profile_power_law"}},
          {"bend_vortices",
           {.key = "pipe_flow.vortices",
            .meaning = "speed of the bend's vortices towards its outside over the mean speed, beyond that of the case",
            .mean = 0.05,
            .sd = 0.1,
            .minimum = -2,
            .maximum = 2,
            .needs = {Need::bend}}}};
}

}  // namespace snag
