#include "base/units.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

const std::map<std::string, Unit, std::less<>>& named_units() {
  constexpr double pi = std::numbers::pi;
  static const std::map<std::string, Unit, std::less<>> units = {
      {"1", {1, {0, 0, 0}}},        {"%", {0.01, {0, 0, 0}}},
      {"kg", {1, {1, 0, 0}}},       {"g", {1e-3, {1, 0, 0}}},
      {"mg", {1e-6, {1, 0, 0}}},    {"t", {1e3, {1, 0, 0}}},
      {"m", {1, {0, 1, 0}}},        {"mm", {1e-3, {0, 1, 0}}},
      {"cm", {1e-2, {0, 1, 0}}},    {"um", {1e-6, {0, 1, 0}}},
      {"km", {1e3, {0, 1, 0}}},     {"L", {1e-3, {0, 3, 0}}},
      {"l", {1e-3, {0, 3, 0}}},     {"mL", {1e-6, {0, 3, 0}}},
      {"s", {1, {0, 0, 1}}},        {"ms", {1e-3, {0, 0, 1}}},
      {"us", {1e-6, {0, 0, 1}}},    {"min", {60, {0, 0, 1}}},
      {"h", {3600, {0, 0, 1}}},     {"Hz", {1, {0, 0, -1}}},
      {"kHz", {1e3, {0, 0, -1}}},   {"rpm", {2 * pi / 60, {0, 0, -1}}},
      {"rad", {1, {0, 0, 0}}},      {"deg", {pi / 180, {0, 0, 0}}},
      {"rev", {2 * pi, {0, 0, 0}}}, {"N", {1, {1, 1, -2}}},
      {"mN", {1e-3, {1, 1, -2}}},   {"kN", {1e3, {1, 1, -2}}},
      {"Nm", {1, {1, 2, -2}}},      {"Pa", {1, {1, -1, -2}}},
      {"kPa", {1e3, {1, -1, -2}}},  {"MPa", {1e6, {1, -1, -2}}},
      {"GPa", {1e9, {1, -1, -2}}},  {"bar", {1e5, {1, -1, -2}}},
      {"mbar", {1e2, {1, -1, -2}}}, {"J", {1, {1, 2, -2}}},
      {"W", {1, {1, 2, -3}}},       {"kW", {1e3, {1, 2, -3}}},
      {"GB", {1e9, {0, 0, 0}}},     {"MB", {1e6, {0, 0, 0}}},
  };
  return units;
}

// One factor of a unit: a name, then perhaps ^ and an integer, or the integer alone ("m2").
std::optional<Unit> parse_factor(std::string_view text) {
  int exponent = 1;
  const auto& units = named_units();
  auto found = units.find(text);
  if (found == units.end()) {
    std::size_t letters = text.size();
    while (letters > 0 && std::isdigit(static_cast<unsigned char>(text[letters - 1]))) --letters;
    if (letters == text.size() || letters == 0) return {};
    std::size_t sign = letters;
    if (text[sign - 1] == '-' && sign > 1) --sign;
    std::size_t end = sign;
    if (text[end - 1] == '^' && end > 1) --end;
    std::from_chars(text.data() + sign, text.data() + text.size(), exponent);
    found = units.find(text.substr(0, end));
    if (found == units.end()) return {};
  }
  Unit unit = found->second;
  unit.factor = std::pow(unit.factor, exponent);
  for (int& e : unit.exponents) e *= exponent;
  return unit;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trimmed(text);
  Unit unit;
  if (text.empty()) return unit;
  int direction = 1;
  std::string factor;
  const auto finish = [&] {
    if (factor.empty()) return true;
    const auto parsed = parse_factor(factor);
    factor.clear();
    if (!parsed) return false;
    unit.factor *= std::pow(parsed->factor, direction);
    for (int i = 0; i < 3; ++i) unit.exponents[i] += direction * parsed->exponents[i];
    return true;
  };
  for (const char c : text) {
    if (c == '/') {
      if (!finish() || direction < 0) return {};  // a/b/c is ambiguous
      direction = -1;
    } else if (c == '(' || c == ')') {
      continue;  // kg/(m3 s): everything after the bar is below it anyway
    } else if (c == '*' || std::isspace(static_cast<unsigned char>(c))) {
      if (!finish()) return {};
    } else {
      factor += c;
    }
  }
  if (!finish()) return {};
  return unit;
}

std::string unit_of_suffix(std::string_view suffix) {
  std::string numerator, denominator;
  bool below = false;
  for (const std::string& token : split(suffix, '_')) {
    if (token == "per") {
      below = true;
      continue;
    }
    std::string& part = below || !numerator.empty() ? denominator : numerator;
    part += (part.empty() ? "" : " ") + token;
  }
  if (numerator.empty()) numerator = "1";
  return denominator.empty() ? numerator
                             : numerator + "/" + (denominator.find(' ') == std::string::npos ? denominator : "(" + denominator + ")");
}

std::string suffix_of_unit(std::string_view unit) {
  if (unit == "1" || unit.empty()) return "";
  if (unit == "N m") return "Nm";
  std::string suffix;
  if (unit.substr(0, 2) == "1/") {
    suffix = "per_";
    unit.remove_prefix(2);
  }
  for (const char c : unit) {
    if (c == '/' || c == ' ')
      suffix += '_';
    else if (c != '(' && c != ')' && c != '^')
      suffix += c;
  }
  return suffix;
}

double quantity(std::string_view text, std::string_view si_unit, const std::string& where) {
  const std::string_view body = trimmed(text);
  const auto fail = [&](const std::string& why) {
    return Error(ExitCode::usage, where + ": \"" + shortened(text) + "\" " + why + "; write a number and a unit of " +
                                      std::string(si_unit) + ", for instance \"1 " + std::string(si_unit) + "\"");
  };
  double value = 0;
  const char* begin = body.data() + (body.starts_with('+') ? 1 : 0);
  const auto [end, code] = std::from_chars(begin, body.data() + body.size(), value);
  if (code != std::errc() || !std::isfinite(value)) throw fail("is not a number with a unit");
  const std::string_view unit_text = trimmed(body.substr(end - body.data()));
  const auto unit = parse_unit(unit_text);
  if (!unit) throw fail("has the unknown unit \"" + shortened(unit_text) + "\"");
  if (unit->exponents != parse_unit(si_unit)->exponents || (unit_text.empty() && si_unit != "1"))
    throw fail("has the wrong unit \"" + shortened(unit_text) + "\"");
  return value * unit->factor;
}

}  // namespace snag
