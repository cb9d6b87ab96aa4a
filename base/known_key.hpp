#pragma once
// Whether a case file can have a key at all, known before any case is built.
#include <string>

namespace snag {

/// Throws Error(usage) that begins with `where` if no table of a case file has the key of an override "section.0.key=value". Former names
/// count. What sub-tables of pieces hold is the same for every shape: "disc.0.cut.depth" is looked up as [rag.cut].
void check_override_key(const std::string& override_text, const std::string& where);

}  // namespace snag
