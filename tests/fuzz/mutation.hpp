#pragma once
// Damage to a file: deterministic in its seed.
#include <cstdint>
#include <string>
#include <vector>

namespace snag::fuzz {

/// One of the seeds with one to four changes: bytes, numbers, words, lines, parts left out, doubled or taken from another seed.
std::string mutated(const std::vector<std::string>& seeds, std::uint64_t number);

}  // namespace snag::fuzz
