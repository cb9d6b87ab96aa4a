#pragma once
// The plots of a report: known monitors under plain titles, and every other column that is there.
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/series.hpp"
#include "report/line_plot.hpp"

namespace snag {

struct MonitorPlots {
  std::vector<LinePlot> plots;
  std::vector<std::pair<std::string, double>> constants;  // titles of what kept one value throughout, and that value
  std::vector<std::string> problems;                      // files that could not be read, and why
};

/// Columns, without units, by the name of their monitor without .csv.
using ColumnsByMonitor = std::map<std::string, std::set<std::string>>;

/// Plots of all *.csv files of a folder (none if it is absent). Columns of a vector (_x, _y, _z) share a plot, rags are lines of it.
/// `elsewhere`: columns that another section of the page shows.
MonitorPlots monitor_plots(const std::filesystem::path& folder, const ColumnsByMonitor& elsewhere = {});

}  // namespace snag
