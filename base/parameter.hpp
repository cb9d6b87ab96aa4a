#pragma once
// A parameter is declared once: the case file reader, `snag check`, the manual and the diagnosis use the same record.
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

/// Where a default value comes from.
enum class Basis { measured, literature, calibrated, assumed };
const char* name(Basis basis);

/// What a parameter is read into; the value found there at declaration is the default (an empty optional: "chosen by Snag").
using ParameterTarget = std::variant<double*, std::optional<double>*, int*, bool*, std::string*, Vec3*, Mat3*, std::vector<double>*,
                                     std::vector<Vec3>*, std::vector<std::string>*>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// One key of the case file. Numbers are held in SI; `key` is written in a case file either with a unit in the value
/// (density = "998 kg/m3") or with the unit in the key (density_kg_m3 = 998); a dimensionless number takes the bare key.
struct Parameter {
  std::string key;             // without unit
  ParameterTarget target;      // not owned
  std::string unit = "1";      // SI unit of the number; "1" dimensionless; "" for text and switches
  double minimum = -infinity;  // inclusive
  double maximum = infinity;   // inclusive
  Basis basis = Basis::assumed;
  std::string meaning = {};
  std::vector<std::string> choices = {};  // of a text: the values allowed; empty: any
  bool required = false;
  bool is_file = false;   // a text that is a path, relative to the folder of the case file
  bool may_move = false;  // how far a run goes, not what it computes: a resumed run may have another value
};

/// The same for a text, a list of texts or a switch.
inline Parameter setting(std::string key, ParameterTarget target, std::string meaning, std::vector<std::string> choices = {}) {
  return {.key = std::move(key), .target = target, .unit = "", .meaning = std::move(meaning), .choices = std::move(choices)};
}

/// The same for a file beside the case file.
inline Parameter file_setting(std::string key, std::string* target, std::string meaning) {
  Parameter parameter = setting(std::move(key), target, std::move(meaning));
  parameter.is_file = true;
  return parameter;
}

/// A table of the case file: [name], or [[name]] where it repeats.
struct Section {
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
  bool repeated = false;
};

/// The key as it is written to case.resolved.toml, unit included: density_kg_m3, speed_rad_s, drag_factor.
std::string key_with_unit(const Parameter& parameter);

}  // namespace snag
