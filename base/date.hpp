#pragma once
#include <string>

namespace snag {

/// Now, in UTC: 2026-01-31T12:00:00Z.
std::string date();

}  // namespace snag
