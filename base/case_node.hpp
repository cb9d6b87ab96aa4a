#pragma once
// The tree of a case file while it is read. For .cpp files of this folder only.
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "base/parameter.hpp"

namespace snag {

/// A parameter that had another name, or values of other names, without its target.
struct RenamedKey {
  std::string key, unit;
  FormerName former;
};

/// The tree of a case file: tables by name, other values as TOML holds them. Reading marks what was used and
/// stores what was made of it.
struct CaseNode {
  std::string name;        // "rag", "" for the root
  std::string first_name;  // the same with the first names of renamed tables
  std::string file;        // for messages
  int line = 0;
  bool present = false;
  bool of_list = false;         // written as [[name]]
  bool presence_asked = false;  // the program asks whether this table is given
  std::map<std::string, std::vector<std::unique_ptr<CaseNode>>> tables;
  struct Value {
    std::shared_ptr<toml::node> node;
    int line;  // of the file; TOML's own copies forget it
  };
  std::map<std::string, Value> values;
  std::set<std::string> used;                        // keys of `values` that were read
  std::vector<std::string> known;                    // keys that reading asked for
  std::vector<RenamedKey> renamed_keys;              // that reading asked for
  std::map<std::string, std::string> former_tables;  // present name -> former name
  std::vector<std::string> notes;                    // of the root: the former names that the file uses, a line each
  struct Resolved {
    std::string key, value;  // as TOML; a file with its whole path
    std::string first_key;   // what the key was called first
    std::string identity;    // what the fingerprint takes for the value: of a file its content, wherever it lies; empty for a default
    std::string fixed;       // the same, empty where a resumed run may have another value
  };
  std::vector<Resolved> resolved;        // in the order of reading
  std::vector<std::string> table_order;  // of reading
  std::set<std::string> repeated;        // tables that are written as [[name]]

  void note_read(const std::string& table) {
    if (std::find(table_order.begin(), table_order.end(), table) == table_order.end()) table_order.push_back(table);
  }
  std::string where() const { return file + (line > 0 ? ":" + std::to_string(line) : "") + (name.empty() ? "" : ": [" + name + "]"); }
};

inline constexpr int line_of_override = 0;

/// Puts what a file holds, or an override, into a node: a value or tables, with their lines.
void put(CaseNode& node, const std::string& key, const toml::node& value, bool is_override);

/// Where a value stands, for messages: "case.toml:12", "case.toml, --set".
inline std::string place_of(const std::string& file, int line) {
  return line == line_of_override ? (file == "--set" ? file : file + ", --set") : file + ":" + std::to_string(line);
}

/// Whether the elements are the tables of [[name]].
inline bool is_table_array(const toml::array& array) {
  return !array.empty() && std::all_of(array.begin(), array.end(), [](const toml::node& n) { return n.is_table(); });
}

}  // namespace snag
