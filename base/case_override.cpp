#include "base/case_override.hpp"

#include <cctype>
#include <charconv>
#include <optional>
#include <vector>

#include "base/case_node.hpp"
#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

/// A table whose key `v` has the value: TOML, or a text without its quotes. Nothing if it is neither.
std::optional<toml::table> parsed_value(const std::string& value) {
  std::string quoted;
  for (const char c : value) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  for (const std::string& text : {value, "\"" + quoted + "\""}) {
    try {
      return toml::parse("v = " + text);
    } catch (const toml::parse_error&) {
    }
  }
  return {};
}

}  // namespace

void apply_override(toml::table& root, const std::string& text) {
  const auto equals = text.find('=');
  const auto fail = [&](const std::string& why) {
    return Error(ExitCode::usage, "--set " + shortened(text) + ": " + why + "; write section.key=value, for instance --set time.end_s=0.1");
  };
  if (equals == std::string::npos || equals == 0) throw fail(equals == 0 ? "names no key" : "has no \"=\"");
  const std::string path = text.substr(0, equals);
  const std::optional<toml::table> parsed = parsed_value(text.substr(equals + 1));
  if (!parsed) throw fail("its value is not valid TOML");
  const std::vector<std::string> steps = split(path, '.');
  toml::node* at = &root;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string& step = steps[i];
    const bool last = i + 1 == steps.size();
    if (auto* array = at->as_array()) {
      std::size_t index = 0;
      const auto [end, code] = std::from_chars(step.data(), step.data() + step.size(), index);
      if (code != std::errc() || end != step.data() + step.size() || index >= array->size())
        throw fail("\"" + shortened(step) + "\" is not the number of one of the " + std::to_string(array->size()) + " tables there");
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
      table->insert_or_assign(step, *parsed->get("v"));
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

}  // namespace snag
