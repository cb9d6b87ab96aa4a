#include "base/parameter.hpp"

#include "base/units.hpp"

namespace snag {

const char* name(Basis basis) {
  switch (basis) {
    case Basis::measured:
      return "measured";
    case Basis::literature:
      return "literature";
    case Basis::calibrated:
      return "calibrated";
    case Basis::assumed:
      return "assumed";
  }
  return "";
}

std::string key_with_unit(const Parameter& parameter) {
  const std::string suffix = suffix_of_unit(parameter.unit);
  return suffix.empty() ? parameter.key : parameter.key + "_" + suffix;
}

}  // namespace snag
