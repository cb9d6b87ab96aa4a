#pragma once
// Values of a case file that are replaced from the command line. For .cpp files of this folder only.
#include <string>

#include <toml++/toml.h>

namespace snag {

/// Put an override "section.0.key=value" into the tree of a file: the value is TOML, or a bare word taken as text. Throws Error(usage).
void apply_override(toml::table& root, const std::string& text);

}  // namespace snag
