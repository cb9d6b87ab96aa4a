#include "report/monitor_plots.hpp"

#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "base/parameter.hpp"

namespace snag {

namespace {

/// Columns that belong into one plot, and what a reader calls them.
struct KnownPlot {
  const char* monitor;  // name of the file without .csv
  const char* title;
  std::vector<const char*> columns;  // "*_flow" stands for all that end like that
};

/// In the order of the page: the machine, the rags, the exchange, the solvers, the cost.
const std::vector<KnownPlot>& known_plots() {
  static const std::vector<KnownPlot> plots = {
      {"pump", "Head of the pump", {"head", "head_total"}},
      {"pump", "Flow rate through the pump", {"flow_in", "flow_out"}},
      {"pump", "Torque of the water on the impeller", {"torque", "torque_pressure", "torque_friction"}},
      {"pump", "Shaft power", {"shaft_power", "hydraulic_power"}},
      {"pump", "Efficiency", {"efficiency"}},
      {"balance",
       "Balance of power",
       {"shaft_power", "given_power", "hydraulic_power", "stored_power", "dissipation_viscous", "dissipation_turbulent",
        "dissipation_walls", "numerical"}},
      {"balance",
       "Numerical dissipation by its cause",
       {"numerical_convection", "numerical_time", "numerical_pressure", "numerical_friction"}},
      {"balance", "Balance of power: residual", {"residual_power"}},
      {"balance", "Numerical loss of angular momentum in each zone", {"*_lost"}},
      {"balance",
       "Numerical loss of angular momentum, by term of the equation",
       {"*_lost_convection", "*_lost_pressure", "*_lost_friction"}},
      {"balance", "Balance of angular momentum: residual", {"*_residual"}},
      {"balance", "Balance of angular momentum", {"shaft_torque", "*_stored", "*_openings", "*_interface", "*_given"}},
      {"balance", "Torque of the water on walls by pressure", {"*_pressure"}},
      {"balance", "Torque of the water on walls by friction", {"*_friction"}},
      {"rags", "Centroid of the rag", {"x", "y", "z"}},
      {"rags", "Velocity of the rag's centroid", {"vx", "vy", "vz"}},
      {"rags", "Elongation ratio: long side over short side of the rag", {"elongation_ratio"}},
      {"rags", "Distance between the ends of the rag", {"end_to_end"}},
      {"rags", "Extent of the rag along x", {"x_min", "x_max"}},
      {"rags", "Extent of the rag along y", {"y_min", "y_max"}},
      {"rags", "Extent of the rag along z", {"z_min", "z_max"}},
      {"rags", "Kinetic and elastic energy of the rag", {"kinetic_energy", "bond_energy"}},
      {"rags", "Largest strain of a bond", {"bond_strain_max"}},
      {"rags", "Largest tension of a bond", {"bond_tension_max"}},
      {"rags", "Broken bonds", {"broken_bonds"}},
      {"rags", "Particles that have left the domain", {"particles_out"}},
      {"passage", "Place of the largest tension of a bond", {"max_tension_x", "max_tension_y", "max_tension_z"}},
      {"contacts", "Contacts: all, and those with walls", {"contacts", "wall_contacts"}},
      {"contacts", "Deepest overlap of a contact, in particle radii", {"overlap_over_radius_max"}},
      {"silhouettes", "Elongation ratio of the silhouette", {"elongation_ratio"}},
      {"silhouettes", "Area of the silhouette", {"area"}},
      {"coupling", "Force of the water on all rags", {"force_on_rags_x", "force_on_rags_y", "force_on_rags_z"}},
      {"coupling", "Momentum lost in the exchange, relative to what was exchanged", {"momentum_exchange_rel"}},
      {"coupling", "Largest solid fraction of a cell", {"max_solid_fraction", "solid_fraction_max"}},
      {"patches", "Flow rate through each part of the boundary", {"*_flow"}},
      {"patches", "Mean pressure on each part of the boundary", {"*_pressure"}},
      {"wall", "y+ of the cells at the walls, mean over each wall", {"*_y_plus_mean"}},
      {"wall", "y+ of the cells at the walls, lowest and highest of each wall", {"*_y_plus_min", "*_y_plus_max"}},
      {"residuals", "Courant number", {"courant_max", "courant_mean"}},
      {"residuals", "Residuals of the water's equations", {"momentum_residual", "pressure_residual"}},
      {"residuals", "Continuity: largest imbalance of a cell, relative", {"continuity_local"}},
      {"residuals", "Continuity: imbalance of the whole domain", {"continuity_global"}},
      {"residuals", "Iterations of the linear solvers", {"momentum_sweeps_iterations", "pressure_iterations"}},
      {"timing", "Wall-clock time by part", {"flow_s", "dem_s", "coupling_s", "output_s"}},
  };
  return plots;
}

struct Column {
  std::string name, unit;
};

Column column_of(const std::string& header) {
  const auto at = header.rfind(" [");
  if (at == std::string::npos || !header.ends_with(']')) return {header, "1"};
  return {header.substr(0, at), header.substr(at + 2, header.size() - at - 3)};
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// What a reader calls a column of a monitor; without an entry: its name with spaces. The plots of patches say which quantity they show.
std::string title_of(const std::string& monitor, const std::string& column) {
  static const std::map<std::string, std::string> titles = {
      {"head", "mean pressures and velocities"},
      {"head_total", "total pressure, weighted with the flux"},
      {"flow_in", "into the inlet"},
      {"flow_out", "out of the outlet"},
      {"torque", "torque"},
      {"torque_pressure", "pressure part"},
      {"torque_friction", "viscous part"},
      {"shaft_power", "shaft power"},
      {"hydraulic_power", "hydraulic power"},
      {"vx", "velocity, x"},
      {"vy", "velocity, y"},
      {"vz", "velocity, z"},
      {"x_min", "lowest x"},
      {"x_max", "highest x"},
      {"y_min", "lowest y"},
      {"y_max", "highest y"},
      {"z_min", "lowest z"},
      {"z_max", "highest z"},
      {"kinetic_energy", "kinetic energy"},
      {"bond_energy", "elastic energy of the bonds"},
      {"bond_strain_max", "largest strain"},
      {"bond_tension_max", "largest tension"},
      {"max_tension_x", "x"},
      {"max_tension_y", "y"},
      {"max_tension_z", "z"},
      {"contacts", "all contacts"},
      {"wall_contacts", "contacts with walls"},
      {"overlap_over_radius_max", "overlap / radius"},
      {"momentum_exchange_rel", "relative loss"},
      {"max_solid_fraction", "largest solid fraction"},
      {"courant_max", "largest"},
      {"courant_mean", "mean"},
      {"momentum_residual", "momentum"},
      {"pressure_residual", "pressure"},
      {"continuity_local", "relative imbalance"},
      {"continuity_global", "imbalance"},
      {"momentum_sweeps_iterations", "momentum"},
      {"pressure_iterations", "pressure"},
      {"flow_s", "water"},
      {"dem_s", "rags"},
      {"coupling_s", "exchange"},
      {"output_s", "output"},
  };
  if (const auto found = titles.find(column); found != titles.end()) return found->second;
  for (const auto& [end, of] :
       {std::pair<const char*, const char*>{"_y_plus_mean", "mean"}, {"_y_plus_min", "lowest"}, {"_y_plus_max", "highest"}})
    if (column.ends_with(end)) return column.substr(0, column.size() - std::string(end).size()) + ", " + of;
  for (const char* end : {"_flow", "_pressure"})
    if (monitor == "patches" && column.ends_with(end)) return spaced(column.substr(0, column.size() - std::string(end).size()));
  return spaced(column);
}

/// "force" of force_x, force_y, force_z, otherwise the name itself.
std::string stem(const std::string& name) {
  const auto n = name.size();
  return n > 2 && name[n - 2] == '_' && name[n - 1] >= 'x' && name[n - 1] <= 'z' ? name.substr(0, n - 2) : name;
}

class Monitor {
 public:
  Monitor(std::string name, const SeriesTable& table) : name_(std::move(name)), table_(table) {
    for (const auto& header : table_.columns) columns_.push_back(column_of(header));
    left_.insert(table_.columns.begin() + 1, table_.columns.end());
    std::erase_if(left_, [](const std::string& header) {
      const auto column = column_of(header).name;
      return column == "time_step" || column == "rag" || column == "step" || column == "angle" || column == "revolutions";
    });
    const auto rag = std::find_if(columns_.begin(), columns_.end(), [](const Column& column) { return column.name == "rag"; });
    if (rag == columns_.end()) {
      records_[0].resize(table_.values[0].size());
      for (std::size_t i = 0; i < records_[0].size(); ++i) records_[0][i] = i;
    } else {
      const auto& ids = table_.values[static_cast<std::size_t>(rag - columns_.begin())];
      for (std::size_t i = 0; i < ids.size(); ++i) records_[static_cast<long>(ids[i])].push_back(i);
    }
  }

  /// The plot of those of the columns that exist and share the unit of the first of them; without lines if none does.
  LinePlot plot(const std::string& title, const std::vector<std::string>& names) {
    std::vector<std::size_t> shown;
    for (std::size_t c = 1; c < columns_.size(); ++c)
      if (is_among(columns_[c].name, names) && left_.contains(table_.columns[c]) &&
          (shown.empty() || columns_[c].unit == columns_[shown[0]].unit))
        shown.push_back(c);
    LinePlot result{title, axis_label({"time", columns_[0].unit}), "", {}};
    if (shown.empty()) return result;
    const Column& first = columns_[shown[0]];
    const bool is_one = shown.size() == 1, is_vector = stem(first.name) != first.name;
    result.y_label = axis_label({is_one ? title_of(name_, first.name) : is_vector ? spaced(stem(first.name)) : "", first.unit});
    bool is_error_plot = true;
    for (const auto c : shown) {
      left_.erase(table_.columns[c]);
      is_error_plot = is_error_plot && is_error(columns_[c].name);
      for (const auto& [rag, records] : records_) result.lines.push_back(line(c, rag, records, !is_one));
    }
    // What should be small is read by its order of magnitude; other numbers only where a linear axis would hide most of them.
    result.logarithmic = decades(result) >= (is_error_plot ? 0 : first.unit == "1" ? 3 : infinity);
    return result;
  }

  /// Names of columns that no plot has shown yet, those of a vector together.
  std::vector<std::vector<std::string>> rest() const {
    std::vector<std::vector<std::string>> groups;
    for (std::size_t c = 1; c < columns_.size(); ++c) {
      if (!left_.contains(table_.columns[c])) continue;
      const auto& name = columns_[c].name;
      if (stem(name) != name && !groups.empty() && stem(groups.back().front()) == stem(name))
        groups.back().push_back(name);
      else
        groups.push_back({name});
    }
    return groups;
  }
  const std::string& name() const { return name_; }
  /// These columns are shown elsewhere.
  void leave_out(const std::set<std::string>& columns) {
    std::erase_if(left_, [&](const std::string& header) { return columns.contains(column_of(header).name); });
  }

 private:
  std::string name_;
  SeriesTable table_;
  std::vector<Column> columns_;
  std::set<std::string> left_;                        // headers not shown yet
  std::map<long, std::vector<std::size_t>> records_;  // by rag

  static std::string axis_label(const Column& column) {
    return column.unit == "1" ? column.name : (column.name.empty() ? "" : column.name + " ") + "[" + column.unit + "]";
  }
  static bool is_error(const std::string& column) {
    return column.ends_with("_rel") || column.find("residual") != std::string::npos || column.starts_with("continuity");
  }
  static bool is_among(const std::string& column, const std::vector<std::string>& names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return name.starts_with('*') ? column.ends_with(name.substr(1)) : column == name; });
  }
  PlotLine line(std::size_t c, long rag, const std::vector<std::size_t>& records, bool named) const {
    PlotLine result;
    if (named) result.label = title_of(name_, columns_[c].name);
    if (records_.size() > 1) result.label += (named ? ", rag " : "rag ") + std::to_string(rag);
    for (const auto i : records) {
      result.x.push_back(table_.values[0][i]);
      result.y.push_back(table_.values[c][i]);
    }
    return result;
  }
};

/// The value that all lines of a plot keep throughout, if there is one.
std::optional<double> constant_value(const LinePlot& plot) {
  std::optional<double> value;
  for (const auto& line : plot.lines)
    for (const double y : line.y) {
      if (value && y != *value) return {};
      value = y;
    }
  return value;
}

/// End of the pump's start-up (simulation/output/pump_output.hpp), s; nothing without a revolution.
std::optional<double> start_up_end(const std::filesystem::path& folder) {
  try {
    const SeriesTable revolutions = recorded(folder / "revolutions.csv");
    if (revolutions.columns.empty()) return {};
    const auto &time = revolutions.values[0], &start_up = revolutions.column("start_up");
    const auto settled = static_cast<std::size_t>(std::find(start_up.begin(), start_up.end(), 0.0) - start_up.begin());
    if (settled == 0) return {};
    return time[settled == time.size() ? 0 : settled - 1];  // never settled: what follows the first revolution
  } catch (const Error&) {
    return {};  // of another version; the whole run is drawn
  }
}

/// What is not over time has a section of its own.
bool is_of_the_pump(const std::string& monitor) { return monitor == "revolutions" || monitor == "phase"; }

std::vector<Monitor> monitors_of(const std::filesystem::path& folder, std::vector<std::string>& problems) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".csv" && !is_of_the_pump(entry.path().stem())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Monitor> monitors;
  for (const auto& file : files) {
    try {
      const SeriesTable table = read_series(file);
      if (table.columns.empty() || table.values[0].empty())
        problems.push_back(file.filename().string() + " holds no record");
      else
        monitors.emplace_back(file.stem().string(), table);
    } catch (const Error& error) {
      problems.emplace_back(error.what());
    }
  }
  return monitors;
}

}  // namespace

MonitorPlots monitor_plots(const std::filesystem::path& folder, const ColumnsByMonitor& elsewhere) {
  MonitorPlots result;
  auto monitors = monitors_of(folder, result.problems);
  for (auto& monitor : monitors)
    if (const auto found = elsewhere.find(monitor.name()); found != elsewhere.end()) monitor.leave_out(found->second);
  const std::optional<double> scale_from = start_up_end(folder);
  const auto keep = [&](LinePlot plot) {
    if (scale_from && !plot.logarithmic) plot.scale_from = *scale_from;
    const auto value = constant_value(plot);
    if (value)
      result.constants.emplace_back(plot.title, *value);
    else if (!plot.lines.empty())
      result.plots.push_back(plot);
  };
  for (const auto& known : known_plots())
    for (auto& monitor : monitors)
      if (monitor.name() == known.monitor) keep(monitor.plot(known.title, {known.columns.begin(), known.columns.end()}));
  for (auto& monitor : monitors)
    for (const auto& group : monitor.rest())
      keep(monitor.plot(spaced(monitor.name()) + ": " + spaced(group.size() > 1 ? stem(group[0]) : group[0]), group));
  return result;
}

}  // namespace snag
