#include "base/parameter_text.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

#include <toml++/toml.h>

namespace snag {

namespace {

template <class Range, class Print>
std::string list_text(const Range& range, Print print) {
  std::string text = "[";
  for (const auto& element : range) text += (text.size() > 1 ? ", " : "") + print(element);
  return text + "]";
}

struct Printer {
  const std::function<std::string(double)>& number;

  std::string operator()(const double* v) const { return number(*v); }
  std::string operator()(const std::optional<double>* v) const { return *v ? number(**v) : ""; }
  std::string operator()(const int* v) const { return std::to_string(*v); }
  std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
  std::string operator()(const std::string* v) const { return toml_text(*v); }
  std::string operator()(const AnyChoice* v) const { return toml_text(v->word()); }
  std::string operator()(const Vec3* v) const { return list(*v); }
  std::string operator()(const Mat3* v) const {
    return list_text(*v, [this](const Vec3& row) { return list(row); });
  }
  std::string operator()(const std::vector<double>* v) const { return list_text(*v, number); }
  std::string operator()(const std::vector<Vec3>* v) const {
    return list_text(*v, [this](const Vec3& x) { return list(x); });
  }
  std::string operator()(const std::vector<std::string>* v) const {
    return list_text(*v, [](const std::string& text) { return toml_text(text); });
  }
  std::string list(const Vec3& v) const { return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]"; }
};

std::string exact(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, value);
  std::string text(buffer, end);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::string toml_text(double value) { return exact(value); }

std::string toml_text(const Vec3& value) { return "[" + exact(value.x) + ", " + exact(value.y) + ", " + exact(value.z) + "]"; }

std::string toml_text(const std::string& value) {
  std::ostringstream out;
  const toml::value<std::string> text(value);
  out << toml::toml_formatter(text, toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings);
  return out.str();
}

std::string toml_text(const ParameterTarget& target, const std::function<std::string(double)>& number) {
  return std::visit(Printer{number}, target);
}

std::string toml_text(const ParameterTarget& target) { return toml_text(target, exact); }

}  // namespace snag
