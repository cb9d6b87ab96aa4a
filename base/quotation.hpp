#pragma once
// Values of files and command lines in messages.
#include <string>
#include <string_view>

namespace snag {

/// A value as a message quotes it: at most 80 bytes, "..." behind one that is longer, "?" for control characters.
std::string shortened(std::string_view text);

}  // namespace snag
