// One table has the words of outcomes and events: row i belongs to enumerator i, and the schema of summary.json lists the same words.
#include "observe/outcome.hpp"
#include "tests/sources.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace snag {
namespace {

template <class Table>
std::vector<std::string> keys_of(const Table& table) {
  std::vector<std::string> keys;
  for (const auto& words : table) keys.emplace_back(words.key);
  return keys;
}

/// Requirement: a word of a file names one enumerator, which has that word.
TEST(Outcome, WordsAndEnumeratorsAreOne) {
  for (std::size_t i = 0; i < outcome_table.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(outcome_table[i].outcome), i);
    EXPECT_EQ(outcome_named(outcome_table[i].key), outcome_table[i].outcome);
  }
  for (std::size_t i = 0; i < event_table.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(event_table[i].event), i);
    EXPECT_EQ(event_named(event_table[i].key), event_table[i].event);
  }
  EXPECT_FALSE(outcome_named("stuck"));
  EXPECT_FALSE(event_named(""));
}

/// Requirement: what summary.json promises is what a run can write.
TEST(Outcome, SchemaOfTheSummaryHasTheSameWords) {
  std::ifstream file(in_sources("share/summary.schema.json"));
  const auto rag = nlohmann::json::parse(file).at("properties").at("rags").at("items").at("properties");
  EXPECT_EQ(rag.at("outcome").at("enum").get<std::vector<std::string>>(), keys_of(outcome_table));
  const auto what = rag.at("events").at("items").at("properties").at("what").at("enum").get<std::vector<std::string>>();
  EXPECT_EQ(what, keys_of(event_table));
}

}  // namespace
}  // namespace snag
