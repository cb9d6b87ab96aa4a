// The table of observables is the one list: names are unique, what a row says of its kind agrees with how it is read, and the manual names
// every row.
#include "observe/observables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
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

/// Requirement: coordinates have an axis and a length, angles a period, and what is of the passage belongs to the whole run.
TEST(Observables, RowsAgreeWithThemselves) {
  const Motion motion{{1, 2, 3}, {4, 5, 6}};
  for (const ObservableRecord& one : observables()) {
    const bool is_vector = one.measure == Measure::position || one.measure == Measure::velocity;
    EXPECT_EQ(one.axis >= 0, is_vector) << one.id;
    EXPECT_EQ(one.period() > 0, std::string(one.unit) == "rad") << one.id;
    EXPECT_EQ(one.scale_power(), is_vector ? 1 : std::string(one.unit) == "m2" ? 2 : 0) << one.id;
    if (is_vector)
      EXPECT_EQ(std::get<double (*)(const Motion&)>(one.read)(motion), one.axis + (one.is_position() ? 1 : 4)) << one.id;
    else
      EXPECT_NE(one.is_of_picture(), one.is_of_whole_run()) << one.id;
  }
}

/// Requirement: numbers of a passage are those of its result, and not a number where it has none.
TEST(Observables, ReadsThePassage) {
  PassageResult passage;
  passage.outcome = Outcome::stuck_on_impeller, passage.recirculations = 3;
  const auto read = [&](const char* id) { return std::get<double (*)(const PassageResult&)>(find_observable(id)->read)(passage); };
  EXPECT_EQ(read("stuck"), 1);
  EXPECT_EQ(read("exited"), 0);
  EXPECT_EQ(read("recirculations"), 3);
  EXPECT_TRUE(std::isnan(read("retention_time")));
  passage.outcome = Outcome::exited, passage.retention_time = 0.25;
  EXPECT_EQ(read("stuck"), 0);
  EXPECT_EQ(read("exited"), 1);
  EXPECT_EQ(read("retention_time"), 0.25);
}

/// Requirement: the tutorial on the diagnosis names every observable.
TEST(Observables, TutorialNamesThem) {
  std::ifstream file(std::string(std::getenv("SNAG_SOURCE_DIR")) + "/docs/tutorial-diagnosis.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const ObservableRecord& one : observables()) EXPECT_NE(text.find("| `" + std::string(one.id) + "` |"), std::string::npos) << one.id;
}

}  // namespace
}  // namespace snag
