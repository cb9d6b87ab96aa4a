#include "casework/case_simulator.hpp"

#include <fcntl.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/known_key.hpp"
#include "base/log.hpp"
#include "base/quotation.hpp"
#include "base/sha256.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "casework/input_nuisances.hpp"
#include "casework/mesh_run.hpp"
#include "casework/run_table.hpp"
#include "observe/observables.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// Slots of a point: what the data have, by observable and time, each once. Of a path also two times before its first sample: a clock that
/// starts early asks for them (mistakes.hpp). Not of whole runs, whose numbers may not be known at their start.
std::vector<Slot> slots_of(const Experiment& experiment, int point, bool is_whole_run) {
  std::set<std::pair<int, double>> timed;
  std::set<int> whole;
  for (const Datum& datum : experiment.data) {
    if (datum.point != point) continue;
    if (std::isnan(datum.time))
      whole.insert(datum.observable);
    else
      timed.emplace(datum.observable, datum.time);
  }
  std::map<int, double> first;  // sample of an observable
  for (const auto& [observable, time] : timed) first.emplace(observable, time);
  for (const auto& [observable, time] : first)
    if (!is_whole_run && time > 0) timed.emplace(observable, 0), timed.emplace(observable, 0.5 * time);
  std::vector<Slot> slots;
  for (const auto& [observable, time] : timed) slots.push_back({observable, time});
  for (const int observable : whole) slots.push_back({.observable = observable});
  return slots;
}

/// The largest range of a coordinate in the data: so large a camera's picture is at least.
double picture_size_of(const Experiment& experiment) {
  double size = 0;
  for (std::size_t o = 0; o < experiment.observables.size(); ++o) {
    const ObservableRecord* record = find_observable(experiment.observables[o].id);
    if (!record || !record->is_position()) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Datum& datum : experiment.data)
      if (datum.observable == static_cast<int>(o)) low = std::min(low, datum.value), high = std::max(high, datum.value);
    size = std::max(size, high - low);
  }
  return size;
}

/// Throws Error(usage) for what no run of the case tells. Of a whole run, other names are columns of its monitors.
void check_observable(const PointCase& base, const std::filesystem::path& file, const std::string& id) {
  const ObservableRecord* record = find_observable(id);
  if (!record && !base.is_whole_run()) {
    std::vector<std::string> available;
    for (const ObservableRecord& known : observables())
      if (base.reason_against(known).empty()) available.emplace_back(known.id);
    throw Error(ExitCode::usage,
                file.string() + ": observable \"" + id + "\" is not available without a mesh; available are " + joined(available));
  }
  const std::string reason = record ? base.reason_against(*record) : "";
  if (!reason.empty())
    throw Error(ExitCode::usage, file.string() + ": observable \"" + id + "\": " + reason + ", or leave the observable out");
}

/// Throws Error(usage) for an uncertain input that the case does not have, or that is given by its former and by its present name.
void check_inputs(const PointCase& base, const OperatingPoint& point) {
  std::map<std::string, std::string> given;  // by present name
  for (const auto& [key, u] : point.input_u) {
    const std::string name = base.input_name(key, point.where);
    base.check_nuisance(name);
    const auto [before, is_first] = given.emplace(name, key);
    if (!is_first)
      throw Error(ExitCode::usage,
                  point.where + " input_u has " + before->second + " and " + key + ", which are one input; keep one of them");
  }
}

/// Throws Error(usage) for an override of a key that no case has. A value that a run refuses, such as a mesh that has no room for the
/// piece, is found out by that run alone.
void check_keys(const PointCase& base, const std::vector<std::string>& overrides, const std::string& where) {
  for (const std::string& text : overrides) {
    const std::string key = text.substr(0, text.find('='));  // a number of the geometry is a key of its list
    if (base.value_of(key).empty()) check_override_key(text, where);
  }
}

/// Of the executable file: runs of another program are not these, committed or not.
std::string program_fingerprint(MPI_Comm comm) {
  static std::string known;
  std::string own = known;
  if (rank_of(comm) == 0 && own.empty()) own = sha256(file_text("/proc/self/exe").value_or(version_git));
  own.resize(64);
  MPI_Bcast(own.data(), 64, MPI_CHAR, 0, comm);
  return known = own;
}

std::string text_of(const std::string& name, double value) {
  char digits[32];
  return name + "=" + std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr) + ";";
}

std::string text_of(const std::map<std::string, double>& values) {
  std::string text;
  for (const auto& [name, value] : values)
    if (value != 0) text += text_of(name, value);
  return text;
}

std::string text_of_gate(const Gate& gate) {
  std::string text = gate.from > -Gate::far ? text_of("from", gate.from) : "";
  for (std::size_t axis = 0; axis < gate.lower.size(); ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (gate.lower.at(axis) > -Gate::far) text += text_of("above_" + name, gate.lower.at(axis));
    if (gate.upper.at(axis) < Gate::far) text += text_of("below_" + name, gate.upper.at(axis));
  }
  return text;
}

std::string text_of(const Restart& restart) {
  std::string text = text_of("restart", restart.time);
  for (const double value : restart.position) text += text_of("x", value);
  for (const double value : restart.velocity) text += text_of("v", value);
  return text;
}

/// Empty where there is no such file.
std::string shared_text(MPI_Comm comm, const std::filesystem::path& file) {
  std::string text;
  on_all_ranks(comm, [&] {
    if (rank_of(comm) == 0) text = file_text(file).value_or("");
    if (text.size() > std::numeric_limits<int>::max())
      throw Error(ExitCode::io, file.string() + ": has more than 2 GB; is it the right one?");
  });
  long length = static_cast<long>(text.size());
  MPI_Bcast(&length, 1, MPI_LONG, 0, comm);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, 0, comm);
  return text;
}

}  // namespace

CaseSimulator::CaseSimulator(MPI_Comm comm, const Experiment& experiment, const std::filesystem::path& folder)
    : comm_(comm),
      folder_(folder),
      observables_(experiment.observables),
      picture_size_(picture_size_of(experiment)),
      first_seed_(experiment.seed) {
  if (!folder_.empty()) program_ = program_fingerprint(comm_);
  for (std::size_t p = 0; p < experiment.points.size(); ++p) {
    const OperatingPoint& point = experiment.points[p];
    if (!file_text(point.case_file))
      throw Error(ExitCode::io, point.where + " case \"" + point.case_file.string() + "\" cannot be read; check the path");
    PointCase base(point.case_file, point.set, &store_, &prepared_);
    if (base.is_whole_run() && folder_.empty())
      throw Error(ExitCode::usage, point.case_file.string() + ": has a mesh; its runs need an output folder");
    for (const std::string& note : base.former_names()) log::warning_once(note);
    check_inputs(base, point);
    std::vector<Slot> slots = slots_of(experiment, static_cast<int>(p), base.is_whole_run());
    std::vector<ObservableRequest> asked;
    const std::string of_case = base.sha256() + program_;
    std::string fingerprint = base.sha256();
    for (const Slot& slot : slots) {
      const std::string& id = observables_[static_cast<std::size_t>(slot.observable)].id;
      check_observable(base, point.case_file, id);
      asked.push_back({id, slot.time});
      fingerprint += asked.back().observable + "@" + text_of({{"t", slot.time + 1}});
    }
    for (const Alternative& alternative : experiment.alternatives) {
      const std::vector<std::string> overrides = overrides_at(alternative, point.id);
      check_keys(base, overrides, point.where + " [[alternative]] " + alternative.effect);
      base.set_alternative(alternative.effect, overrides);
    }
    for (const OwnCandidate& candidate : experiment.own_candidates) base.set_own_candidate(candidate);
    points_.push_back({std::move(base), std::move(slots), std::move(asked), of_case, sha256(fingerprint)});
  }
  CaseFeatures facts = points_.front().base.facts();
  std::set<std::string> held;  // a force that one point holds cannot be added to all
  for (const Point& point : points_) {
    facts = any_of(facts, point.base.facts());
    held.insert(point.base.forces().begin(), point.base.forces().end());
  }
  effects_ = library_effects(facts, {held.begin(), held.end()});
  set_alternatives(effects_, experiment.alternatives);
  add_own_candidates(effects_, experiment.own_candidates);
  find_nuisances(experiment);
  if (!folder_.empty()) open_cache(folder_ / "runs.tsv");
  if (!experiment.runs.empty()) import_runs(experiment.runs);
}

void CaseSimulator::find_nuisances(const Experiment& experiment) {
  std::vector<const PointCase*> bases;
  std::vector<std::vector<std::pair<std::string, double>>> input_u;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    bases.push_back(&points_[p].base), input_u.push_back(experiment.points[p].input_u);
    for (auto& [key, u] : input_u.back()) key = points_[p].base.input_name(key, experiment.points[p].where);
  }
  nuisances_ = input_nuisances(bases, input_u);
  std::vector<int> all(points_.size());
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  std::set<std::string> groups;
  for (const Observable& observable : observables_)
    if (observable.bias_u > 0 && groups.insert(calibration_of(observable)).second)
      nuisances_.push_back({calibration_of(observable), 1, all});
}

bool CaseSimulator::is_of_case(const std::string& nuisance) const {
  return std::none_of(observables_.begin(), observables_.end(), [&](const Observable& o) { return calibration_of(o) == nuisance; });
}

CaseChange CaseSimulator::change_of(const RunRequest& request) const {
  std::map<std::string, double> of_case = request.nuisances;
  std::erase_if(of_case, [this](const auto& input) { return !is_of_case(input.first); });
  const PointCase& base = points_.at(static_cast<std::size_t>(request.point)).base;
  // The points are compared as if what is chance at one had no part in another. Whole runs of a pump forget how they began.
  if (request.seed >= first_seed_ + seeds_of_a_point)
    throw Error(ExitCode::usage, "seed " + std::to_string(request.seed) + " is beyond the " + std::to_string(seeds_of_a_point) +
                                     " of a point that begin at " + std::to_string(first_seed_) +
                                     " ([budget] seed); ask for fewer runs a state");
  const std::uint64_t own = base.is_whole_run() ? 0 : seeds_of_a_point * static_cast<std::uint64_t>(request.point);
  return base.change(request.effects, of_case, request.seed + own, request.forms);
}

std::string CaseSimulator::resolved_case(const RunRequest& request) {
  const PointCase& base = points_.at(static_cast<std::size_t>(request.point)).base;
  std::vector<std::string> overrides = change_of(request).overrides;
  if (!base.is_whole_run() || request.step_factor != 1) overrides.push_back(base.with_step_factor(request.step_factor));
  return base.resolved_with(overrides, &store_, &prepared_);
}

CaseSimulator::Job CaseSimulator::job_of(const RunRequest& request) const {
  const Point& point = points_.at(static_cast<std::size_t>(request.point));
  CaseChange change = change_of(request);
  std::sort(change.overrides.begin(), change.overrides.end());
  std::string settings = text_of({{"step", request.step_factor}});
  std::vector<std::string> names;
  for (const std::string& value : change.overrides) names.push_back(point.base.for_run_table(value));
  std::sort(names.begin(), names.end());
  for (const std::string& value : names) settings += value + ";";
  if (request.restart) settings += text_of(*request.restart);
  std::optional<CaseChange> outside;
  if (request.gate) {
    RunRequest without = request;
    without.effects.erase(request.gate->effect);
    outside = change_of(without);
    settings += "gate of " + request.gate->effect + ";" + text_of_gate(*request.gate);
  }
  return {point.fingerprint.substr(0, 16) + "|" + settings, settings, &request, std::move(change), std::move(outside)};
}

RunResult CaseSimulator::run_serial(const Job& job) const {
  const Point& point = points_[static_cast<std::size_t>(job.request->point)];
  RunResult result;
  try {
    const auto case_of = [&](const CaseChange& change) {
      std::vector<std::string> overrides = change.overrides;
      overrides.push_back(point.base.with_step_factor(job.request->step_factor));
      return point.base.with(overrides);
    };
    std::optional<BehindGate> behind;
    if (job.outside) behind = BehindGate{*job.request->gate, case_of(job.change)};
    result.values = run_in_memory(case_of(job.outside ? *job.outside : job.change), point.asked, {}, &store_, job.request->restart,
                                  &prepared_, behind ? &*behind : nullptr);
  } catch (const std::exception& failure) {
    result.values.assign(point.slots.size(), std::numeric_limits<double>::quiet_NaN());
    result.failure = failure.what();
  }
  return result;
}

RunResult CaseSimulator::run_collective(const Job& job) const {
  const Point& point = points_[static_cast<std::size_t>(job.request->point)];
  // Whatever is asked of it: monitors and summary answer later questions too.
  const std::string name = numbered("run", job.request->point) + "_" + sha256(point.of_case + job.settings).substr(0, 16);
  std::vector<std::string> overrides = point.base.from_elsewhere(job.change.overrides);
  if (job.request->step_factor != 1) overrides.push_back(point.base.with_step_factor(job.request->step_factor));
  const auto failed = [&](const Error& failure) {
    return RunResult{std::vector<double>(point.slots.size(), std::numeric_limits<double>::quiet_NaN()), failure.what()};
  };
  try {
    run_in_folder(point.base.resolved(), overrides, folder_ / "runs" / name, prepared_);
  } catch (const Error& failure) {
    // A case that is refused for what was changed of it, such as a piece that its mesh has no room for, is one more run that failed.
    if (failure.code == ExitCode::stopped) throw;
    return failed(failure);
  }
  try {
    return {.values = read_observables(folder_ / "runs" / name, point.asked, point.base.camera()), .failure = {}};
  } catch (const Error& failure) {
    if (failure.code == ExitCode::usage) throw;
    return failed(failure);
  }
}

RunResult CaseSimulator::as_observed(const RunRequest& request, const CaseChange& change, RunResult raw) const {
  const auto& slots = points_[static_cast<std::size_t>(request.point)].slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Observable& observable = observables_[static_cast<std::size_t>(slots[i].observable)];
    double& value = raw.values[i];
    if (const ObservableRecord* record = find_observable(observable.id)) {
      for (int power = 0; power < record->scale_power(); ++power) value *= change.picture_scale;
      if (record->is_position()) value += (1 - change.picture_scale) * picture_size_ * change.picture_centre[record->axis];
    }
    const auto deviation = request.nuisances.find(calibration_of(observable));
    if (deviation == request.nuisances.end() || observable.bias_u <= 0) continue;
    const double shift = deviation->second * observable.bias_u;
    value = observable.kind == Observable::Kind::lognormal ? value * std::exp(shift) : value + shift;
  }
  return raw;
}

void CaseSimulator::run_portion(std::span<const Job* const> fresh) {
  // Every rank fills in its own runs; the bits of the others are zero.
  constexpr std::size_t text_size = 512;
  std::vector<std::uint64_t> bits;
  std::vector<char> failures(fresh.size() * text_size, 0);
  const int rank = rank_of(comm_), size = size_of(comm_);
  for (std::size_t j = 0; j < fresh.size(); ++j) {
    const std::size_t n = slots(fresh[j]->request->point).size(), first = bits.size();
    bits.resize(first + n, 0);
    const bool whole_run = is_whole_run(*fresh[j]);
    if (!whole_run && static_cast<int>(j % static_cast<std::size_t>(size)) != rank) continue;
    const RunResult result = whole_run ? run_collective(*fresh[j]) : run_serial(*fresh[j]);
    for (std::size_t i = 0; i < n; ++i) bits[first + i] = std::bit_cast<std::uint64_t>(result.values[i]);
    std::strncpy(&failures[j * text_size], result.failure.c_str(), text_size - 1);
  }
  if (size > 1) {
    MPI_Allreduce(MPI_IN_PLACE, bits.data(), static_cast<int>(bits.size()), MPI_UINT64_T, MPI_BOR, comm_);
    MPI_Allreduce(MPI_IN_PLACE, failures.data(), static_cast<int>(failures.size()), MPI_BYTE, MPI_BOR, comm_);
  }
  std::size_t at = 0;
  for (std::size_t j = 0; j < fresh.size(); ++j) {
    RunResult result{.values = {}, .failure = &failures[j * text_size]};
    for (std::size_t i = 0; i < slots(fresh[j]->request->point).size(); ++i) result.values.push_back(std::bit_cast<double>(bits[at++]));
    cached_.emplace(fresh[j]->key, std::move(result));
  }
  on_all_ranks(comm_, [&] {
    for (const Job* job : fresh) store(job->key, cached_.at(job->key));
  });
  n_runs_ += static_cast<int>(fresh.size());
}

std::vector<RunResult> CaseSimulator::run(std::span<const RunRequest> requests) {
  std::vector<Job> jobs;
  jobs.reserve(requests.size());
  for (const RunRequest& request : requests) {
    jobs.push_back(job_of(request));
    used_.insert(jobs.back().key);
  }
  std::vector<const Job*> fresh;  // the same on every rank
  std::set<std::string> listed;
  for (const Job& job : jobs)
    if (!cached_.contains(job.key) && listed.insert(job.key).second) fresh.push_back(&job);

  // In portions, each of which is kept when it is done: a diagnosis that is stopped goes on from there.
  constexpr std::size_t per_rank = 8;
  const std::size_t portion = per_rank * static_cast<std::size_t>(size_of(comm_));
  for (std::size_t j = 0; j < fresh.size(); j += portion) run_portion(std::span(fresh).subspan(j, std::min(portion, fresh.size() - j)));

  std::vector<RunResult> results;
  results.reserve(jobs.size());
  for (const Job& job : jobs) {
    const RunResult& kept = cached_.at(job.key);
    if (const std::size_t n = slots(job.request->point).size(); kept.values.size() != n)
      throw Error(ExitCode::io, "table of runs: \"" + shortened(job.key) + "\" has " + std::to_string(kept.values.size()) +
                                    " values, its point has " + std::to_string(n) + "; remove the line; the run is then repeated");
    if (!kept.failure.empty() && failed_keys_.insert(job.key).second && failed_.n++ == 0) failed_.why = kept.failure;
    results.push_back(as_observed(*job.request, job.change, kept));
  }
  return results;
}

void CaseSimulator::store(const std::string& key, const RunResult& result) {
  if (cache_.descriptor() >= 0) cache_.write(run_table_line({program_.substr(0, 16), key, result}));
}

void CaseSimulator::open_cache(const std::filesystem::path& file) {
  const std::string text = shared_text(comm_, file);
  for (StoredRun& run : run_table(text, file))
    if (run.program == program_.substr(0, 16)) cached_.emplace(run.key, std::move(run.result));
  on_all_ranks(comm_, [&] {
    if (rank_of(comm_) != 0) return;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    // A line that a crash cut off is cut off for good.
    const std::size_t whole = text.rfind('\n') + 1;
    if (whole < text.size()) write_atomically(file, std::string_view(text).substr(0, whole));
    cache_ = OpenFile(file, O_WRONLY | O_CREAT | O_APPEND);
  });
}

void CaseSimulator::import_runs(const std::filesystem::path& file) {
  const std::string text = shared_text(comm_, file);
  if (text.empty()) throw Error(ExitCode::io, file.string() + ": cannot be read, or is empty; check [budget] runs_table");
  for (StoredRun& run : run_table(text, file))
    if (cached_.emplace(run.key, std::move(run.result)).second) imported_.insert(run.key);
}

int CaseSimulator::n_imported() const {
  return static_cast<int>(std::count_if(used_.begin(), used_.end(), [&](const std::string& key) { return imported_.contains(key); }));
}

}  // namespace snag
