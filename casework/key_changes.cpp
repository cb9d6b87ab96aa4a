#include "casework/key_changes.hpp"

#include <algorithm>

#include "base/parameter_text.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

bool is_number(const toml::node& node) {
  if (const auto* list = node.as_array()) return !list->empty() && std::all_of(list->begin(), list->end(), is_number);
  return node.is_number();
}

}  // namespace

std::vector<std::pair<std::string, const toml::table*>> tables_at(const toml::table& root, const std::string& path) {
  std::vector<std::pair<std::string, const toml::table*>> found{{"", &root}};
  for (const std::string& step : split(path, '.')) {
    std::vector<std::pair<std::string, const toml::table*>> next;
    for (const auto& [prefix, table] : found) {
      const toml::node* node = table->get(step);
      if (!node) continue;
      const std::string name = prefix.empty() ? step : prefix + "." + step;
      if (const auto* one = node->as_table()) next.emplace_back(name, one);
      if (const auto* many = node->as_array())
        for (std::size_t i = 0; i < many->size(); ++i)
          if (const auto* element = many->get(i)->as_table()) next.emplace_back(name + "." + std::to_string(i), element);
    }
    found = std::move(next);
  }
  return found;
}

std::vector<KeyNode> nodes_of(const toml::table& root, const std::string& key) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return {};
  std::vector<KeyNode> nodes;
  for (const auto& [prefix, table] : tables_at(root, key.substr(0, dot))) {
    const toml::node* value = table->get(key.substr(dot + 1));
    if (value && is_number(*value)) nodes.push_back({prefix + "." + key.substr(dot + 1), value});
  }
  return nodes;
}

std::string changed_text(const toml::node& node, double factor, std::span<const double> added) {
  if (const auto* list = node.as_array()) {
    std::vector<std::string> parts;
    for (const toml::node& element : *list) {
      parts.push_back(changed_text(element, factor, added.first(std::min<std::size_t>(1, added.size()))));
      if (added.size() > 1) added = added.subspan(1);
    }
    return "[" + joined(parts) + "]";
  }
  return toml_text((*node.value<double>() + (added.empty() ? 0 : added.front())) * factor);
}

void KeyChanges::set(const std::string& text) {
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  const auto nodes = nodes_of(root_, key);
  for (const KeyNode& node : nodes) values_[node.key] = value;
  if (nodes.empty()) values_[key] = value;
}

void KeyChanges::scale(const std::string& key, double factor) {
  for (const KeyNode& node : nodes_of(root_, key)) changes_.emplace(node.key, Change{node.value}).first->second.factor *= factor;
}

void KeyChanges::add(const std::string& key, const std::vector<double>& added) {
  for (const KeyNode& node : nodes_of(root_, key)) add(node, added);
}

void KeyChanges::add(const KeyNode& node, const std::vector<double>& added) {
  std::vector<double>& sum = changes_.emplace(node.key, Change{node.value}).first->second.added;
  sum.resize(added.size(), 0);
  for (std::size_t i = 0; i < added.size(); ++i) sum[i] += added[i];
}

std::vector<std::string> KeyChanges::overrides() const {
  std::vector<std::string> all;
  for (const auto& [key, value] : values_)
    if (!changes_.contains(key)) all.push_back(key + "=" + value);
  for (const auto& [key, change] : changes_) {
    const auto set = values_.find(key);
    const toml::table given = set == values_.end() ? toml::table() : toml::parse("value = " + set->second);
    const toml::node& value = set == values_.end() ? *change.value : *given.get("value");
    all.push_back(key + "=" + changed_text(value, change.factor, change.added));
  }
  return all;
}

}  // namespace snag
