#include "casework/run_table.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

/// "1,nan,2e-3," -> its numbers; nothing if it is not made of numbers with commas behind them.
std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> values;
  const char *at = text.data(), *end = at + text.size();
  while (at < end) {
    double value = 0;
    const auto [stop, failure] = std::from_chars(at, end, value);
    if (failure != std::errc() || stop == end || *stop != ',') return {};
    values.push_back(value);
    at = stop + 1;
  }
  return values;
}

}  // namespace

std::vector<StoredRun> run_table(std::string_view text, const std::filesystem::path& file) {
  std::vector<StoredRun> runs;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string_view::npos; begin = end + 1) {
    const std::string_view line = text.substr(begin, end - begin);
    const std::vector<std::string> parts = split(line, '\t');
    auto values = parts.size() == 4 ? numbers(parts[2]) : std::nullopt;
    if (!values)
      throw Error(ExitCode::io, file.string() + ":" + std::to_string(runs.size() + 1) + ": \"" + shortened(std::string(line)) +
                                    "\" is not a run (program, key, numbers each with a comma behind it, failure; tabs between them); "
                                    "remove the line; the run is then repeated");
    runs.push_back({parts[0], parts[1], {.values = std::move(*values), .failure = parts[3]}});
  }
  return runs;
}

std::string run_table_line(const StoredRun& run) {
  std::string line = run.program + "\t" + run.key + "\t";
  char digits[32];
  for (const double value : run.result.values) line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr).append(",");
  std::string failure = run.result.failure;
  std::replace_if(
      failure.begin(), failure.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return line + "\t" + failure + "\n";
}

}  // namespace snag
