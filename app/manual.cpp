#include "app/manual.hpp"

#include <sstream>

#include "base/parameter_text.hpp"
#include "base/words.hpp"
#include "observe/camera.hpp"
#include "simulation/setup/sections.hpp"
#include "simulation/study.hpp"

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
  return text.empty() ? "chosen" : text;
}

std::string range(const Parameter& p) {
  if (!p.choices.empty()) return "[" + joined(p.choices) + "]";
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
            (p.required ? std::string("required") : "`" + default_text(p) + "`") + " | " + range(p) + " | " +
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
  text +=
      "# The study file\n\n"
      "A file of its own for `snag study`: a case, what varies, what is kept of each run.\n\n";
  for (const Section& section : study_sections()) text += section_text(section);
  text +=
      "# The camera file\n\n"
      "A file of its own for `snag observe --camera`: how pixels and metres belong together, what counts as cloth, where the pump is.\n\n";
  Camera camera;
  for (const Section& section : camera.sections()) text += section_text(section);
  VoluteView volute;
  text += section_text(volute.section());
  return text;
}

}  // namespace snag
