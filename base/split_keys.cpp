#include "base/split_keys.hpp"

#include "base/case_file.hpp"
#include "base/case_node.hpp"
#include "base/log.hpp"

namespace snag {

const std::vector<SplitKey>& split_keys() {
  static const std::vector<SplitKey> keys{{"contact", "between_particles", {"self_contact", "mutual_contact"}}};
  return keys;
}

std::string SplitKey::present_names() const {
  std::string names;
  for (const char* key : present) names += (names.empty() ? "" : " and ") + std::string(key);
  return names;
}

void adopt_split_keys(CaseNode& root) {
  for (const SplitKey& key : split_keys()) {
    const auto tables = root.tables.find(key.table);
    if (tables == root.tables.end()) continue;
    for (const auto& table : tables->second) {
      const auto former = table->values.find(key.former);
      if (former == table->values.end()) continue;
      const CaseNode::Value value = former->second;
      table->values.erase(former);
      for (const char* present : key.present) table->values.insert({present, value});
      const std::string where = place_of(table->file, value.line) + ": [" + table->name + "] ";
      root.notes.push_back(former_name_note(where, key.former, key.present_names()));
      log::warning_once(root.notes.back());
    }
  }
}

}  // namespace snag
