#include "simulation/study.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/atomic_file.hpp"
#include "base/explained.hpp"
#include "base/folder_lock.hpp"
#include "base/log.hpp"
#include "base/quotation.hpp"
#include "base/sha256.hpp"
#include "base/words.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "simulation/output/summary.hpp"
#include "simulation/run.hpp"
#include "simulation/setup/prepared.hpp"

namespace snag {

namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr std::size_t most_runs = 10'000;  // of all combinations: more are a forgotten zip = true, and would fill the memory

/// As short as it is exact.
std::string written(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// What may stand in the name of a folder.
std::string folder_word(const std::string& text) {
  std::string word;
  for (const char c : text) word += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' ? c : '_';
  return word;
}

std::size_t n_values(const VarySettings& vary) { return std::max(vary.values.size(), vary.texts.size()); }

/// Adds one choice of values as a run.
void add_run(Study& study, const std::vector<std::size_t>& choice) {
  StudyRun run;
  run.overrides = study.settings.set;
  for (std::size_t v = 0; v < study.vary.size(); ++v) {
    const VarySettings& vary = study.vary[v];
    const bool is_number = !vary.values.empty();
    const std::string value = is_number ? written(vary.values[choice[v]]) : vary.texts[choice[v]];
    run.values.push_back(value);
    run.overrides.push_back(vary.key + "=" + value);
    if (!vary.with.empty()) run.overrides.push_back(vary.with[choice[v]]);
    run.name += (run.name.empty() ? "" : "_") + folder_word(vary.name) + "-" + folder_word(value);
  }
  study.runs.push_back(run);
}

void expand_runs(Study& study) {
  const std::string where = "[[vary]]";
  if (study.vary.empty()) throw Error(ExitCode::usage, where + " is missing: nothing varies; add one with key and values");
  std::size_t n = 1;
  for (const VarySettings& vary : study.vary) {
    if (vary.values.empty() == vary.texts.empty())
      throw Error(ExitCode::usage, where + " key = \"" + shortened(vary.key) + "\": give either values (numbers) or texts");
    if (!vary.with.empty() && vary.with.size() != n_values(vary))
      throw Error(ExitCode::usage, where + " key = \"" + shortened(vary.key) + "\" has " + std::to_string(n_values(vary)) +
                                       " values, with has " + std::to_string(vary.with.size()) + "; give one KEY=VALUE for each value");
    if (study.settings.zip && n_values(vary) != n_values(study.vary[0]))
      throw Error(ExitCode::usage, where + " key = \"" + shortened(vary.key) + "\" has " + std::to_string(n_values(vary)) + " values, \"" +
                                       shortened(study.vary[0].key) + "\" has " + std::to_string(n_values(study.vary[0])) +
                                       "; with zip = true all need as many");
    n = std::min(n * n_values(vary), 1000 * most_runs);  // no overflow
  }
  if (!study.settings.zip && n > most_runs)
    throw Error(ExitCode::usage,
                where + ": all combinations of the values are more than " + std::to_string(most_runs) +
                    " runs; give fewer values, or zip = true, which combines the first values of all keys, then the second");
  if (study.settings.zip) {
    for (std::size_t i = 0; i < n_values(study.vary[0]); ++i) add_run(study, std::vector<std::size_t>(study.vary.size(), i));
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<std::size_t> choice(study.vary.size());
      for (std::size_t v = study.vary.size(), rest = i; v-- > 0; rest /= n_values(study.vary[v]))
        choice[v] = rest % n_values(study.vary[v]);
      add_run(study, choice);
    }
  }
  std::set<std::string> names;
  for (const StudyRun& run : study.runs)
    if (!names.insert(run.name).second)
      throw Error(ExitCode::usage, where + ": two runs would be named \"" + shortened(run.name) +
                                       "\"; remove the duplicate value, or give the keys different names");
}

/// The keys of [plateau] that name a [[vary]].
void check_names(const Study& study, const std::filesystem::path& file) {
  std::vector<std::string> names, numbers;
  for (const VarySettings& vary : study.vary) {
    names.push_back(vary.name);
    if (!vary.values.empty()) numbers.push_back(vary.name);
  }
  const auto check = [&](const std::string& key, const std::string& name, const std::vector<std::string>& known, const std::string& what) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    throw Error(ExitCode::usage, file.string() + ": [plateau] " + key + " has \"" + shortened(name) +
                                     "\", which is not the name of a [[vary]]" + what +
                                     "; there are: " + (known.empty() ? "none" : joined(known)));
  };
  check("x", study.plateau->x, numbers, " with values");
  for (const std::string& name : study.plateau->physical) check("physical", name, names, "");
  if (study.plateau->results.empty())
    throw Error(ExitCode::usage, file.string() + ": [plateau] results is empty; give keys of summary.json that must agree");
}

/// Results and axes that no summary can hold would be empty columns after hours of runs.
void check_keys(const Study& study, const std::filesystem::path& file) {
  const std::vector<std::string> known = summary_keys();
  const auto check = [&](const std::string& where, const std::string& key) {
    for (const VarySettings& vary : study.vary)
      if (where != "[study] results" && key == vary.name) return;
    std::string plain;  // with 0 for each number
    for (const std::string& word : split(key, '.')) {
      const bool is_number = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
      plain += (plain.empty() ? "" : ".") + (is_number ? "0" : word);
    }
    if (std::find(known.begin(), known.end(), plain) != known.end()) return;
    const std::string near = nearest_name(plain, known);
    throw Error(ExitCode::usage, file.string() + ": " + where + " has \"" + shortened(key) + "\", which is not a key of summary.json" +
                                     (near.empty() ? "" : "; did you mean \"" + near + "\"?") + "; known: " + joined(known) +
                                     " (0 stands for any number)");
  };
  for (const std::string& key : study.settings.results) check("[study] results", key);
  for (const StudyPlotSettings& plot : study.plots) {
    check("[[plot]] x", plot.x);
    for (const std::string& key : plot.y) check("[[plot]] y", key);
  }
  if (!study.plateau) return;
  for (const std::string& key : study.plateau->results) check("[plateau] results", key);
  check_names(study, file);
}

/// What a run is made of, to see on a repetition whether it is still the same: the case, and the files that it names.
struct RunInput {
  std::string text, files;
};

/// SHA-256 of files. A file that has not changed since is not read again: all runs of a study may have one mesh.
class FileHashes {
 public:
  /// Nothing if the file cannot be read.
  std::optional<std::string> of(const std::filesystem::path& file) {
    std::error_code no_time, no_size;
    const auto written = std::filesystem::last_write_time(file, no_time);
    const auto size = std::filesystem::file_size(file, no_size);
    const auto known = known_.find(file);
    if (!no_time && !no_size && known != known_.end() && known->second.written == written && known->second.size == size)
      return known->second.hash;
    const auto content = file_text(file);
    if (!content) return std::nullopt;
    return known_.insert_or_assign(file, Known{written, size, sha256(*content)}).first->second.hash;
  }

 private:
  struct Known {
    std::filesystem::file_time_type written;
    std::uintmax_t size;
    std::string hash;
  };
  std::map<std::filesystem::path, Known> known_;
};

/// A line for each file that stands between quotes, with what is in it. `folder`: of the case.
std::string contents_of_files(std::string text, const std::filesystem::path& folder, FileHashes& hashes) {
  std::string lines;
  std::replace(text.begin(), text.end(), '\'', '"');
  for (const std::string& part : split(text, '"')) {  // also what stands outside of quotes: a comment may have a single one
    std::error_code ignored;
    if (part.empty() || !std::filesystem::is_regular_file(folder / part, ignored)) continue;
    if (const auto hash = hashes.of(folder / part)) lines += "# " + part + ": sha256 " + *hash + "\n";
  }
  return lines;
}

RunInput input_of(const Study& study, const StudyRun& run, FileHashes& hashes) {
  const auto text = file_text(study.case_file);
  if (!text) throw Error(ExitCode::io, study.case_file.string() + ": the case of the study cannot be read; check the path");
  RunInput input{*text + "\n# The study runs this with\n", ""};
  for (const std::string& one : run.overrides) input.text += "# --set " + one + "\n";
  input.files = contents_of_files(input.text, study.case_file.parent_path(), hashes);
  return input;
}

enum class RunState : int { nothing, ended, stopped, partial };

/// What an earlier start of the study left of a run; a partial one has begun and has no summary.
struct PreviousRun {
  RunState state;
  ExitCode code = ExitCode::ok;  // of one that has ended
};

PreviousRun previous_run(const std::filesystem::path& folder, const RunInput& input) {
  if (!std::filesystem::exists(folder / "monitors")) return {RunState::nothing};
  const auto before = file_text(folder / "input.toml");
  // Runs of earlier versions do not say what was in the files.
  if (before != input.text + input.files && before != input.text)
    throw Error(ExitCode::usage, folder.string() +
                                     ": has a run of another case, of other values or of other files (as a mesh that was made again) than "
                                     "the study (see its input.toml); choose another --out, or remove the folder");
  const auto summary = nlohmann::json::parse(file_text(folder / "summary.json").value_or(""), nullptr, false);
  if (!summary.is_object()) return {RunState::partial};
  const int code = summary.value("exit", -1);
  for (const ExitCode end : {ExitCode::ok, ExitCode::diverged, ExitCode::invariant})
    if (code == static_cast<int>(end)) return {RunState::ended, end};
  return {code == static_cast<int>(ExitCode::stopped) ? RunState::stopped : RunState::partial};
}

PreviousRun prepare(const std::filesystem::path& folder, const Study& study, const StudyRun& run, FileHashes& hashes) {
  int before[2] = {0, 0};
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    const RunInput input = input_of(study, run, hashes);
    const PreviousRun found = previous_run(folder, input);
    before[0] = static_cast<int>(found.state), before[1] = static_cast<int>(found.code);
    if (found.state != RunState::nothing) return;  // an earlier version did not say what was in the files: it stays unknown
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    write_atomically(folder / "input.toml", input.text + input.files);
  });
  MPI_Bcast(before, 2, MPI_INT, 0, world);
  return {static_cast<RunState>(before[0]), static_cast<ExitCode>(before[1])};
}

bool has_checkpoint(const std::filesystem::path& folder) {
  try {
    const CheckpointReader newest(world, folder);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The codes of a failure that concerns one run only: its flow, its rags, its mesh, or a value of it that is refused, as a pose that cannot
/// be made. What the others need as well (the disk, the memory) has other codes.
bool is_of_one_run(ExitCode code) {
  return code == ExitCode::diverged || code == ExitCode::invariant || code == ExitCode::mesh || code == ExitCode::usage;
}

/// Runs one; the code with which it ended or failed. Throws Error where the failure is not of this run alone.
ExitCode run_one(const Study& study, const StudyRun& run, const std::filesystem::path& folder, RunState before,
                 const ReportWriter& write_report, Prepared& prepared) {
  RunOptions options{
      .case_file = study.case_file, .out = folder, .overrides = run.overrides, .write_report = write_report, .prepared = &prepared};
  if (before != RunState::nothing) {
    options.resume = has_checkpoint(folder / "checkpoint");
    options.overwrite = !options.resume;
  }
  try {
    return run_case(options);
  } catch (const std::exception& failure) {
    const Error error = explained(failure);
    if (is_of_one_run(error.code)) log::error(run.name + ": " + error.what());
    leave_together(error);
    if (!is_of_one_run(error.code)) throw error;
    return error.code;
  }
}

/// Table and plots of the runs that there are. Collective; throws Error(io).
void write_results(const Study& study, const std::filesystem::path& folder, const StudyOptions& options) {
  std::string results;
  on_all_ranks(world, [&] {
    if (rank_of(world) == 0) results = options.write_results(study, folder);
  });
  log::info(results);
  log::info("study: " + (folder / "study.csv").string() + " and " + (folder / "study.html").string());
}

/// The same after a failure that ends the study; the failure goes on to the command line.
void write_results_after(const Error& failure, Study& study, StudyRun& run, const std::filesystem::path& folder,
                         const StudyOptions& options) {
  run.failed_with = static_cast<int>(failure.code);
  try {
    write_results(study, folder, options);
  } catch (const Error& second) {
    log::warning(std::string("no table of the study: ") + second.what());
  }
}

}  // namespace

Section StudySettings::section() {
  Parameter file = file_setting("case", &case_file, "Case file, relative to the study file.");
  file.required = true;
  return {"study",
          "A case that is run with several values of its keys, by `snag study STUDY.toml --out DIR`.",
          {setting("name", &name, "Short name, used for the folder and the table."), setting("description", &description, "One sentence."),
           file, setting("set", &set, "Values that replace those of the case in all runs, as for --set: \"time.end_s=0.2\"."),
           setting("zip", &zip,
                   "true: the first values of all [[vary]] make the first run, the second values the second run. false: all combinations."),
           setting("results", &results, "Keys of summary.json in the table of results: \"pump.head_m\", \"rags.0.outcome\".")}};
}

Section VarySettings::section() {
  Parameter required = setting("key", &key, "Key of the case as for --set: \"boundary.0.flow_rate_L_s\".");
  required.required = true;
  return {"vary",
          "A key of the case whose value differs between the runs.",
          {required,
           setting("name", &name, "Name in the table and in the names of the runs; by default the last word of the key."),
           {"values", &values, "1", -infinity, infinity, Basis::assumed, "Numbers, in the unit of the key."},
           setting("texts", &texts, "Texts instead of numbers; a number with a unit (\"12 mm\") is a text."),
           setting("with", &with, "What goes with each value, as for --set: \"initial_flow.from='results/fine'\" with a mesh.")},
          true};
}

Section StudyPlotSettings::section() {
  return {"plot",
          "A plot of the results: one line for each key of y, over all runs in the order of x.",
          {setting("title", &title, "Title of the plot."), setting("x", &x, "Name of a [[vary]], or a key of summary.json."),
           setting("y", &y, "Keys of summary.json."), setting("x_label", &x_label, "Label of the x axis with the unit; by default x."),
           setting("y_label", &y_label, "Label of the y axis with the unit; by default the first key of y.")},
          true};
}

Section PlateauSettings::section() {
  Parameter of = setting("x", &x, "Name of a [[vary]] with numbers, of which the results should not depend: a kernel width, a step.");
  Parameter on =
      setting("results", &results, "Keys of summary.json that must agree: best those that precede chaos, rags.0.before_contact.");
  of.required = on.required = true;
  return {
      "plateau",
      "Looks for the values of one key over which the results depend neither on it nor on the other keys that vary, and recommends one; "
      "where there is none, the page says so.",
      {of,
       on,
       {"tolerance", &tolerance, "1", 1e-6, 1, Basis::assumed, "Largest deviation of a result from its mean over the plateau, relative."},
       {"n_least", &n_least, "1", 2, 1000, Basis::assumed, "Values of x that a plateau must have."},
       setting(
           "recommend", &recommend,
           "Which value of the plateau to use: middle, far from both ends, for a width; largest for a step or a size of cells, where it "
           "saves time; smallest.",
           {"middle", "largest", "smallest"}),
       setting("physical", &physical,
               "Names of [[vary]] on which results may depend: a plateau is then common to all their values, with a mean for each.")}};
}

std::vector<Section> study_sections() {
  static StudySettings study;
  static VarySettings vary;
  static StudyPlotSettings plot;
  static PlateauSettings plateau;
  return {study.section(), vary.section(), plot.section(), plateau.section()};
}

Study read_study(const std::filesystem::path& file) {
  const CaseFile text = CaseFile::read(file);
  Study study;
  const Table root = text.root();
  root.table("study").read(study.settings.section().parameters);
  for (const Table& table : root.tables("vary")) {
    VarySettings& vary = study.vary.emplace_back();
    table.read(vary.section().parameters);
    if (vary.name.empty()) vary.name = split(vary.key, '.').back();
    if (std::count_if(study.vary.begin(), study.vary.end(), [&](const VarySettings& one) { return one.name == vary.name; }) > 1)
      throw Error(ExitCode::usage, table.where() + ": another [[vary]] has the name \"" + vary.name +
                                       "\" too, by which columns are named; give it a name of its own");
  }
  for (const Table& table : root.tables("plot")) table.read(study.plots.emplace_back().section().parameters);
  if (root.has("plateau")) root.table("plateau").read(study.plateau.emplace().section().parameters);
  text.reject_unread();
  study.case_file = text.path(study.settings.case_file);
  expand_runs(study);
  check_keys(study, file);
  return study;
}

ExitCode run_study(const StudyOptions& options) {
  Study study = read_study(options.study_file);
  if (!file_text(study.case_file))
    throw Error(ExitCode::io,
                options.study_file.string() + ": [study] case \"" + study.case_file.string() + "\" cannot be read; check the path");
  const auto folder = options.out.empty() ? std::filesystem::path("results") / folder_word(study.settings.name) : options.out;
  std::optional<FolderLock> lock;
  on_all_ranks(world, [&] {
    if (rank_of(world) == 0 && !options.dry_run) lock.emplace(folder);
  });
  ExitCode worst = ExitCode::ok;
  Prepared prepared;
  FileHashes hashes;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    StudyRun& run = study.runs[i];
    const std::string which = "run " + std::to_string(i + 1) + " of " + std::to_string(study.runs.size()) + ": " + run.name;
    if (options.dry_run) {
      log::info(which + "\n  " + joined(run.overrides));
      continue;
    }
    const PreviousRun before = prepare(folder / run.name, study, run, hashes);
    const bool has_ended = before.state == RunState::ended;
    log::info(which + (has_ended ? " has been run before" : ""));
    ExitCode code = before.code;
    try {
      if (!has_ended) code = run_one(study, run, folder / run.name, before.state, options.write_report, prepared);
    } catch (const Error& failure) {
      write_results_after(failure, study, run, folder, options);
      throw;
    }
    if (code == ExitCode::stopped) return code;
    run.failed_with = static_cast<int>(code);
    if (worst == ExitCode::ok) worst = code;
  }
  if (options.dry_run) return worst;
  write_results(study, folder, options);
  return worst;
}

}  // namespace snag
