#include "base/known_key.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/key_names.hpp"
#include "base/quotation.hpp"
#include "base/split_keys.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

bool is_index(const std::string& step) {
  return !step.empty() && std::all_of(step.begin(), step.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The table of its own that a name such as "coupling.lift" or "rag.cut" ends with.
std::string last_step(const std::string& table) { return table.substr(table.rfind('.') + 1); }

}  // namespace

void check_override_key(const std::string& override_text, const std::string& where) {
  std::vector<std::string> steps = split(override_text.substr(0, override_text.find('=')), '.');
  std::erase_if(steps, is_index);
  const std::string key = steps.empty() ? "" : steps.back();
  std::string table;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) table += (i > 0 ? "." : "") + steps[i];
  const CaseTables all;
  std::vector<std::string> tables, keys;
  for (const Section& section : all.sections()) {
    const bool nested = steps.size() > 2 && section.name.find('.') != std::string::npos;
    const bool is_it = nested ? last_step(section.name) == last_step(table) : section.name == table || section.former_name == table;
    tables.push_back(section.name);
    if (!is_it) continue;
    for (const Parameter& parameter : section.parameters) {
      if (match(key, parameter)) return;
      keys.push_back(key_with_unit(parameter));
    }
  }
  for (const SplitKey& split_key : split_keys())
    if (table == split_key.table && key == split_key.former) return;
  std::sort(tables.begin(), tables.end());
  tables.erase(std::unique(tables.begin(), tables.end()), tables.end());
  const bool no_table = keys.empty();
  const std::vector<std::string>& known = no_table ? tables : keys;
  const std::string& word = no_table ? table : key;
  const std::string near = nearest_name(word, known);
  throw Error(ExitCode::usage, where + " \"" + shortened(override_text) + "\": unknown " + (no_table ? "section" : "key") + " \"" +
                                   shortened(word) + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?") + "; known are " +
                                   joined(known));
}

}  // namespace snag
