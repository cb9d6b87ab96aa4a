#pragma once
// One parameter from one value of a case file. For .cpp files of this folder only.
#include <string>

#include <toml++/toml.h>

#include "base/parameter.hpp"

namespace snag {

/// Put the value of `node` into the target of the parameter, in SI. `unit_of_key`: the unit that the key carries, or "". Throws
/// Error(usage) that begins with `where` on a wrong type, unit, range or choice.
void read_parameter(const Parameter& parameter, const std::string& unit_of_key, const toml::node& node, const std::string& where);

}  // namespace snag
