#include "benchmark/speed/record.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"

namespace snag {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string short_number(const std::optional<double>& value) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", *value);
  return text;
}

}  // namespace

std::optional<double> BenchRecord::ratio() const {
  if (!peer_value || *peer_value == 0) return {};
  return value / *peer_value;
}

void write_bench(const std::filesystem::path& file, const std::vector<BenchRecord>& records) {
  Json list = Json::array();
  for (const BenchRecord& record : records)
    list.push_back({{"name", record.name},
                    {"value", record.value},
                    {"unit", record.unit},
                    {"ranks", record.ranks},
                    {"limit", or_null(record.limit)},
                    {"peer", record.peer.empty() ? Json(nullptr) : Json(record.peer)},
                    {"peer_value", or_null(record.peer_value)},
                    {"ratio", or_null(record.ratio())},
                    {"note", record.note}});
  write_atomically(file, list.dump(2) + "\n");
}

std::string bench_table(const std::vector<BenchRecord>& records) {
  std::string table;
  const auto line = [&](const char* name, const std::string& value, const std::string& unit, const std::string& limit,
                        const std::string& peer, const std::string& ratio) {
    char text[200];
    std::snprintf(text, sizeof text, "%-28s %10s %-10s %10s %10s %8s\n", name, value.c_str(), unit.c_str(), limit.c_str(), peer.c_str(),
                  ratio.c_str());
    table += text;
  };
  line("name", "value", "unit", "limit", "peer", "ratio");
  for (const BenchRecord& record : records)
    line(record.name.c_str(), short_number(record.value), record.unit, short_number(record.limit), short_number(record.peer_value),
         short_number(record.ratio()));
  return table;
}

}  // namespace snag
