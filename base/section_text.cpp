#include "base/section_text.hpp"

#include <regex>
#include <sstream>

#include "base/parameter_text.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

std::string number(double value) {
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

std::string default_text(const Parameter& p) {
  const std::string text = toml_text(p.target, number);
  return text.empty() || text == "nan" ? "automatic" : text;
}

std::string range(const Parameter& p) {
  const bool low = p.minimum > -infinity, high = p.maximum < infinity;
  std::string words;
  if (!p.choices.empty()) words = "[" + joined(p.choices) + "]";
  if (!low && !high) return words;
  constexpr double positive = 1e-12;  // a minimum that stands for "positive"
  const bool is_positive = low && !high && p.minimum > 0 && p.minimum <= positive;
  const std::string numbers = is_positive ? "> 0" : (low ? number(p.minimum) : "") + " ... " + (high ? number(p.maximum) : "");
  return words.empty() ? numbers : numbers + ", or " + words;
}

}  // namespace

std::string section_text(const Section& section) {
  // Several models share a table; the meaning begins with the value that chooses one, such as kind = "wall", which is part of the heading.
  std::smatch model;
  const bool chosen = std::regex_match(section.meaning, model, std::regex("(\\w+ = \"\\w+\"): ([^]*)"));
  std::string text = "## `" + std::string(section.repeated ? "[[" : "[") + section.name + (section.repeated ? "]]" : "]") + "`" +
                     (chosen ? " " + model.str(1) : "") + "\n\n" + (chosen ? model.str(2) : section.meaning) + "\n\n";
  if (section.parameters.empty()) return text;
  text += "| key | unit | default | range | basis | meaning |\n|---|---|---|---|---|---|\n";
  for (const Parameter& p : section.parameters) {
    text += "| `" + key_with_unit(p) + "` | " + (p.unit == "1" ? "" : p.unit) + " | " +
            (p.required ? std::string("required") : "`" + default_text(p) + "`") + " | " + range(p) + " | " +
            (p.unit.empty() ? "" : name(p.basis)) + " | " + p.meaning + " |\n";
  }
  return text + "\n";
}

}  // namespace snag
