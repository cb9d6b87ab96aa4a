// A column of a monitor is declared once: header and values come from the same list.
#include "base/monitor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/vec3.hpp"

namespace snag {
namespace {

struct Record {
  double time = 0;
  Vec3 force;
};

/// Requirement: each column has its name, its unit and its own value; components of a vector follow each other.
TEST(Monitor, HeaderAndValuesComeFromOneList) {
  const auto file = std::filesystem::temp_directory_path() / ("snag_monitor_" + std::to_string(getpid()) + ".csv");
  std::vector<Column<Record>> columns{{"time", "s", [](const Record& r) { return r.time; }}};
  add_components(columns, "force_", "_mean", "N", [](const Record& r) { return r.force; });
  Monitor<Record> monitor(file, columns);
  monitor.add({0.5, {1, 2, 3}});
  monitor.add({1.5, {4, 5, 6}});
  monitor.series().check();
  const SeriesTable table = read_series(file);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"time [s]", "force_x_mean [N]", "force_y_mean [N]", "force_z_mean [N]"}));
  EXPECT_EQ(table.column("time"), (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(table.column("force_y_mean"), (std::vector<double>{2, 5}));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace snag
