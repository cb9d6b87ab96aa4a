#pragma once
// Exceptions of libraries in a user's words.
#include <exception>

#include "base/error.hpp"

namespace snag {

/// An Error as it is; of other exceptions one that says what it means and what to do, the library's own words last.
Error explained(const std::exception& failure);

}  // namespace snag
