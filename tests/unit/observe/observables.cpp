// The records of observables are the one list: names are unique, and what a record says of its kind agrees with how it is read.
#include "observe/observables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace snag {
namespace {

/// Requirement: a name finds its own row, and only names of the table are found.
TEST(Observables, NamesAreUnique) {
  const std::vector<std::string> ids = observable_ids();
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), observables().size());
  for (const ObservableRecord& one : observables()) EXPECT_EQ(find_observable(one.id), &one);
  EXPECT_EQ(find_observable("head"), nullptr);
  EXPECT_EQ(find_observable(""), nullptr);
}

/// Requirement: coordinates have an axis and a length, positions a rate, angles a period, and what is of the passage belongs to the whole
/// run.
TEST(Observables, RowsAgreeWithThemselves) {
  const Motion motion{{1, 2, 3}, {4, 5, 6}};
  for (const ObservableRecord& one : observables()) {
    const bool is_vector = one.measure == Measure::position || one.measure == Measure::velocity;
    EXPECT_EQ(one.axis >= 0, is_vector) << one.id;
    EXPECT_EQ(one.period() > 0, std::string(one.unit) == "rad") << one.id;
    EXPECT_EQ(one.scale_power(), is_vector ? 1 : std::string(one.unit) == "m2" ? 2 : 0) << one.id;
    EXPECT_EQ(one.is_of_whole_run(), one.read.is_of<PassageResult>()) << one.id;
    EXPECT_EQ(one.read.is_of<Silhouette>(), !is_vector && !one.is_of_whole_run()) << one.id;
    EXPECT_EQ(one.rate.is_there(), one.is_position()) << one.id;
    if (is_vector) {
      EXPECT_EQ(one.read(motion), one.axis + (one.is_position() ? 1 : 4)) << one.id;
    }
    if (one.is_position()) {
      EXPECT_EQ(one.rate(motion), one.axis + 4) << one.id;
    }
  }
}

/// Requirement: numbers of a passage are those of its result, and not a number where it has none.
TEST(Observables, ReadsThePassage) {
  PassageResult passage;
  passage.outcome = Outcome::stuck_on_impeller, passage.recirculations = 3;
  const auto read = [&](const char* id) { return find_observable(id)->read(passage); };
  EXPECT_EQ(read("stuck"), 1);
  EXPECT_EQ(read("exited"), 0);
  EXPECT_EQ(read("recirculations"), 3);
  EXPECT_TRUE(std::isnan(read("retention_time")));
  passage.outcome = Outcome::exited, passage.retention_time = 0.25;
  EXPECT_EQ(read("stuck"), 0);
  EXPECT_EQ(read("exited"), 1);
  EXPECT_EQ(read("retention_time"), 0.25);
}

}  // namespace
}  // namespace snag
