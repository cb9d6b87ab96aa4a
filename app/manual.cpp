#include "app/manual.hpp"

#include <sstream>

#include "app/sections.hpp"

namespace snag {

namespace {

std::string number(double value) {
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

std::string list(const Vec3& v) { return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]"; }

template <class Range, class Print>
std::string list(const Range& range, Print print) {
  std::string text = "[";
  for (const auto& element : range) text += (text.size() > 1 ? ", " : "") + print(element);
  return text + "]";
}

struct Default {
  std::string operator()(const double* v) const { return number(*v); }
  std::string operator()(const std::optional<double>* v) const { return *v ? number(**v) : "chosen"; }
  std::string operator()(const int* v) const { return std::to_string(*v); }
  std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
  std::string operator()(const std::string* v) const { return "\"" + *v + "\""; }
  std::string operator()(const Vec3* v) const { return list(*v); }
  std::string operator()(const Mat3* v) const {
    return list(*v, [](const Vec3& row) { return list(row); });
  }
  std::string operator()(const std::vector<double>* v) const { return list(*v, number); }
  std::string operator()(const std::vector<Vec3>* v) const {
    return list(*v, [](const Vec3& x) { return list(x); });
  }
  std::string operator()(const std::vector<std::string>* v) const {
    return list(*v, [](const std::string& x) { return "\"" + x + "\""; });
  }
};

std::string range(const Parameter& p) {
  if (!p.choices.empty()) return list(p.choices, [](const std::string& word) { return word; });
  const bool low = p.minimum > -infinity, high = p.maximum < infinity;
  if (!low && !high) return "";
  return (low ? number(p.minimum) : "") + " ... " + (high ? number(p.maximum) : "");
}

}  // namespace

std::string section_text(const Section& section) {
  std::string text = "## `" + std::string(section.repeated ? "[[" : "[") + section.name + (section.repeated ? "]]" : "]") + "`\n\n" +
                     section.meaning + "\n\n";
  if (section.parameters.empty()) return text;
  text += "| key | unit | default | range | basis | meaning |\n|---|---|---|---|---|---|\n";
  for (const Parameter& p : section.parameters) {
    text += "| `" + key_with_unit(p) + "` | " + (p.unit == "1" ? "" : p.unit) + " | " +
            (p.required ? std::string("required") : "`" + std::visit(Default{}, p.target) + "`") + " | " + range(p) + " | " +
            (p.unit.empty() ? "" : name(p.basis)) + " | " + p.meaning + " |\n";
  }
  return text + "\n";
}

std::string case_file_manual() {
  std::string text =
      "# The case file\n\n"
      "Written by `snag manual`; a test compares it with the program.\n\n"
      "TOML. A number with a unit is written either with the unit in the key (`density_kg_m3 = 998`, `speed_rpm = 1200`) or in the value\n"
      "(`density = \"998 kg/m3\"`); dimensionless numbers take the bare key. `--set section.key=value` replaces a value from the command "
      "line\n"
      "(`--set rag.0.radius_mm=1.5` for the first of several `[[rag]]`). Unknown keys are errors. The case as it was read, with all "
      "defaults,\n"
      "is written to `case.resolved.toml` in the output folder.\n\n";
  AllSections all;
  for (const Section& section : all.list()) text += section_text(section);
  return text;
}

}  // namespace snag
