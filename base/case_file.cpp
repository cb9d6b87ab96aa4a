#include "base/case_file.hpp"

#include <toml++/toml.h>
#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/case_node.hpp"
#include "base/case_override.hpp"
#include "base/error.hpp"
#include "base/key_names.hpp"
#include "base/parameter_reading.hpp"
#include "base/parameter_text.hpp"
#include "base/quotation.hpp"
#include "base/sha256.hpp"
#include "base/split_keys.hpp"
#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

std::filesystem::path beside(const std::filesystem::path& case_file, const std::string& relative) {
  const std::filesystem::path given(relative);
  return given.is_absolute() ? given : case_file.parent_path() / given;
}

CaseNode::Resolved resolved_entry(const Parameter& parameter, const std::string& at_default, const std::string& case_file) {
  const std::string key = resolved_key(parameter), first_key = first_resolved_key(parameter);
  const std::string text = toml_text(parameter.target), first = first_value(parameter, text);
  const auto* file = std::get_if<std::string*>(&parameter.target);
  if (!parameter.is_file || !file || (*file)->empty())
    return {key, text, first_key, text == at_default ? "" : first, parameter.may_differ_on_resume ? "" : first};
  const auto path = std::filesystem::absolute(beside(case_file, **file)).lexically_normal();
  const auto content = file_text(path);
  const std::string identity = content ? snag::sha256(*content) : text;
  return {key, toml_text(path.string()), first_key, identity, identity};
}

void fill(CaseNode& node, const toml::table& table, bool is_override) {
  node.present = true;
  if (node.line == 0 && !is_override) node.line = static_cast<int>(table.source().begin.line);
  for (auto&& entry : table) put(node, std::string(entry.first.str()), entry.second, is_override);
}

/// What a file gave, not what was read of it.
std::unique_ptr<CaseNode> copy_of_unread(const CaseNode& node) {
  auto copy = std::make_unique<CaseNode>();
  copy->name = node.name, copy->first_name = node.first_name, copy->file = node.file, copy->line = node.line;
  copy->present = node.present, copy->of_list = node.of_list, copy->values = node.values;
  for (const auto& [key, list] : node.tables)
    for (const auto& child : list) copy->tables[key].push_back(copy_of_unread(*child));
  return copy;
}

void reject_unread_in(const CaseNode& node) {
  for (const auto& [key, value] : node.values) {
    if (node.used.contains(key)) continue;
    const std::string where = place_of(node.file, value.line);
    if (node.name.empty()) {
      const bool section = std::find(node.table_order.begin(), node.table_order.end(), key) != node.table_order.end();
      throw Error(ExitCode::usage, where + ": \"" + shortened(key) + "\" is outside of all sections" +
                                       (section ? ", but is the name of one; write [" + key + "] and keys below it"
                                                : "; put it below one of the sections " + joined(node.table_order)));
    }
    std::string message = where + ": [" + node.name + "]: unknown key \"" + shortened(key) + "\"";
    const std::string near = nearest_name(key, node.known);
    if (!near.empty()) message += "; did you mean \"" + near + "\"?";
    message += node.known.empty() ? "; no key is read here" : "; known keys: " + joined(node.known);
    for (const std::string& known : node.known) {
      if (key.starts_with(known + "_"))
        message += " (the ending \"" + shortened(key.substr(known.size() + 1)) + "\" is not a unit of " + known + ")";
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
  const bool of_today = shown == &CaseNode::Resolved::value;  // a hash takes the first names
  const std::string& name = of_today ? node.name : node.first_name;
  const bool any =
      std::any_of(node.resolved.begin(), node.resolved.end(), [&](const CaseNode::Resolved& entry) { return !(entry.*shown).empty(); });
  if (!node.name.empty() && (any || repeated || (node.present && node.presence_asked)))
    out += (repeated ? "\n[[" + name + "]]\n" : "\n[" + name + "]\n");
  for (const CaseNode::Resolved& entry : node.resolved)
    if (!(entry.*shown).empty()) out += (of_today ? entry.key : entry.first_key) + " = " + entry.*shown + "\n";
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

void put(CaseNode& node, const std::string& key, const toml::node& value, bool is_override) {
  const auto child = [&](const toml::table& table, bool of_list) {
    auto made = std::make_unique<CaseNode>();
    made->name = made->first_name = node.name.empty() ? key : node.name + "." + key;
    made->file = node.file, made->of_list = of_list;
    fill(*made, table, is_override);
    node.tables[key].push_back(std::move(made));
  };
  if (const auto* table = value.as_table()) {
    child(*table, false);
  } else if (const auto* array = value.as_array(); array && is_table_array(*array)) {
    for (const toml::node& element : *array) child(*element.as_table(), true);
  } else {
    value.visit([&](const auto& concrete) {
      node.values[key] = {std::make_shared<std::remove_cvref_t<decltype(concrete)>>(concrete),
                          is_override ? line_of_override : static_cast<int>(value.source().begin.line)};
    });
  }
}

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
  if (list.size() > 1) throw Error(ExitCode::usage, list[1]->where() + " appears more than once; write one [" + list[1]->name + "]");
  if (list.empty()) {
    list.push_back(std::make_unique<CaseNode>());
    const auto former = node_->former_tables.find(name);
    const std::string& first = former == node_->former_tables.end() ? name : former->second;
    list.front()->name = node_->name.empty() ? name : node_->name + "." + name;
    list.front()->first_name = node_->first_name.empty() ? first : node_->first_name + "." + first;
    list.front()->file = node_->file;
  }
  node_->note_read(name);
  return {root_, list.front().get()};
}

bool Table::has(const Section& section) const {
  adopt_former_table(*root_, *node_, section);
  return has(section.name);
}

Table Table::table(const Section& section) const {
  adopt_former_table(*root_, *node_, section);
  return table(section.name);
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
    const bool again = std::find(node_->known.begin(), node_->known.end(), resolved_key(parameter)) != node_->known.end();
    if (!again) {
      node_->known.push_back(resolved_key(parameter));
      if (!parameter.former.key.empty() || !parameter.former.values.empty())
        node_->renamed_keys.push_back({parameter.key, parameter.unit, parameter.former});
    }
    // An override replaces the value of the file, whatever the unit in the key of either, by the present name or by the former one.
    const bool overridden = std::any_of(node_->values.begin(), node_->values.end(), [&](const auto& entry) {
      return entry.second.line == line_of_override && match(entry.first, parameter);
    });
    const std::string at_default = parameter.required ? "" : toml_text(parameter.target);
    std::string found_key;
    for (const auto& [key, value] : node_->values) {
      const auto found = match(key, parameter);
      if (!found) continue;
      if (overridden && value.line != line_of_override) {
        node_->used.insert(key);
        continue;
      }
      const std::string where = place_of(node_->file, value.line) + ": [" + node_->name + "] ";
      if (!found_key.empty()) {
        const std::string former = found->is_former ? key : found_key;
        const bool renamed = former.starts_with(parameter.former.key) && !parameter.former.key.empty();
        throw Error(ExitCode::usage, where + key + " is given twice, as " + found_key + " and " + key + "; keep one of them" +
                                         (renamed ? " (" + former + " is the old name)" : ""));
      }
      found_key = key;
      node_->used.insert(key);
      const auto present = present_value(*root_, parameter, *found, key, *value.node, where);
      read_parameter(parameter, found->unit, present ? *present : *value.node, where + key);
    }
    if (found_key.empty() && parameter.required)
      throw Error(ExitCode::usage, node_->where() + ": missing key \"" + resolved_key(parameter) + "\": " + parameter.meaning);
    if (again) continue;
    auto entry = resolved_entry(parameter, at_default, node_->file);
    if (!entry.value.empty()) node_->resolved.push_back(std::move(entry));
  }
}

std::vector<std::pair<std::string, double>> Table::numbers() const {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& [key, value] : node_->values) {
    const auto number = value.node->value<double>();
    if (!number) throw Error(ExitCode::usage, node_->where() + " " + key + " must be a number");
    node_->used.insert(key);
    node_->resolved.push_back({toml_text(key), toml_text(*number), toml_text(key), toml_text(*number), toml_text(*number)});
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
  return Text(text, name).with(overrides);
}

CaseFile::Text::Text(const std::string& text, const std::string& name) {
  auto root = std::make_shared<CaseNode>();
  root->file = name;
  try {
    fill(*root, toml::parse(text, name), false);
  } catch (const toml::parse_error& failure) {
    throw Error(ExitCode::usage,
                name + ":" + std::to_string(failure.source().begin.line) + ": no valid TOML: " + shortened(failure.description()));
  }
  root->line = 0;
  root_ = std::move(root);
}

CaseFile CaseFile::Text::with(const std::vector<std::string>& overrides) const {
  CaseFile made;
  made.root_ = copy_of_unread(*root_);
  for (const std::string& override_text : overrides) apply_override(*made.root_, override_text);
  adopt_split_keys(*made.root_);
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

std::string CaseFile::with_present_names(const std::string& override_text) const {
  return translated(*root_, override_text, Names::present);
}

std::string CaseFile::with_first_names(const std::string& override_text) const { return translated(*root_, override_text, Names::first); }

const std::vector<std::string>& CaseFile::former_names() const { return root_->notes; }

std::filesystem::path CaseFile::path(const std::string& relative) const { return beside(file_, relative); }

}  // namespace snag
