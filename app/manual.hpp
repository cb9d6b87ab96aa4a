#pragma once
// The manual of the case file, generated from the parameter records; docs/case-file.md is compared with it in a test.
#include <string>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

/// Text of docs/case-file.md.
std::string case_file_manual();

/// One table of the manual.
std::string section_text(const Section& section);

}  // namespace snag
