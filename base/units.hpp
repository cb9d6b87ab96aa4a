#pragma once
// Units convert at the border, here and nowhere else. A unit is text such as "mm", "kg/m3", "m/s^2", "1/s", "N m", "rpm", "L/s".
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace snag {

/// SI value of one of a unit, and its exponents of kg, m, s. Angles and turns count as dimensionless: rpm is 2 pi/60 per second.
struct Unit {
  double factor = 1;
  std::array<int, 3> exponents{};
};

/// Meaning of a unit, or nothing if it is unknown.
std::optional<Unit> parse_unit(std::string_view text);

/// Unit that a key's ending stands for: "kg_m3" -> "kg/m3", "m_s2" -> "m/s2", "per_s" -> "1/s", "mm" -> "mm".
std::string unit_of_suffix(std::string_view suffix);

/// Ending of a key for a unit, the inverse of unit_of_suffix: "kg/m3" -> "kg_m3", "1/s" -> "per_s", "1" -> "".
std::string suffix_of_unit(std::string_view unit);

/// Number in SI of a text such as "12 mm"; throws Error(usage) if it is no number with a unit of the dimension of `si_unit`.
double quantity(std::string_view text, std::string_view si_unit, const std::string& where);

}  // namespace snag
