#pragma once
// What must hold of every run: each check is a number of summary.json with a limit. The run ends with the code of a check that fails, and
// the report shows the same table.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace snag {

struct Check {
  std::string key;      // path in summary.json, "rags.*.key" for the largest of all rags
  std::string meaning;  // with its unit
  double limit = 0;
  ExitCode code = ExitCode::invariant;  // of a run in which it fails
  std::string remedy;
};

struct CheckedValue {
  Check check;
  std::optional<double> value;  // none: not measured, as the case has nothing to measure it on
  /// What is no number fails.
  bool fails() const { return value && !(*value <= check.limit); }
};

/// All checks on a summary, in the order of the report.
std::vector<CheckedValue> checked(const nlohmann::json& summary);
/// One sentence: what, value, limit, remedy.
std::string failure_in_words(const CheckedValue& failed);

}  // namespace snag
