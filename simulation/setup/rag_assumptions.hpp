#pragma once
// What a case takes over from the default cloth although it changes a part of it: the log says so, since bonds, mass and liquid belong
// together.
#include <string>
#include <vector>

#include "base/case_file.hpp"

namespace snag {

/// A line for each assumption; none for the cloth as it stands, soaked with water. `resolved`: the case with all its defaults.
std::vector<std::string> rag_assumptions(const CaseFile& resolved);

}  // namespace snag
