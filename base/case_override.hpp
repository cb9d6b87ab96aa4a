#pragma once
// Values of a case file that are replaced from the command line. For .cpp files of this folder only.
#include <string>

namespace snag {

struct CaseNode;

/// Put an override "section.0.key=value" into the tree of a file: the value is TOML, or a bare word taken as text. Throws Error(usage).
void apply_override(CaseNode& root, const std::string& text);

}  // namespace snag
