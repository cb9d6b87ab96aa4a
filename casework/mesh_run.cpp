#include "casework/mesh_run.hpp"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/series.hpp"
#include "base/words.hpp"
#include "casework/observable_source.hpp"
#include "casework/window_mean.hpp"
#include "parallel/session.hpp"
#include "simulation/run.hpp"

namespace snag {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

nlohmann::json summary_of(const std::filesystem::path& folder) {
  return nlohmann::json::parse(file_text(folder / "summary.json").value_or(""), nullptr, false);
}

bool is_done(const std::filesystem::path& folder) {
  const auto summary = summary_of(folder);
  return summary.is_object() && summary.value("exit", -1) == 0;
}

/// A quantity over time, of the first rag where a monitor has several.
struct Course {
  std::vector<double> time, value;
  double period = 0;  // of an angle, rad; 0: it is none

  double at(double t) const {
    const auto next = std::lower_bound(time.begin(), time.end(), t * (1 - 1e-9));
    if (next == time.end() || (next == time.begin() && *next > t * (1 + 1e-9) + 1e-12)) return nan;
    const auto i = static_cast<std::size_t>(next - time.begin());
    if (i == 0 || time[i] == time[i - 1]) return value[i];
    const double s = std::clamp((t - time[i - 1]) / (time[i] - time[i - 1]), 0.0, 1.0);
    if (period == 0) return value[i - 1] + s * (value[i] - value[i - 1]);
    return std::remainder(value[i - 1] + s * std::remainder(value[i] - value[i - 1], period), period);
  }
  double mean_of_last_half() const {
    WindowMean mean;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] >= 0.5 * time.back()) mean.add(value[i], period);
    return mean.value();
  }
};

bool has_column(const SeriesTable& table, const std::string& name) {
  return std::any_of(table.columns.begin(), table.columns.end(),
                     [&](const std::string& column) { return column == name || column.starts_with(name + " ["); });
}

/// Whether the rag of this row of silhouettes is there: of one that has not come yet, or has left, all columns are 0. (Cloth seen exactly
/// from its edge has no area, but a place.)
bool is_there(const SeriesTable& table, std::size_t row) {
  if (!has_column(table, "area")) return true;
  const auto is_zero = [&](const char* name) { return !has_column(table, name) || table.column(name)[row] == 0; };
  return !(is_zero("area") && is_zero("elongation_ratio") && is_zero("x") && is_zero("y"));
}

/// The monitor that tells a name: rags and pictures first, since others have an x of their own.
Course course_of(const std::filesystem::path& folder, const std::string& name) {
  std::vector<std::filesystem::path> files;
  for (const char* first : {"rags.csv", "silhouettes.csv", "pump.csv"}) files.push_back(folder / "monitors" / first);
  for (const auto& entry : std::filesystem::directory_iterator(folder / "monitors")) files.push_back(entry.path());
  std::sort(files.begin() + 3, files.end());
  for (const auto& file : files) {
    if (!std::filesystem::exists(file)) continue;
    const SeriesTable table = read_series(file);
    if (!has_column(table, name)) continue;
    const bool of_rags = has_column(table, "rag");
    const ObservableRecord* record = find_observable(name);
    Course course{.time = {}, .value = {}, .period = record ? record->period() : 0};
    for (std::size_t i = 0; i < table.values.front().size(); ++i) {
      if (of_rags && (table.column("rag")[i] != 0 || !is_there(table, i))) continue;
      course.time.push_back(table.column("time")[i]), course.value.push_back(table.column(name)[i]);
    }
    return course;
  }
  throw Error(ExitCode::usage, folder.string() + ": no monitor of the run has a column \"" + name + "\"; an observable is one of " +
                                   joined(observable_ids()) + ", or a column of a monitor");
}

}  // namespace

void run_in_folder(const std::string& case_text, const std::vector<std::string>& overrides, const std::filesystem::path& folder,
                   Prepared& prepared) {
  auto case_file = folder;
  case_file += ".toml";
  int done = 0, begun = 0;
  on_all_ranks(MPI_COMM_WORLD, [&] {
    std::filesystem::create_directories(folder.parent_path());
    if (rank_of(MPI_COMM_WORLD) == 0) write_atomically(case_file, case_text);
    done = is_done(folder), begun = std::filesystem::exists(folder / "checkpoint");
  });
  MPI_Bcast(&done, 1, MPI_INT, 0, MPI_COMM_WORLD);
  MPI_Bcast(&begun, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (done) return;
  const ExitCode code = run_case({.case_file = case_file,
                                  .out = folder,
                                  .overrides = overrides,
                                  .resume = begun != 0,
                                  .overwrite = begun == 0,
                                  .prepared = &prepared});
  if (code == ExitCode::stopped)
    throw Error(code, folder.string() + ": the run was stopped; start the same diagnosis again, it continues from the checkpoint");
  if (code != ExitCode::ok)
    throw Error(code, "exit code " + std::to_string(static_cast<int>(code)) + "; the reason is in " + (folder / "log.txt").string());
}

std::vector<double> read_observables(const std::filesystem::path& folder, const std::vector<ObservableRequest>& asked,
                                     const ObserveSettings& camera) {
  std::map<std::type_index, std::any> sources;
  std::map<std::string, Course> courses;
  const auto course = [&](const std::string& name) -> const Course& {
    if (!courses.contains(name)) courses[name] = course_of(folder, name);
    return courses.at(name);
  };
  const auto mean_in_window = [&](const ObservableRecord& record) {
    WindowMean mean;
    const Course& of = course(record.id);
    for (std::size_t i = 0; i < of.time.size(); ++i) {
      const double t = of.time[i];
      if (camera.in_window({course("x").at(t), course("y").at(t), course("z").at(t)})) mean.add(of.value[i], of.period);
    }
    return mean.value();
  };
  std::vector<double> values;
  for (const ObservableRequest& one : asked) {
    const std::string& name = one.observable;
    const ObservableRecord* record = find_observable(name);
    if (record && record->is_of_whole_run()) {
      const auto& in_folder = observable_sources().at(record->read.source()).in_folder;
      const auto [source, is_new] = sources.try_emplace(record->read.source());
      if (is_new && in_folder) source->second = in_folder(folder);
      values.push_back(source->second.has_value() ? record->read(source->second) : nan);
      continue;
    }
    if (!std::isnan(one.time))
      values.push_back(course(name).at(one.time));
    else
      values.push_back(record && camera.has_window() ? mean_in_window(*record) : course(name).mean_of_last_half());
  }
  return values;
}

}  // namespace snag
