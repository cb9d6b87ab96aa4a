#pragma once
// What this program was made of, for reports of results and of defects: nothing in it depends on the machine it runs on.
#include <string>

namespace snag {

/// Version, compiler and flags, and a line for each library with the version that is loaded.
std::string build_info();

}  // namespace snag
