#include "casework/case_run.hpp"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "casework/observable_source.hpp"
#include "casework/window_mean.hpp"
#include "dem/bonds/elastic_bond.hpp"
#include "dem/particles/tile_particles.hpp"
#include "observe/observables.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

namespace {

const ObservableRecord& record_of(const std::string& name) {
  const ObservableRecord* record = find_observable(name);
  if (!record) {
    std::vector<std::string> available;
    for (const ObservableRecord& known : observables())
      if (known.needs != Needs::pump) available.emplace_back(known.id);
    throw Error(ExitCode::usage, "observable \"" + name + "\": is not available without a mesh; available are " + joined(available));
  }
  if (record->needs == Needs::pump)
    throw Error(ExitCode::usage, "observable \"" + name +
                                     "\": is defined by [rag_passage], the flanges and the tongue of a pump, which a run "
                                     "in memory does not have; leave it out");
  return *record;
}

/// A number at the end of a step, and its rate of change where the observable has one.
struct Number {
  double value = std::numeric_limits<double>::quiet_NaN(), rate = 0;
};

Number number_of(const ObservableRecord& w, RunReader& now) { return {now(w.read), w.rate.is_there() ? now(w.rate) : 0}; }

double turned_by(double from, double to, double period) { return std::remainder(to - from, period); }

/// `s`: share of the step from a to b that has passed. With rates cubic in time through values and rates at both ends, else linear.
double between(const ObservableRecord& w, const Number& a, const Number& b, double dt, double s) {
  if (w.rate.is_there()) {
    const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s), h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
    return h00 * a.value + (dt * h10) * a.rate + h01 * b.value + (dt * h11) * b.rate;
  }
  if (w.period() == 0) return a.value + s * (b.value - a.value);
  return turned_by(0, a.value + s * turned_by(a.value, b.value, w.period()), w.period());
}

/// What is asked, in the order of time; numbers of the whole run last.
struct Question {
  double time;
  const ObservableRecord* what;
  std::size_t place;
};

std::vector<Question> slots_of(const std::vector<ObservableRequest>& asked, bool has_window) {
  std::vector<Question> slots;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const ObservableRecord& w = record_of(asked[i].observable);
    const bool timed = !std::isnan(asked[i].time);
    if (timed ? w.is_of_whole_run() : !w.is_of_whole_run() && !has_window)
      throw Error(ExitCode::usage,
                  "observable \"" + asked[i].observable + "\" is asked " +
                      (timed ? "at a time, but is a number of the whole run; leave t_s empty"
                             : "without a time, but changes in time; give t_s, or a window of the camera in [virtual_camera] of the case"));
    slots.push_back({timed ? asked[i].time : infinity, &w, i});
  }
  std::stable_sort(slots.begin(), slots.end(), [](const Question& a, const Question& b) { return a.time < b.time; });
  return slots;
}

/// Answers as the run goes by.
class Observer {
 public:
  Observer(const Simulation& run, std::vector<Question> slots)
      : run_(run),
        settings_(run.observe_settings),
        view_(settings_.view()),
        exit_(settings_, *run.passage),
        slots_(std::move(slots)),
        before_(slots_.size()),
        values_(slots_.size(), std::numeric_limits<double>::quiet_NaN()) {
    for (const Question& slot : slots_) {
      if (slot.what->is_of_whole_run())
        whole_run_ = true;
      else if (std::isinf(slot.time))
        in_window_.push_back(slot.what);
    }
  }

  void look() {
    const double time = run_.time(), dt = run_.time_settings.step, tolerance = 1e-9 * dt;
    RunReader now({run_, view_, exit_});
    if (!in_window_.empty() && settings_.in_window(now.get<Motion>().position))
      for (const ObservableRecord* w : in_window_) window_[w].add(number_of(*w, now).value, w->period());
    for (; next_ < slots_.size() && slots_[next_].time <= time + tolerance; ++next_) {
      const Question& slot = slots_[next_];
      const Number number = number_of(*slot.what, now);
      const bool here = std::abs(slot.time - time) <= tolerance;
      const double share = here ? 1 : (slot.time - before_time_) / (time - before_time_);
      values_[slot.place] = between(*slot.what, here ? number : before_[next_], number, time - before_time_, share);
    }
    for (std::size_t i = next_; i < slots_.size() && slots_[i].time < time + dt * (1 + 1e-9); ++i)
      before_[i] = number_of(*slots_[i].what, now);
    if (whole_run_) exit_.add(time, now.get<Motion>());
    before_time_ = time;
  }
  /// Of the pieces, m.
  Vec3 centre() const { return RunReader({run_, view_, exit_}).get<Motion>().position; }
  std::vector<double> values() {
    RunReader end({run_, view_, exit_});
    for (const Question& slot : slots_)
      if (std::isinf(slot.time)) values_[slot.place] = slot.what->is_of_whole_run() ? end(slot.what->read) : window_[slot.what].value();
    return values_;
  }

 private:
  const Simulation& run_;
  const ObserveSettings& settings_;
  View view_;
  ExitWatch exit_;
  std::map<const ObservableRecord*, WindowMean> window_;  // over the steps at whose ends the centre is in the window
  std::vector<Question> slots_;
  std::vector<const ObservableRecord*> in_window_;  // asked as means over the window
  std::vector<Number> before_;                      // of the slots that lie in the step to come
  std::vector<double> values_;
  std::size_t next_ = 0;
  bool whole_run_ = false;
  double before_time_ = 0;  // s
};

double last_time(const std::vector<Question>& slots, double end) {
  double last = 0;
  for (const Question& slot : slots) {
    if (std::isinf(slot.time)) return end;
    if (slot.time <= end * (1 + 1e-9)) last = slot.time;
  }
  return last;
}

LatticePosition place_in_piece(const Tile& tile, const Rag& rag, int k, int column) {
  const int n = rag.n_columns;
  LatticePosition place{.x = tile.vector(Tile::x, k), .along = 0, .mean_abs_along = 0, .normal = {}};
  if (n == 1) return place;
  place.along = (2.0 * (tile.column + column) - (n - 1)) / (n - 1);
  place.mean_abs_along = n % 2 == 0 ? 0.5 * n / (n - 1) : 0.5 * (n + 1) / n;
  const double qw = tile.field(Tile::qw)[k], qx = tile.field(Tile::qx)[k], qy = tile.field(Tile::qy)[k], qz = tile.field(Tile::qz)[k];
  place.normal = cross(carried_direction<0>(qw, qx, qy, qz), carried_direction<1>(qw, qx, qy, qz));
  return place;
}

void kick(RagSystem& rags, const UnmodelledForce& unmodelled, double time, double dt) {
  for (Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[static_cast<std::size_t>(tile.rag)];
    for_particles(tile, [&](int k, int column, int) {
      tile.set_vector(Tile::vx, k, tile.vector(Tile::vx, k) + dt * unmodelled(time, place_in_piece(tile, rag, k, column)));
    });
  }
}

/// `time`: at which the rags are, at most a step before that of the restart.
void move(RagSystem& rags, const Restart& restart, double time) {
  const auto &by = restart.position, &faster = restart.velocity;
  const Vec3 dv{faster[0], faster[1], faster[2]}, dx = Vec3{by[0], by[1], by[2]} - (restart.time - time) * dv;
  for (Tile& tile : rags.tiles()) {
    for_particles(tile, [&](int k, int, int) {
      tile.set_vector(Tile::x, k, tile.vector(Tile::x, k) + dx);
      tile.set_vector(Tile::vx, k, tile.vector(Tile::vx, k) + dv);
    });
  }
}

/// The couplings without and with what is behind a gate, by turns in the run.
class GatedCoupling {
 public:
  GatedCoupling(Simulation& run, const BehindGate& behind) : run_(run), gate_(behind.gate), other_(run.coupling_of(behind.file)) {}

  void look(const Vec3& centre) {
    const auto within = [&](int axis) { return centre[axis] >= gate_.lower.at(axis) && centre[axis] <= gate_.upper.at(axis); };
    const double rounding = 1e-9 * run_.time_settings.step;
    const bool open = run_.time() >= gate_.from - rounding && within(0) && within(1) && within(2);
    if (open == open_) return;
    open_ = open;
    std::swap(run_.coupled, other_);
    for (Tile& tile : run_.rags->tiles()) tile.particle_state.clear();
  }

 private:
  Simulation& run_;
  Gate gate_;
  std::unique_ptr<CoupledSolver> other_;
  bool open_ = false;
};

}  // namespace

std::vector<double> run_in_memory(const CaseFile& file, const std::vector<ObservableRequest>& asked, const UnmodelledForce& unmodelled,
                                  FlowCache* store, const std::optional<Restart>& restart, Prepared* prepared,
                                  const BehindGate* behind_gate) {
  const log::Silence silence;
  Simulation run(file, MPI_COMM_SELF, {}, store, prepared);
  std::vector<Question> slots = slots_of(asked, run.observe_settings.has_window());
  if (!run.rags || (run.mesh && !run.frozen()))
    throw Error(ExitCode::usage, file.root().where() + ": a run in memory must be a case without a mesh or with frozen flow");
  run.watches_rags = run.mesh != nullptr;
  run.start();
  const double dt = run.time_settings.step, last = last_time(slots, run.time_settings.end);
  Observer observer(run, std::move(slots));
  std::optional<GatedCoupling> gated;
  if (behind_gate) gated.emplace(run, *behind_gate);
  const std::int64_t restart_step = restart ? static_cast<std::int64_t>(restart->time / dt + 1e-9) : -1;
  const auto restart_and_look = [&] {
    if (run.time_step() == restart_step) move(*run.rags, *restart, run.time());
    observer.look();
    if (gated) gated->look(observer.centre());
    return run.time() < last * (1 - 1e-9);
  };
  if (!restart_and_look()) return observer.values();
  run.run([&] {
    if (unmodelled) kick(*run.rags, unmodelled, run.time() - 0.5 * dt, dt);
    return !run.passage->all_exited_at() && restart_and_look();
  });
  return observer.values();
}

}  // namespace snag
