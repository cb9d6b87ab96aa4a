#include "base/case_file.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <set>

#include <toml++/toml.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/parameter_reading.hpp"
#include "base/parameter_text.hpp"
#include "base/quotation.hpp"
#include "base/sha256.hpp"
#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

// The tree of a case file: tables by name, other values as TOML holds them. Reading marks what was used and keeps what was made of it.
struct CaseNode {
  std::string name;  // "rag", "" for the root
  std::string file;  // for messages
  int line = 0;
  bool present = false;
  bool presence_asked = false;  // the program asks whether this table is given
  std::map<std::string, std::vector<std::unique_ptr<CaseNode>>> tables;
  struct Value {
    std::shared_ptr<toml::node> node;
    int line;  // of the file; TOML's own copies forget it
  };
  std::map<std::string, Value> values;
  std::set<std::string> used;      // keys of `values` that were read
  std::vector<std::string> known;  // keys that reading asked for
  struct Resolved {
    std::string key, value;  // as TOML; a file with its whole path
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

namespace {

constexpr int line_of_override = 0;

std::string place_of(const std::string& file, int line) {
  return line == line_of_override ? (file == "--set" ? file : file + ", --set") : file + ":" + std::to_string(line);
}

std::filesystem::path beside(const std::filesystem::path& case_file, const std::string& relative) {
  const std::filesystem::path given(relative);
  return given.is_absolute() ? given : case_file.parent_path() / given;
}

CaseNode::Resolved resolved_entry(const std::string& key, const Parameter& parameter, const std::string& at_default,
                                  const std::string& case_file) {
  const std::string text = toml_text(parameter.target);
  const auto* file = std::get_if<std::string*>(&parameter.target);
  if (!parameter.is_file || !file || (*file)->empty()) return {key, text, text == at_default ? "" : text, parameter.may_move ? "" : text};
  const auto path = std::filesystem::absolute(beside(case_file, **file)).lexically_normal();
  const auto content = file_text(path);
  const std::string identity = content ? snag::sha256(*content) : text;
  return {key, toml_text(path.string()), identity, identity};
}

bool is_table_array(const toml::array& array) {
  return !array.empty() && std::all_of(array.begin(), array.end(), [](const toml::node& n) { return n.is_table(); });
}

void fill(CaseNode& node, const toml::table& table) {
  node.present = true;
  if (node.line == 0) node.line = static_cast<int>(table.source().begin.line);
  for (auto&& entry : table) {
    const std::string key(entry.first.str());
    const toml::node& value = entry.second;
    const auto child = [&](const toml::table& sub) {
      auto made = std::make_unique<CaseNode>();
      made->name = node.name.empty() ? key : node.name + "." + key;
      made->file = node.file;
      fill(*made, sub);
      node.tables[key].push_back(std::move(made));
    };
    if (const auto* sub = value.as_table()) {
      child(*sub);
    } else if (const auto* array = value.as_array(); array && is_table_array(*array)) {
      for (const toml::node& element : *array) child(*element.as_table());
    } else {
      value.visit([&](const auto& concrete) {
        node.values[key] = {std::make_shared<std::remove_cvref_t<decltype(concrete)>>(concrete),
                            static_cast<int>(value.source().begin.line)};
      });
    }
  }
}

// Override "a.b.0.key=value": the value is TOML, or a bare word taken as text.
void apply_override(toml::table& root, const std::string& text) {
  const auto equals = text.find('=');
  const auto fail = [&](const std::string& why) {
    return Error(ExitCode::usage, "--set " + shortened(text) + ": " + why + "; write section.key=value, for instance --set time.end_s=0.1");
  };
  if (equals == std::string::npos || equals == 0) throw fail(equals == 0 ? "names no key" : "has no \"=\"");
  const std::string path = text.substr(0, equals), value = text.substr(equals + 1);
  toml::table parsed;
  try {
    parsed = toml::parse("v = " + value);
  } catch (const toml::parse_error&) {
    std::string quoted;
    for (const char c : value) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    try {
      parsed = toml::parse("v = \"" + quoted + "\"");
    } catch (const toml::parse_error&) {
      throw fail("has a value that is no TOML");
    }
  }
  const std::vector<std::string> steps = split(path, '.');
  toml::node* at = &root;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string& step = steps[i];
    const bool last = i + 1 == steps.size();
    if (auto* array = at->as_array()) {
      std::size_t index = 0;
      const auto [end, code] = std::from_chars(step.data(), step.data() + step.size(), index);
      if (code != std::errc() || end != step.data() + step.size() || index >= array->size())
        throw fail("\"" + shortened(step) + "\" is no index of the " + std::to_string(array->size()) + " tables there");
      at = array->get(index);
      if (last) throw fail("names a table, not a key");
      continue;
    }
    auto* table = at->as_table();
    if (!table) throw fail("\"" + steps[i - 1] + "\" is a value, not a table");
    if (last) {
      const toml::node* before = table->get(step);
      if (before && (before->is_table() || (before->is_array() && is_table_array(*before->as_array()))))
        throw fail("names a section, not a key");
      table->insert_or_assign(step, *parsed.get("v"));
    } else {
      if (!table->contains(step)) table->insert(step, toml::table{});
      at = table->get(step);
      // [[rag]] with a single element may be addressed without its index.
      if (auto* array = at->as_array();
          array && array->size() == 1 && (steps[i + 1].empty() || !std::isdigit(static_cast<unsigned char>(steps[i + 1][0]))))
        at = array->get(0);
    }
  }
}

// Unit that a key of the file carries for this parameter: "" for the bare key, nothing if the key is another one.
std::optional<std::string> unit_in_key(const std::string& key, const Parameter& parameter) {
  if (key == parameter.key) return "";
  if (parameter.unit.empty() || !key.starts_with(parameter.key + "_")) return {};
  const std::string suffix = key.substr(parameter.key.size() + 1);
  // "m_s" is m/s but "Pa_s" is Pa s: the dimension decides.
  std::string product = suffix;
  std::replace(product.begin(), product.end(), '_', ' ');
  for (const std::string& unit : {unit_of_suffix(suffix), product}) {
    const auto parsed = parse_unit(unit);
    if (parsed && parsed->exponents == parse_unit(parameter.unit)->exponents) return unit;
  }
  return {};
}

std::string known_spelling(const Parameter& parameter) { return parameter.unit.empty() ? parameter.key : key_with_unit(parameter); }

void reject_unread_in(const CaseNode& node) {
  for (const auto& [key, value] : node.values) {
    if (node.used.contains(key)) continue;
    const std::string where = place_of(node.file, value.line);
    if (node.name.empty()) {
      const bool section = std::find(node.table_order.begin(), node.table_order.end(), key) != node.table_order.end();
      throw Error(ExitCode::usage, where + ": \"" + shortened(key) + "\" stands outside of all sections" +
                                       (section ? ", but is the name of one; write [" + key + "] and keys below it"
                                                : "; put it below one of the sections " + joined(node.table_order)));
    }
    std::string message = where + ": [" + node.name + "]: unknown key \"" + shortened(key) + "\"";
    const std::string near = nearest_name(key, node.known);
    if (!near.empty()) message += "; did you mean \"" + near + "\"?";
    message += node.known.empty() ? "; no key is read here" : "; known keys: " + joined(node.known);
    for (const std::string& known : node.known) {
      if (key.starts_with(known + "_"))
        message += " (the ending \"" + shortened(key.substr(known.size() + 1)) + "\" is no unit of " + known + ")";
    }
    throw Error(ExitCode::usage, message);
  }
  for (const auto& [key, list] : node.tables) {
    const bool read = std::find(node.table_order.begin(), node.table_order.end(), key) != node.table_order.end();
    for (const auto& child : list) {
      if (!read) {
        const std::string near = nearest_name(key, node.table_order);
        throw Error(ExitCode::usage, place_of(child->file, child->line) + ": unknown section [" + shortened(child->name) + "]" +
                                         (near.empty() ? "" : "; did you mean [" + near + "]?") +
                                         "; known sections: " + joined(node.table_order));
      }
      reject_unread_in(*child);
    }
  }
}

void write_resolved(const CaseNode& node, bool repeated, std::string CaseNode::Resolved::*shown, std::string& out) {
  const bool any =
      std::any_of(node.resolved.begin(), node.resolved.end(), [&](const CaseNode::Resolved& entry) { return !(entry.*shown).empty(); });
  if (!node.name.empty() && (any || repeated || (node.present && node.presence_asked)))
    out += (repeated ? "\n[[" + node.name + "]]\n" : "\n[" + node.name + "]\n");
  for (const CaseNode::Resolved& entry : node.resolved)
    if (!(entry.*shown).empty()) out += entry.key + " = " + entry.*shown + "\n";
  for (const std::string& key : node.table_order) {
    const auto found = node.tables.find(key);
    if (found == node.tables.end()) continue;
    for (const auto& child : found->second) {
      const bool empty = child->resolved.empty() && child->table_order.empty();
      if (!empty) write_resolved(*child, node.repeated.contains(key), shown, out);
    }
  }
}

}  // namespace

bool Table::present() const {
  node_->presence_asked = true;
  return node_->present;
}

bool Table::has(std::string_view key) const {
  const std::string name(key);
  if (node_->values.contains(name)) return true;
  const auto sub = node_->tables.find(name);
  if (sub != node_->tables.end()) {
    sub->second.front()->presence_asked = true;
    if (sub->second.front()->present) return true;
  }
  return std::any_of(node_->values.begin(), node_->values.end(), [&](const auto& entry) {
    return entry.first.starts_with(name + "_") && parse_unit(unit_of_suffix(entry.first.substr(name.size() + 1)));
  });
}

Table Table::table(const std::string& name) const {
  auto& list = node_->tables[name];
  if (list.size() > 1) throw Error(ExitCode::usage, list[1]->where() + " stands more than once; write one [" + list[1]->name + "]");
  if (list.empty()) {
    list.push_back(std::make_unique<CaseNode>());
    list.front()->name = node_->name.empty() ? name : node_->name + "." + name;
    list.front()->file = node_->file;
  }
  node_->note_read(name);
  return {root_, list.front().get()};
}

std::vector<Table> Table::tables(const std::string& name) const {
  node_->note_read(name);
  node_->repeated.insert(name);
  std::vector<Table> all;
  const auto found = node_->tables.find(name);
  if (found == node_->tables.end()) return all;
  for (const auto& child : found->second) all.push_back({root_, child.get()});
  return all;
}

void Table::read(const std::vector<Parameter>& parameters) const {
  for (const Parameter& parameter : parameters) {
    // A table may be read more than once (a condition for several patches): what was made of it counts once.
    const bool again = std::find(node_->known.begin(), node_->known.end(), known_spelling(parameter)) != node_->known.end();
    if (!again) node_->known.push_back(known_spelling(parameter));
    // An override replaces the value of the file, whatever the unit in the key of either.
    const bool overridden = std::any_of(node_->values.begin(), node_->values.end(), [&](const auto& entry) {
      return entry.second.line == line_of_override && unit_in_key(entry.first, parameter);
    });
    const std::string at_default = parameter.required ? "" : toml_text(parameter.target);
    std::string found_key;
    for (const auto& [key, value] : node_->values) {
      const auto unit = unit_in_key(key, parameter);
      if (!unit) continue;
      if (overridden && value.line != line_of_override) {
        node_->used.insert(key);
        continue;
      }
      const std::string where = place_of(node_->file, value.line) + ": [" + node_->name + "] " + key;
      if (!found_key.empty())
        throw Error(ExitCode::usage, where + " is given twice, as " + found_key + " and " + key + "; keep one of them");
      found_key = key;
      node_->used.insert(key);
      read_parameter(parameter, *unit, *value.node, where);
    }
    if (found_key.empty() && parameter.required)
      throw Error(ExitCode::usage, node_->where() + ": missing key \"" + known_spelling(parameter) + "\": " + parameter.meaning);
    if (again) continue;
    auto entry = resolved_entry(known_spelling(parameter), parameter, at_default, node_->file);
    if (!entry.value.empty()) node_->resolved.push_back(std::move(entry));
  }
}

std::vector<std::pair<std::string, double>> Table::numbers() const {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& [key, value] : node_->values) {
    const auto number = value.node->value<double>();
    if (!number) throw Error(ExitCode::usage, node_->where() + " " + key + " must be a number");
    node_->used.insert(key);
    node_->resolved.push_back({toml_text(key), toml_text(*number), toml_text(*number), toml_text(*number)});
    all.emplace_back(key, *number);
  }
  return all;
}

std::string Table::resolved() const {
  std::string out;
  write_resolved(*node_, false, &CaseNode::Resolved::identity, out);
  return out;
}

std::string Table::where() const { return node_->where(); }

CaseFile CaseFile::read(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  const auto text = file_text(path);
  if (!text) throw Error(ExitCode::io, path.string() + ": the case file cannot be read; check the path");
  CaseFile made = parse(*text, path.string(), overrides);
  made.file_ = path;
  return made;
}

CaseFile CaseFile::parse(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  CaseFile made;
  made.root_ = std::make_shared<CaseNode>();
  made.root_->file = name;
  try {
    toml::table table = toml::parse(text, name);
    for (const std::string& override_text : overrides) apply_override(table, override_text);
    fill(*made.root_, table);
    made.root_->line = 0;
  } catch (const toml::parse_error& failure) {
    throw Error(ExitCode::usage,
                name + ":" + std::to_string(failure.source().begin.line) + ": no valid TOML: " + shortened(failure.description()));
  }
  return made;
}

Table CaseFile::root() const { return {root_, root_.get()}; }

void CaseFile::reject_unread() const { reject_unread_in(*root_); }

std::string CaseFile::resolved() const {
  std::string out = "# The case as it was read, with all defaults, in SI units.\n";
  write_resolved(*root_, false, &CaseNode::Resolved::value, out);
  return out;
}

std::string CaseFile::sha256() const {
  std::string text;
  write_resolved(*root_, false, &CaseNode::Resolved::identity, text);
  return snag::sha256(text);
}

std::string CaseFile::resume_sha256() const {
  std::string text;
  write_resolved(*root_, false, &CaseNode::Resolved::fixed, text);
  return snag::sha256(text);
}

std::filesystem::path CaseFile::path(const std::string& relative) const { return beside(file_, relative); }

}  // namespace snag
