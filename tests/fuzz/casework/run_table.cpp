// The table of runs that a diagnosis takes instead of computing them.
#include "casework/run_table.hpp"

#include "base/atomic_file.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

/// What was read is written as it was read.
void read(const std::filesystem::path& file) {
  const std::string text = file_text(file).value_or("");
  std::string again;
  const std::vector<StoredRun> runs = run_table(text, file);
  for (const StoredRun& run : runs) again += run_table_line(run);
  if (run_table(again, file).size() != runs.size()) throw std::logic_error("a table that was written is not the one that was read");
}

const fuzz::Registration table({"run_table", ".tsv",
                                [] {
                                  const std::string all = fuzz::source_file("cases/diagnose-pump/runs.tsv");
                                  return std::vector<std::string>{all.substr(0, all.find('\n', 2000) + 1)};
                                },
                                read});

}  // namespace
