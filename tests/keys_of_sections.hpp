#pragma once
// Whether the manual has every key that a reader read.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/case_file.hpp"

namespace snag {

/// Keys of a file that has been read, "[table] key", which no section declares. Tables with free keys are left out.
inline std::vector<std::string> keys_without_section(const CaseFile& file, const std::vector<Section>& sections,
                                                     const std::vector<std::string>& free_tables = {}) {
  std::vector<std::string> missing;
  std::istringstream lines(file.resolved());
  std::string line, table;
  while (std::getline(lines, line)) {
    if (line.starts_with('[')) {  // [table] or [[table]]
      const std::size_t first = line.find_first_not_of('[');
      table = line.substr(first, line.find(']') - first);
      continue;
    }
    const std::size_t equals = line.find(" = ");
    if (line.starts_with('#') || equals == std::string::npos) continue;
    if (std::find(free_tables.begin(), free_tables.end(), table) != free_tables.end()) continue;
    const std::string key = line.substr(0, equals);
    const bool declared = std::any_of(sections.begin(), sections.end(), [&](const Section& section) {
      return section.name == table && std::any_of(section.parameters.begin(), section.parameters.end(),
                                                  [&](const Parameter& parameter) { return key_with_unit(parameter) == key; });
    });
    if (!declared) missing.push_back("[" + table + "] " + key);
  }
  return missing;
}

}  // namespace snag
