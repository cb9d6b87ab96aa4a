#pragma once
// A parameter is declared once: the case file reader, `snag check`, the manual and the diagnosis use the same record.
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/choice.hpp"
#include "base/vec3.hpp"

namespace snag {

/// Where a default value comes from.
enum class Basis { measured, literature, calibrated, assumed };
const char* name(Basis basis);

/// What a parameter is read into; the value found there at declaration is the default (an empty optional: the program chooses).
using ParameterTarget = std::variant<double*, std::optional<double>*, int*, bool*, std::string*, AnyChoice*, Vec3*, Mat3*,
                                     std::vector<double>*, std::vector<Vec3>*, std::vector<std::string>*>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a key was called in an earlier version. The former name is still read, with a warning; the resolved case has the present one. The
/// hash of a case takes the former one, so that a new name changes no hash.
struct FormerName {
  std::string key = {};                                          // without unit; empty: only values were renamed
  std::string unit = {};                                         // SI unit at that time, where it was another; empty: the same
  std::vector<std::pair<std::string, std::string>> values = {};  // former and present value, as TOML: {"\"given\"", "\"custom\""}
};

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
  std::vector<std::string> choices = {};  // of a text: the values allowed; empty: any. Of a number: words in its place, read as NaN
  bool required = false;
  bool is_file = false;               // a text that is a path, relative to the folder of the case file
  bool may_differ_on_resume = false;  // it says how far a run goes, not what the run computes
  FormerName former = {};
};

/// The same for a text, a list of texts, a switch or a choice. `choices`: empty: any text, or all words of a choice.
inline Parameter setting(std::string key, ParameterTarget target, std::string meaning, std::vector<std::string> choices = {}) {
  if (const auto* choice = std::get_if<AnyChoice*>(&target); choice && choices.empty()) choices = (*choice)->words();
  return {.key = std::move(key), .target = target, .unit = "", .meaning = std::move(meaning), .choices = std::move(choices)};
}

/// The same for a file, relative to the case file.
inline Parameter file_setting(std::string key, std::string* target, std::string meaning) {
  Parameter parameter = setting(std::move(key), target, std::move(meaning));
  parameter.is_file = true;
  return parameter;
}

/// The same parameter with what it was called before.
inline Parameter renamed(Parameter parameter, FormerName former) {
  parameter.former = std::move(former);
  return parameter;
}

/// A table of the case file: [name], or [[name]] where it repeats.
struct Section {
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
  bool repeated = false;
  std::string former_name = {};  // in an earlier version; not of a table that repeats
};

/// The key as it is written to case.resolved.toml, unit included: density_kg_m3, rotation_speed_rad_s, drag_factor.
std::string key_with_unit(const Parameter& parameter);

}  // namespace snag
