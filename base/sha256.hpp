#pragma once
// Fingerprint of a text: SHA-256, hexadecimal.
#include <string>
#include <string_view>

namespace snag {

std::string sha256(std::string_view text);

}  // namespace snag
