#pragma once
// What a benchmark found: bench.json, a list of
//
//   {name, value, unit, ranks, limit, peer, peer_value, ratio, note}
//
// limit: what the machine allows, in the same unit; peer: another program, which did the same on this machine; ratio: value over
// peer_value. null where there is none.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snag {

struct BenchRecord {
  std::string name;
  double value = 0;
  std::string unit;
  int ranks = 1;
  std::optional<double> limit = {};
  std::string peer = {};  // empty: none
  std::optional<double> peer_value = {};
  std::string note = {};  // how the value is meant

  /// Value over that of the peer, if there is one other than 0.
  std::optional<double> ratio() const;
};

/// Throws Error(io).
void write_bench(const std::filesystem::path& file, const std::vector<BenchRecord>& records);
/// One line a record, in columns.
std::string bench_table(const std::vector<BenchRecord>& records);

}  // namespace snag
