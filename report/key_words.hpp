#pragma once
// Keys of summary.json and of a case as a reader calls them: a title and a unit.
#include <string>

namespace snag {

struct KeyWords {
  std::string title, unit;  // unit "" for a number or a text
  /// "Head [m]".
  std::string label() const { return unit.empty() ? title : title + " [" + unit + "]"; }
};

/// "pump.head_m": Head, m; "rags.2.outcome": Outcome, rag 2. Of a key without an entry: its last word, and the unit that it ends with.
KeyWords words_of_key(const std::string& key);

}  // namespace snag
