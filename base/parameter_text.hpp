#pragma once
// Values of parameters as TOML writes them.
#include <functional>
#include <string>

#include "base/parameter.hpp"

namespace snag {

/// The shortest text that reads back as the same number: "1.0", "1e-06", "inf".
std::string toml_text(double value);
std::string toml_text(const Vec3& value);
/// In double quotes.
std::string toml_text(const std::string& value);
/// The value of a parameter, "" for an optional number that is not there; `number` prints the numbers.
std::string toml_text(const ParameterTarget& target, const std::function<std::string(double)>& number);
std::string toml_text(const ParameterTarget& target);

}  // namespace snag
