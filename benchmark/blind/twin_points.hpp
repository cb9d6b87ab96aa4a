#pragma once
// Base cases of the twins: one case file an operating point.
#include <string>
#include <vector>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

/// The camera and the other instruments of a set.
struct TwinInstrument {
  std::string id, unit, kind;
  double noise_u = 0, bias_u = 0;
  std::string group;
};

struct TwinExperiment {
  std::vector<std::string> cases;  // text of a case file each; the last three are withheld
  std::vector<TwinInstrument> instruments;
  std::vector<double> times;                                      // s, of samples
  std::vector<std::string> inputs;                                // lines of input_u, the same at every point
  std::vector<std::string> subsets{"all", "picture", "passage"};  // that make sense: all | picture | passage
  std::string exit_axis = "z";                                    // across the plane of the exit: x | z
  double path = 0.15;                                             // m, that a piece goes
  double tip_acceleration = 0;                                    // m/s2, of the ends of a piece against its middle: what bends it plainly
};

/// Stands in the text of a case for the x or z of an exit that is still to be placed.
inline constexpr const char* open_exit = "@exit@";

/// Conditions drawn at random within what such an experiment would choose. Throws Error(usage) for an unknown twin.
TwinExperiment twin_experiment(const std::string& twin, NormalNumbers& random);
/// Whether a subset of observables has this one: all; what one picture in the x-z plane shows; the passage of the exit.
bool in_subset(const std::string& subset, const std::string& observable);

}  // namespace snag
