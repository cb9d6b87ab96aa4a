#include "app/observe.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "app/look.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "report/volute_page.hpp"

namespace snag {

namespace {

using std::filesystem::path;

std::string name_of(const path& subject) { return std::filesystem::weakly_canonical(subject).filename().string(); }

bool is_table(const path& subject) { return subject.extension() == ".csv"; }

void check_groups(const std::vector<ObserveGroup>& groups) {
  for (const ObserveGroup& group : groups) {
    if (group.subjects.empty())
      throw Error(ExitCode::usage,
                  "snag observe: " + (group.name.empty() ? "nothing to observe" : "--group " + group.name + " has no subject") +
                      "; name folders of pictures or of runs");
    if (group.name.find_first_of("/,\"") != std::string::npos || group.name.starts_with('.'))
      throw Error(ExitCode::usage, "snag observe: --group \"" + group.name +
                                       "\" names a folder and a field of a table: no / , or \" in it, no dot first; choose another name");
    if (!group.name.empty() && groups.size() < 2)
      throw Error(ExitCode::usage, "snag observe: one group (\"" + group.name +
                                       "\"), there must be at least two to compare; give --group NAME SUBJECT ... again");
  }
}

/// What lies beside a path that does not exist: the nearest name, or all where they are few.
std::string near_it(const path& missing) {
  const path parent = missing.has_parent_path() ? missing.parent_path() : path(".");
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(parent, failure)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  if (failure) return "; nor does the folder " + parent.string() + "; check the path";
  const std::string near = nearest_name(missing.filename().string(), names);
  if (!near.empty()) return "; did you mean " + (parent / near).string() + "?";
  constexpr std::size_t few = 12;
  return names.empty() || names.size() > few ? "; check the path" : "; the folder " + parent.string() + " holds: " + joined(names);
}

void check_subjects(const std::vector<ObserveGroup>& groups, bool has_camera) {
  std::size_t n_subjects = 0, n_tables = 0;
  for (const ObserveGroup& group : groups)
    for (const path& subject : group.subjects) {
      if (!std::filesystem::exists(subject)) throw Error(ExitCode::io, subject.string() + ": does not exist" + near_it(subject));
      if (!has_camera && !is_table(subject) && !is_run(subject))
        throw Error(ExitCode::usage,
                    subject.string() + ": is not the output folder of a run, and pictures need a camera; give --camera CAMERA.toml");
      ++n_subjects, n_tables += is_table(subject);
    }
  if (n_tables > 0 && n_subjects > 1)
    throw Error(ExitCode::usage, "snag observe: a table of repeats (.csv) has its own column of groups; give the table alone");
}

/// Writes groups.csv and anova.csv.
void write_comparison(const Repeats& repeats, const std::string& where, const path& folder) {
  const std::vector<GroupComparison> comparisons = compare_groups(repeats, where);
  std::filesystem::create_directories(folder);
  write_atomically(folder / "groups.csv", groups_csv(comparisons, repeats));
  write_atomically(folder / "anova.csv", anova_csv(comparisons));
  log::info("do the means of the groups differ?\n" + words_of(comparisons));
  log::info("comparison: " + (folder / "anova.csv").string());
}

/// Folder of a subject: a number follows the name where it is taken.
path folder_of(const path& parent, const path& subject, std::map<path, int>& taken) {
  const path folder = parent / name_of(subject);
  const int before = taken[folder]++;
  return before == 0 ? folder : path(folder.string() + "_" + std::to_string(before + 1));
}

void add_samples(Repeats& repeats, int group, int rag, const PictureFindings& found) {
  for (const std::vector<double>& values : found.samples()) repeats.rows.push_back({group, rag, values});
}

/// Adds what there is of the volute.
void add_volutes(std::vector<NamedVolute>& volutes, const std::string& group, const Findings& found) {
  const bool both = found.volute.n_rags() > 0 && found.volute_seen.n_rags() > 0;
  const std::string name = group.empty() ? "rags" : group;
  if (found.volute.n_rags() > 0) volutes.push_back({name, found.volute});
  if (found.volute_seen.n_rags() > 0) volutes.push_back({name + (both ? " as they are seen" : ""), found.volute_seen});
}

void write_volute_page(const std::vector<NamedVolute>& volutes, const path& folder) {
  if (volutes.empty()) return;
  write_atomically(folder / "volute.html", volute_page(volutes));
  log::info("in the volute: " + (folder / "volute.html").string());
}

/// Observes all subjects into folders of their own, then writes the groups and the whole.
void observe_groups(const ObserveOptions& options, const Camera* camera, const path& folder) {
  Findings all;
  std::vector<NamedVolute> volutes;
  Repeats repeats;
  repeats.quantities = PictureFindings::quantities();
  std::map<path, int> taken;
  std::uint64_t n_observed = 0;
  for (std::size_t g = 0; g < options.groups.size(); ++g) {
    const ObserveGroup& group = options.groups[g];
    const path group_folder = folder / group.name;
    Findings of_group;
    for (std::size_t s = 0; s < group.subjects.size(); ++s) {
      const path own = folder_of(group_folder, group.subjects[s], taken);
      std::filesystem::create_directories(own);
      const Findings found = analyse(group.subjects[s], camera, own, static_cast<std::uint64_t>(options.seed) + n_observed++);
      found.write(own);
      log::info(group.subjects[s].string() + ": " + found.words(false));
      of_group.add(found);
      if (found.pictures) add_samples(repeats, static_cast<int>(g), static_cast<int>(s), *found.pictures);
    }
    repeats.groups.push_back(group.name);
    all.add(of_group);
    add_volutes(volutes, group.name, of_group);
    if (group.name.empty()) continue;
    of_group.write(group_folder);
    log::info("group " + group.name + ": " + of_group.words(true));
  }
  all.write(folder);
  log::info("all: " + all.words(true));
  write_volute_page(volutes, folder);
  if (repeats.groups.size() < 2) return;
  if (camera)
    write_comparison(repeats, "snag observe", folder);
  else
    log::info("the means of the groups are compared of pictures only: for that give --camera CAMERA.toml");
}

}  // namespace

void observe(const ObserveOptions& options) {
  check_groups(options.groups);
  check_subjects(options.groups, !options.camera_file.empty());
  const path& first = options.groups[0].subjects[0];
  const path folder = options.out.empty() ? "results" / path("observe-" + name_of(first)) : options.out;
  if (is_table(first)) return write_comparison(read_repeats(first), first.string(), folder);
  std::optional<Camera> camera;
  if (!options.camera_file.empty()) camera = read_camera(options.camera_file);
  const Camera* view = camera ? &*camera : nullptr;
  if (options.groups.size() > 1 || options.groups[0].subjects.size() > 1) return observe_groups(options, view, folder);
  std::filesystem::create_directories(folder);
  const Findings found = analyse(first, view, folder, static_cast<std::uint64_t>(options.seed));
  found.write(folder);
  log::info(found.words(true));
  std::vector<NamedVolute> volutes;
  add_volutes(volutes, "", found);
  write_volute_page(volutes, folder);
  if (view) log::info("observations: " + (folder / "observations.csv").string());
}

}  // namespace snag
