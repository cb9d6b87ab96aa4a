#pragma once
// Numbers of a case by their keys, and changes of them as overrides of the case file.
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace snag {

/// Tables of a name such as "rag" or "coupling.added_mass", one or many, with the path by which an override reaches each.
std::vector<std::pair<std::string, const toml::table*>> tables_at(const toml::table& root, const std::string& path);

/// A number, or a list of numbers, of a case.
struct KeyNode {
  std::string key;  // for an override
  const toml::node* value;
};

/// All nodes of a key such as "boundary.flow_rate_m3_s"; none if the case has no such number.
std::vector<KeyNode> nodes_of(const toml::table& root, const std::string& key);

/// Value plus `added` (one for each number; empty: none), times factor, as TOML.
std::string changed_text(const toml::node& value, double factor, std::span<const double> added = {});

/// Changes of one case: values that effects give to keys, then what is added to them, then factors on them; each key is written once.
class KeyChanges {
 public:
  /// `root`: the resolved case, which must outlive this.
  explicit KeyChanges(const toml::table& root) : root_(root) {}

  /// "section.key=value", of every node that has the key. The last value counts.
  void set(const std::string& text);
  /// Of the numbers that the case has at a key. What is added has one number, or as many as the key.
  void scale(const std::string& key, double factor);
  void add(const std::string& key, const std::vector<double>& added);
  void add(const KeyNode& node, const std::vector<double>& added);
  std::vector<std::string> overrides() const;

 private:
  struct Change {
    const toml::node* value;
    double factor = 1;
    std::vector<double> added{};
  };
  const toml::table& root_;
  std::map<std::string, std::string> values_;
  std::map<std::string, Change> changes_;
};

}  // namespace snag
