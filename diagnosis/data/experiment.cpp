#include "diagnosis/data/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <toml++/toml.h>

#include "base/atomic_file.hpp"
#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "base/words.hpp"
#include "diagnosis/data/experiment_table.hpp"
#include "diagnosis/data/repeats_of_row.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

constexpr const char* kinds[] = {"gaussian", "lognormal", "count", "event", "angle"};

struct ObservableTable {
  Observable observable;
  std::string kind = "gaussian";

  Section section() {
    return {
        "observable",
        "A measured quantity; its values are in the data file.",
        {{.key = "id",
          .target = &observable.id,
          .unit = "",
          .meaning = "Name of the measured quantity, one that the simulation also gives.",
          .required = true},
         {.key = "unit",
          .target = &observable.unit,
          .unit = "",
          .meaning = "Unit of the values and of the uncertainties.",
          .required = true},
         setting("kind", &kind,
                 "Distribution of repeats. Uncertainties of a lognormal quantity are relative, all others have the unit of the quantity. "
                 "orientation, which repeats after half a turn, is taken as an angle if the kind is gaussian.",
                 {std::begin(kinds), std::end(kinds)}),
         {.key = "noise_u",
          .target = &observable.noise_u,
          .minimum = 0,
          .meaning = "Standard uncertainty of one sample; 0: from the scatter of the repeats."},
         {.key = "bias_u",
          .target = &observable.bias_u,
          .minimum = 0,
          .meaning = "Standard uncertainty that all samples of the calibration group share."},
         {.key = "numerics_u",
          .target = &observable.numerics_u,
          .minimum = 0,
          .meaning =
              "Standard uncertainty of the simulated value by grid and step, from your own study. Where all observables have it, no run "
              "is repeated with another step."},
         setting("calibration_group", &observable.calibration_group,
                 "Name of the group of observables that share one bias: the same number for each. Axes whose errors differ need groups of "
                 "their own.")},
        true};
  }
};

Observable read_observable(const Table& table) {
  ObservableTable keys;
  table.read(keys.section().parameters);
  Observable& observable = keys.observable;
  observable.kind = static_cast<Observable::Kind>(std::find(std::begin(kinds), std::end(kinds), keys.kind) - std::begin(kinds));
  const ObservableRecord* record = find_observable(observable.id);
  if (record && record->period() > 0 && observable.kind == Observable::Kind::gaussian) observable.kind = Observable::Kind::angle;
  const auto unit = parse_unit(observable.unit);
  if (!unit || observable.unit.empty())
    throw Error(ExitCode::usage, table.where() + " " + observable.id + ": unknown unit \"" + observable.unit +
                                     "\"; write one such as \"m\", \"mm/s\", \"deg\", or \"1\" for a pure number");
  if (record && parse_unit(record->unit)->exponents != unit->exponents)
    throw Error(ExitCode::usage, table.where() + " " + observable.id + ": the unit \"" + observable.unit + "\" must be of the kind of \"" +
                                     record->unit + "\", in which runs give " + observable.id + "; write the unit of the data");
  if (observable.kind != Observable::Kind::lognormal)
    for (double* u : {&observable.noise_u, &observable.bias_u, &observable.numerics_u}) *u *= unit->factor;
  return observable;
}

struct PointTable {
  OperatingPoint point;
  std::string case_file, role = "train";

  Section section() {
    Parameter case_setting = file_setting("case", &case_file, "Case file of the base model at this operating point.");
    case_setting.required = true;
    return {
        "point",
        "An operating point: a case file and the data measured there. The table [point.input_u] states relative standard uncertainties of "
        "numbers of the case, by their names in case.resolved.toml, and of the drag law (drag_law_uncertainty).",
        {{.key = "id", .target = &point.id, .unit = "", .meaning = "Name of the operating point.", .required = true},
         case_setting,
         setting("set", &point.set, "Values of the case that this point replaces, as for --set: \"time.end_s=0.2\"."),
         setting("role", &role, "train: the data are fitted; withheld: the data only test how far the gap shrinks.", {"train", "withheld"}),
         setting("group", &point.group,
                 "Name of a group of points that were measured together: on one day, with one set-up, at one speed. That their calibration "
                 "is off, by a factor or an offset, is then a hypothesis of its own (scale:GROUP, offset:OBSERVABLE@GROUP).")},
        true};
  }
};

OperatingPoint read_point(const Table& table, const CaseFile& file) {
  PointTable keys;
  table.read(keys.section().parameters);
  OperatingPoint& point = keys.point;
  point.case_file = file.path(keys.case_file);
  point.withheld = keys.role == "withheld";
  point.where = table.where();
  if (point.group.find('+') != std::string::npos)
    throw Error(ExitCode::usage, table.where() + " group \"" + point.group + "\" has a +, which joins names of hypotheses; leave it out");
  point.input_u = table.table("input_u").numbers();
  for (const auto& [key, u] : point.input_u) {
    if (!std::isfinite(u) || u < 0)
      throw Error(ExitCode::usage,
                  table.where() + " input_u \"" + key + "\" is " + number_text(u) + "; it is a relative standard uncertainty, 0 or more");
  }
  return point;
}

Section region_section(Region& region) {
  constexpr double far = 1e9;
  return {"region",
          "A box in which the gap is looked for, besides those that the diagnosis makes itself.",
          {{.key = "id", .target = &region.id, .unit = "", .meaning = "Name of the region.", .required = true},
           {"lower", &region.lower, "m", -far, far, Basis::assumed, "Lowest corner; without it the region has no lower end."},
           {"upper", &region.upper, "m", -far, far, Basis::assumed, "Highest corner; without it the region has no upper end."}},
          true};
}

Region read_region(const Table& table) {
  Region region;
  table.read(region_section(region).parameters);
  for (int axis = 0; axis < 3; ++axis) {
    if (region.lower[axis] < region.upper[axis]) continue;
    throw Error(ExitCode::usage, table.where() + " " + region.id + ": lower is not below upper along " + "xyz"[axis] + "; swap them");
  }
  return region;
}

template <class Item>
void reject_repeated_ids(const std::vector<Item>& items, const std::string& section, const std::string& file) {
  std::set<std::string> seen;
  for (const Item& item : items) {
    if (!seen.insert(item.id).second)
      throw Error(ExitCode::usage, file + ": [[" + section + "]] \"" + item.id + "\" is given twice" +
                                       (section == "point" ? "; a point serves for training or is withheld, never both" : "") +
                                       "; keep one of them");
  }
}

// One row in SI, and what its kind allows.
void convert(DatumRow& row, const Observable& observable, const std::string& file) {
  using Kind = Observable::Kind;
  Datum& d = row.datum;
  const double factor = parse_unit(observable.unit)->factor;
  d.value *= factor, row.sd *= factor;
  const auto wrong = [&](const std::string& rule) {
    return Error(ExitCode::usage,
                 file + ":" + std::to_string(row.line) + ": " + observable.id + " is " + number_text(d.value) + ", but " + rule);
  };
  if (observable.kind == Kind::lognormal && d.value <= 0) throw wrong("a lognormal quantity is positive");
  const bool several = row.n > 1;
  if (observable.kind == Kind::event && (several ? d.value < 0 || d.value > 1 : d.value != 0 && d.value != 1))
    throw wrong(several ? "the share of several events is 0 to 1" : "an event is 0 or 1");
  if (observable.kind == Kind::count && (d.value < 0 || (!several && d.value != std::floor(d.value))))
    throw wrong("a count is a whole number, 0 or more");
  if (row.sd > 0 && (observable.kind == Kind::event || observable.kind == Kind::count || d.censored))
    throw wrong("the scatter of events, counts and censored times follows from their law; leave sd empty");
  if (d.censored && observable.kind != Kind::lognormal)
    throw wrong("only lognormal quantities (times) may be censored; give " + observable.id + " kind = \"lognormal\"");
  if (d.censored && !std::isnan(d.time)) throw wrong("only scalars of a replicate may be censored; leave t_s empty");
}

auto sort_key(const Datum& d) { return std::tuple(d.point, d.observable, d.replicate, std::isnan(d.time) ? -infinity : d.time); }

bool is_continuous(const Observable& observable) {
  return observable.kind != Observable::Kind::count && observable.kind != Observable::Kind::event;
}

// All repeats of one observable at one point and time.
struct Repeats {
  int n = 0, line = 0;
  double minimum = infinity, maximum = -infinity;
  bool has_sd = false, has_censored = false, lacks_sd = false;  // lacks_sd: a row stands for several repeats whose scatter it does not give
  bool scatter() const { return maximum > minimum || has_sd || has_censored; }
};

// Without noise_u the uncertainty of each number comes from the scatter of its repeats.
void check_scatter(const Experiment& experiment, const std::string& file) {
  constexpr double never = -infinity;  // a scalar has no time
  std::map<std::tuple<int, int, double>, Repeats> all;
  for (const Datum& d : experiment.data) {
    const Observable& observable = experiment.observables[d.observable];
    if (observable.noise_u > 0 || !is_continuous(observable)) continue;
    Repeats& repeats = all[{d.observable, d.point, std::isnan(d.time) ? never : d.time}];
    if (repeats.n == 0) repeats.line = d.line;
    repeats.n += d.n;
    repeats.minimum = std::min(repeats.minimum, d.value), repeats.maximum = std::max(repeats.maximum, d.value);
    repeats.has_sd = repeats.has_sd || d.sd > 0, repeats.has_censored = repeats.has_censored || d.censored;
    repeats.lacks_sd = repeats.lacks_sd || (d.n > 1 && !(d.sd > 0));
  }
  for (const auto& [place, repeats] : all) {
    const auto& [o, p, time] = place;
    if (repeats.n > 1 && repeats.scatter() && !repeats.lacks_sd) continue;
    const std::string what = file + ":" + std::to_string(repeats.line) + ": observable \"" + experiment.observables[o].id +
                             "\" at point \"" + experiment.points[p].id + "\"" +
                             (time == never ? "" : " at t = " + number_text(time) + " s");
    if (repeats.n < 2)
      throw Error(
          ExitCode::usage,
          what + " has one repeat and no noise_u: its scatter is unknown; give noise_u, repeat the measurement, or remove this row");
    throw Error(ExitCode::usage,
                what + " has " + std::to_string(repeats.n) + " repeats without scatter (" + number_text(repeats.minimum) +
                    " SI) and no noise_u: its uncertainty is unknown; give noise_u (for numbers that are rounded to a step: 0.3 of the "
                    "step), or the sd of rows that stand for several repeats");
  }
}

// All samples of one observable at one point.
struct Column {
  bool scalar = false, series = false;
};

void check_columns(const Experiment& experiment, const std::string& file) {
  std::vector<std::map<int, Column>> columns(experiment.observables.size());
  for (const Datum& d : experiment.data) {
    Column& column = columns[d.observable][d.point];
    (std::isnan(d.time) ? column.scalar : column.series) = true;
  }
  for (std::size_t o = 0; o < columns.size(); ++o) {
    const Observable& observable = experiment.observables[o];
    const std::string where = file + ": observable \"" + observable.id + "\"";
    if (columns[o].empty()) throw Error(ExitCode::usage, where + " has no rows; measure it or remove its [[observable]]");
    for (const auto& [p, column] : columns[o]) {
      const std::string at = where + " at point \"" + experiment.points[p].id + "\"";
      if (column.scalar && column.series) throw Error(ExitCode::usage, at + " has rows with and without t_s; make them two observables");
      if (!is_continuous(observable) && column.series)
        throw Error(ExitCode::usage, at + " is a count or an event, which has one value per replicate; leave t_s empty");
    }
  }
}

// What a table declares and no list examines is misspelt in one of them.
void check_declared(const Experiment& experiment, const std::string& file) {
  std::vector<std::pair<std::string, std::string>> declared;  // table, name
  for (const Alternative& alternative : experiment.alternatives) declared.emplace_back("alternative", alternative.effect);
  for (const OwnCandidate& own : experiment.own_candidates) declared.emplace_back("candidate", own.effect.name);
  const auto& examined = experiment.candidates;
  for (const auto& [table, name] : declared)
    if (!examined.empty() && std::find(examined.begin(), examined.end(), name) == examined.end())
      throw Error(ExitCode::usage, file + ": [[" + table + "]] \"" + name + "\" is not among [model] candidates, which are " +
                                       joined(examined) + "; add it there, or remove the table");
}

void check_points(const Experiment& experiment, const std::string& file) {
  std::vector<std::vector<double>> values(experiment.points.size());
  for (const Datum& d : experiment.data) values[d.point].push_back(d.value);
  bool train = false;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const OperatingPoint& point = experiment.points[p];
    if (values[p].empty())
      throw Error(ExitCode::usage, file + ": point \"" + point.id + "\" has no rows; measure it or remove its [[point]]");
    train = train || !point.withheld;
    // A copy of a withheld point under another name would train on what is withheld. (Equal counts, and tests that end at the same time
    // before the event, are no copy.)
    constexpr std::size_t telling = 8;  // distinct values
    if (std::set(values[p].begin(), values[p].end()).size() < telling) continue;
    for (std::size_t q = 0; q < p; ++q) {
      if (experiment.points[q].withheld != point.withheld && values[p] == values[q])
        throw Error(ExitCode::usage,
                    file + ": points \"" + experiment.points[q].id + "\" and \"" + point.id +
                        "\" have the same values, but one is withheld and the other is for training; withheld data must not "
                        "be trained on: take one of them out");
    }
  }
  if (!train) throw Error(ExitCode::usage, file + ": every point is withheld; at least one must have role = \"train\"");
}

/// Tables that stand once.
struct SingleTables {
  std::string data, runs;
  int seed = 1;

  std::vector<Section> sections(Experiment& experiment) {
    Parameter data_file = file_setting("data", &data, "CSV file with the measurements.");
    data_file.required = true;
    return {
        {"experiment",
         "The measurements.",
         {setting("name", &experiment.name, "Name of the experiment; by default that of the file."), data_file}},
        {"model",
         "Effects that may cause the gap.",
         {setting("candidates", &experiment.candidates,
                  "Names of the effects that are examined, or \"all\"; by default all that fit the case."),
          setting("pairs", &experiment.pairs, "Whether pairs of effects are examined, too.")}},
        {"budget",
         "Effort of the diagnosis. The table [budget.cost] states what a test with another value of an uncertain input costs, in repeats "
         "of a test; 1 where it does not.",
         {{"max_runs", &experiment.max_runs, "1", 10, 1e9, Basis::assumed, "Largest number of runs of the model."},
          {"seed", &seed, "1", 0, 2147483647, Basis::assumed, "Seed of the random numbers."},
          renamed(file_setting("runs_table", &runs, "Table of runs that were made before, by whatever build: a copy of a runs.tsv."),
                  {.key = "runs"})}}};
  }
};

// candidates = "all" or a list of names: the only key that is a text or a list.
std::vector<std::string> overrides_of_candidates(const std::string& text) {
  try {
    const auto candidates = toml::parse(text)["model"]["candidates"].value<std::string>();
    if (candidates && *candidates == "all") return {"model.candidates=[]"};
  } catch (const toml::parse_error&) {  // CaseFile names it with its line
  }
  return {};
}

}  // namespace

std::string calibration_of(const Observable& observable) {
  return observable.calibration_group.empty() ? "bias of " + observable.id : observable.calibration_group;
}

std::vector<Section> experiment_sections() {
  // The records point into these.
  static Experiment experiment;
  static SingleTables single;
  static ObservableTable observable;
  static PointTable point;
  static Region region;
  std::vector<Section> all = single.sections(experiment);
  for (Section section : {observable.section(), point.section(), region_section(region)}) all.push_back(std::move(section));
  all.push_back(own_candidate_section());
  for (Section& section : alternative_sections()) all.push_back(std::move(section));
  return all;
}

CaseFile experiment_file(const std::filesystem::path& path) {
  const auto text = file_text(path);
  if (!text) throw Error(ExitCode::io, path.string() + ": cannot be read; check the path");
  return CaseFile::read(path, overrides_of_candidates(*text));
}

Experiment read_experiment(const std::filesystem::path& path) { return read_experiment(experiment_file(path)); }

Experiment read_experiment(const CaseFile& file) {
  const std::filesystem::path& path = file.file();
  const Table root = file.root();
  Experiment experiment;
  SingleTables keys;
  for (const Section& section : keys.sections(experiment)) root.table(section).read(section.parameters);
  for (const Table& table : root.tables("observable")) experiment.observables.push_back(read_observable(table));
  for (const Table& table : root.tables("point")) experiment.points.push_back(read_point(table, file));
  for (const Table& table : root.tables("region")) experiment.regions.push_back(read_region(table));
  std::vector<std::string> points;
  for (const OperatingPoint& point : experiment.points) points.push_back(point.id);
  experiment.alternatives = read_alternatives(root, points);
  experiment.own_candidates = read_own_candidates(root);
  if (!keys.runs.empty()) experiment.runs = file.path(keys.runs);
  experiment.seed = static_cast<std::uint64_t>(keys.seed);
  const Table costs = root.table("budget").table("cost");
  experiment.costs = costs.numbers();
  for (const auto& [key, cost] : experiment.costs)
    if (!(cost > 0))
      throw Error(ExitCode::usage, costs.where() + " \"" + key + "\" is " + number_text(cost) + "; a cost is more than 0 repeats");
  file.reject_unread();
  if (experiment.name.empty()) experiment.name = path.stem().string();
  const std::string name = path.string();
  if (experiment.observables.empty()) throw Error(ExitCode::usage, name + ": no [[observable]]; at least one is needed");
  if (experiment.points.empty()) throw Error(ExitCode::usage, name + ": no [[point]]; at least one is needed");
  reject_repeated_ids(experiment.observables, "observable", name);
  reject_repeated_ids(experiment.points, "point", name);
  reject_repeated_ids(experiment.regions, "region", name);
  check_declared(experiment, name);

  const std::string data_name = file.path(keys.data).string();
  const auto data_text = file_text(data_name);
  if (!data_text) throw Error(ExitCode::io, data_name + ": the data cannot be read; check [experiment] data of " + name);
  DataTable table = read_data_table(*data_text, data_name, experiment);
  std::vector<std::pair<Datum, int>> samples;  // with their lines
  for (DatumRow& row : table.rows) {
    const Observable& observable = experiment.observables[row.datum.observable];
    convert(row, observable, data_name);
    // Of a path only the mean and the scatter at each time are known of its repeats, not how long the deviation of one repeat lasts.
    if (row.n == 1 || !std::isnan(row.datum.time))
      row.datum.n = row.n, row.datum.sd = row.sd, samples.emplace_back(row.datum, row.line);
    else
      for (const Datum& repeat : repeats_of(row, observable)) samples.emplace_back(repeat, row.line);
  }
  std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return sort_key(a.first) < sort_key(b.first); });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && sort_key(samples[i - 1].first) == sort_key(samples[i].first))
      throw Error(ExitCode::usage, data_name + ":" + std::to_string(samples[i].second) +
                                       ": the same point, replicate, time and observable as line " + std::to_string(samples[i - 1].second) +
                                       "; keep one of them");
    experiment.data.push_back(samples[i].first);
    experiment.data.back().line = samples[i].second;
  }
  experiment.data_sha256 = table.data_sha256, experiment.withheld_sha256 = table.withheld_sha256;
  check_points(experiment, data_name);
  check_columns(experiment, data_name);
  check_scatter(experiment, data_name);
  return experiment;
}

}  // namespace snag
