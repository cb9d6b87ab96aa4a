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

void apply_override(CaseNode& root, const std::string& text) {
  const auto equals = text.find('=');
  const auto fail = [&](const std::string& why) {
    return Error(ExitCode::usage, "--set " + shortened(text) + ": " + why + "; write section.key=value, for instance --set time.end_s=0.1");
  };
  if (equals == std::string::npos || equals == 0) throw fail(equals == 0 ? "names no key" : "has no \"=\"");
  const std::string path = text.substr(0, equals);
  const std::optional<toml::table> parsed = parsed_value(text.substr(equals + 1));
  if (!parsed) throw fail("its value is not valid TOML");
  const std::vector<std::string> steps = split(path, '.');
  CaseNode* at = &root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const std::string& step = steps[i];
    if (at->values.contains(step)) throw fail("\"" + step + "\" is a value, not a table");
    if (!at->tables.contains(step)) put(*at, step, toml::table{}, true);
    const auto& list = at->tables.at(step);
    // [[rag]] with a single element may be addressed without its index.
    const std::string& next = steps[i + 1];
    const bool has_index = !next.empty() && std::isdigit(static_cast<unsigned char>(next[0]));
    std::size_t index = 0;
    if (list.front()->of_list && (has_index || list.size() > 1)) {
      const auto [end, code] = std::from_chars(next.data(), next.data() + next.size(), index);
      if (code != std::errc() || end != next.data() + next.size() || index >= list.size())
        throw fail("\"" + shortened(next) + "\" is not the number of one of the " + std::to_string(list.size()) + " tables there");
      if (++i + 1 == steps.size()) throw fail("names a table, not a key");
    }
    at = list[index].get();
  }
  if (at->tables.contains(steps.back())) throw fail("names a section, not a key");
  at->values.erase(steps.back());
  put(*at, steps.back(), *parsed->get("v"), true);
}

}  // namespace snag
