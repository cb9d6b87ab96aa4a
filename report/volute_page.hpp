#pragma once
// Stay of rags over the angle of the volute as a page: shares of time, distance from the shaft, events.
#include <string>
#include <vector>

#include "observe/volute_histogram.hpp"

namespace snag {

struct NamedVolute {
  std::string name;  // of a group, or where it is seen
  VoluteHistogram histogram;
};

/// One HTML file, a line for each histogram.
std::string volute_page(const std::vector<NamedVolute>& volutes);

}  // namespace snag
