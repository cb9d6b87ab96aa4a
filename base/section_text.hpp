#pragma once
// A table of the case file as the manual prints it: all programs print theirs alike.
#include <string>

#include "base/parameter.hpp"

namespace snag {

/// Heading, meaning and one row a key: unit, default, range, basis, meaning. Markdown.
std::string section_text(const Section& section);

}  // namespace snag
