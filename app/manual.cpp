#include "app/manual.hpp"

#include <algorithm>

#include "base/case_tables.hpp"
#include "base/section_text.hpp"
#include "base/split_keys.hpp"
#include "diagnosis/data/experiment.hpp"
#include "observe/camera.hpp"
#include "simulation/setup/mesh_generator.hpp"
#include "simulation/study.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

namespace {

/// Rows of the table of former names, each once: the tables of rags share their keys.
void add_former_names(const Section& section, std::vector<std::string>& rows) {
  const auto add = [&](const std::string& former, const std::string& present) {
    const std::string row = "| `" + former + "` | `" + present + "` |\n";
    if (std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(row);
  };
  if (!section.former_name.empty()) add("[" + section.former_name + "]", "[" + section.name + "]");
  for (const Parameter& p : section.parameters) {
    const std::string table = "[" + section.name + "] ";
    const std::string former = p.former.key.empty() ? p.key : p.former.key;
    if (p.former.values.empty() && former != p.key) add(table + former, table + p.key);
    for (const auto& [before, now] : p.former.values) add(table + former + " = " + before, table + p.key + " = " + now);
  }
}

}  // namespace

std::string case_file_manual() {
  std::string text =
      "# The case file\n\n"
      "Written by `snag manual`; a test compares it with the program.\n\n"
      "TOML. A number with a unit is written either with the unit in the key (`density_kg_m3 = 998`, `rotation_speed_rpm = 1200`) or in "
      "the value\n"
      "(`density = \"998 kg/m3\"`); dimensionless numbers take the bare key. `--set section.key=value` replaces a value from the command "
      "line\n"
      "(`--set rag.0.radius_mm=1.5` for the first of several `[[rag]]`). Unknown keys are errors. The case as it was read, with all "
      "defaults,\n"
      "is written to `case.resolved.toml` in the output folder.\n\n";
  std::vector<std::string> former_names;
  const auto add = [&](const Section& section) {
    text += section_text(section);
    add_former_names(section, former_names);
  };
  const CaseTables all;
  for (const Section& section : all.sections()) add(section);
  text +=
      "# The study file\n\n"
      "A file of its own for `snag study`: a case, what varies, what is kept of each run.\n\n";
  for (const Section& section : study_sections()) add(section);
  text +=
      "# The experiment file\n\n"
      "A file of its own for `snag diagnose`: what was measured, the cases that simulate it, which effects are examined.\n\n";
  for (const Section& section : experiment_sections()) add(section);
  text +=
      "# The camera file\n\n"
      "A file of its own for `snag observe --camera`: how pixels and metres belong together, what counts as cloth, where the pump is.\n\n";
  Camera camera;
  for (const Section& section : camera.sections()) add(section);
  VoluteView volute;
  add(volute.section());
  text +=
      "# The textile tests file\n\n"
      "A file of its own for `snag calibrate`: what a laboratory measured on a cloth, lengthwise (LW) and crosswise (CW).\n\n";
  for (const Section& section : textile_tests_sections()) add(section);
  text +=
      "# Parameters of a mesh\n\n"
      "A file of its own for `snag mesh GEOMETRY PARAMS.toml`, and for `[mesh] parameters` of a case: one table with the name of the "
      "geometry.\nOn the command line, `--set key=value` replaces a value.\n\n" +
      geometry_tables();
  text +=
      "# Former names\n\n"
      "These names of earlier versions are read until 1.0, each with a warning that names the line. `case.resolved.toml` has the present "
      "names.\nThe hash of a case is the same with either name.\n\n"
      "| former name | name |\n|---|---|\n";
  for (const SplitKey& key : split_keys())
    former_names.push_back("| `[" + std::string(key.table) + "] " + key.former + "` | `[" + key.table + "]` `" + key.present_names() +
                           "`: both |\n");
  for (const std::string& row : former_names) text += row;
  return text;
}

}  // namespace snag
