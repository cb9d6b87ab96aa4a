#pragma once
// How the names in a case file stand for parameters and tables: with or without a unit, by the present or by the former name. For .cpp
// files of this folder only.
#include <memory>
#include <optional>
#include <string>

#include <toml++/toml.h>

#include "base/case_node.hpp"

namespace snag {

/// A key of the file that stands for a parameter.
struct KeyMatch {
  std::string unit;  // that the key carries: "" for the bare key
  bool is_former = false;
};

/// Whether `key` stands for this parameter; nothing if it is another key.
std::optional<KeyMatch> match(const std::string& key, const Parameter& parameter);

/// The key as it is written to case.resolved.toml.
std::string resolved_key(const Parameter& parameter);
/// The same with the first name of the key: the hash of a case takes it, whatever the key is called today.
std::string first_resolved_key(const Parameter& parameter);
/// The first name of a value, as TOML; most values have one name only.
std::string first_value(const Parameter& parameter, const std::string& value);

/// The value under its present name, and a note where the file has a former name of the key or of the value; null: as it stands. `where`
/// begins messages. Throws Error(usage) if the former key had no such value.
std::shared_ptr<toml::node> present_value(CaseNode& root, const Parameter& parameter, const KeyMatch& found, const std::string& key,
                                          const toml::node& value, const std::string& where);

/// Moves the table of the former name to the present name, and notes it. Values of overrides replace those of the file, whatever name
/// either has. Throws Error(usage) if the file has tables of both names.
void adopt_former_table(CaseNode& root, CaseNode& parent, const Section& section);

/// An override "section.0.key=value" (the value may be missing) with the names of today, or with the first ones. Names of tables and keys
/// that were not read stay as they are.
enum class Names { present, first };
std::string translated(const CaseNode& root, const std::string& override_text, Names names);

}  // namespace snag
