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
#include "casework/exit_watch.hpp"
#include "casework/outline_moments.hpp"
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

Motion motion_of(const RagSystem& rags) {
  Motion sum;
  double mass = 0;
  for (const Tile& tile : rags.tiles()) {
    const double m = rags.rags()[static_cast<std::size_t>(tile.rag)].mass;
    for_particles(tile, [&](int k, int, int) {
      sum.position += m * tile.vector(Tile::x, k), sum.velocity += m * tile.vector(Tile::vx, k);
      mass += m;
    });
  }
  return {sum.position / mass, sum.velocity / mass};
}

double between(double a, double b, double s) { return a + s * (b - a); }

/// The position is cubic in time through positions and velocities at both ends of a step, the velocity linear.
Motion motion_between(const Motion& a, const Motion& b, double dt, double s) {
  const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s), h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
  return {h00 * a.position + (dt * h10) * a.velocity + h01 * b.position + (dt * h11) * b.velocity,
          a.velocity + s * (b.velocity - a.velocity)};
}

double turned_by(double from, double to, double period) { return std::remainder(to - from, period); }

/// Where the pieces are at the end of a step.
struct Instant {
  double time = 0;
  Motion motion;
  std::optional<Silhouette> picture;  // where one is needed
};

/// `s`: share of the step from a to b that has passed.
double seen_between(const ObservableRecord& w, const Instant& a, const Instant& b, double s) {
  if (const auto* read = std::get_if<double (*)(const Motion&)>(&w.read))
    return (*read)(motion_between(a.motion, b.motion, b.time - a.time, s));
  const auto read = std::get<double (*)(const Silhouette&)>(w.read);
  const double before = read(*a.picture), after = read(*b.picture);
  if (w.period() == 0) return between(before, after, s);
  return turned_by(0, before + s * turned_by(before, after, w.period()), w.period());
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

/// Means over the instants at which the centre is in the window.
class WindowMean {
 public:
  void add(const ObservableRecord& w, const Instant& now) {
    const double value = seen_between(w, now, now, 1);
    Sums& sums = sums_[&w];
    // An axis has no head: angles are averaged on the circle of their period.
    const double turn = w.period() == 0 ? 0 : 2 * std::numbers::pi / w.period();
    sums.cosine += turn == 0 ? value : std::cos(turn * value), sums.sine += std::sin(turn * value);
    ++sums.n;
  }
  double mean(const ObservableRecord& w) const {
    const auto found = sums_.find(&w);
    if (found == sums_.end()) return std::numeric_limits<double>::quiet_NaN();
    const Sums& sums = found->second;
    return w.period() == 0 ? sums.cosine / sums.n : w.period() / (2 * std::numbers::pi) * std::atan2(sums.sine, sums.cosine);
  }

 private:
  struct Sums {
    double cosine = 0, sine = 0;  // of numbers that are no angles: the first is their sum
    int n = 0;
  };
  std::map<const ObservableRecord*, Sums> sums_;
};

/// Answers as the run goes by.
class Observer {
 public:
  Observer(const RagSystem& rags, const Passage& passage, const ObserveSettings& settings, std::vector<Question> slots, double dt)
      : rags_(rags), settings_(settings), view_(settings.view()), exit_(settings, passage), slots_(std::move(slots)), dt_(dt) {
    values_.resize(slots_.size(), std::numeric_limits<double>::quiet_NaN());
    for (const Question& slot : slots_) {
      if (slot.what->is_of_picture()) picture_times_.push_back(slot.time);
      if (slot.what->is_of_whole_run())
        whole_run_ = true;
      else if (std::isinf(slot.time))
        in_window_.push_back(slot.what), window_pictures_ = window_pictures_ || slot.what->is_of_picture();
    }
  }

  void look(double time) {
    Instant now{time, motion_of(rags_), {}};
    const bool seen = !in_window_.empty() && settings_.in_window(now.motion.position);
    if (needs_picture(time) || (seen && window_pictures_)) now.picture = outline_of(rags_, view_);
    if (seen)
      for (const ObservableRecord* w : in_window_) window_.add(*w, now);
    const double tolerance = 1e-9 * dt_;
    for (; next_ < slots_.size() && slots_[next_].time <= time + tolerance; ++next_) {
      const Question& slot = slots_[next_];
      const bool here = std::abs(slot.time - time) <= tolerance;
      const double share = here ? 1 : (slot.time - before_.time) / (time - before_.time);
      values_[slot.place] = seen_between(*slot.what, here ? now : before_, now, share);
    }
    if (whole_run_) exit_.add(time, now.motion);
    before_ = now;
  }
  std::vector<double> values() {
    const PassageResult passage = exit_.verdict();
    for (const Question& slot : slots_) {
      if (!std::isinf(slot.time)) continue;
      const auto* read = std::get_if<double (*)(const PassageResult&)>(&slot.what->read);
      values_[slot.place] = read ? (*read)(passage) : window_.mean(*slot.what);
    }
    return values_;
  }

 private:
  /// Pictures of both ends of a step in which one is asked for.
  bool needs_picture(double time) const {
    const auto next = std::upper_bound(picture_times_.begin(), picture_times_.end(), time - dt_ * (1 + 1e-9));
    return next != picture_times_.end() && *next < time + dt_ * (1 + 1e-9);
  }

  const RagSystem& rags_;
  const ObserveSettings& settings_;
  View view_;
  ExitWatch exit_;
  WindowMean window_;
  std::vector<Question> slots_;
  std::vector<const ObservableRecord*> in_window_;  // asked as means over the window
  std::vector<double> values_, picture_times_;
  std::size_t next_ = 0;
  double dt_;
  bool whole_run_ = false, window_pictures_ = false;
  Instant before_;
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

}  // namespace

std::vector<double> run_in_memory(const CaseFile& file, const std::vector<ObservableRequest>& asked, const UnmodelledForce& unmodelled,
                                  FlowCache* store, const std::optional<Restart>& restart) {
  const log::Silence silence;
  Simulation run(file, MPI_COMM_SELF, {}, store);
  std::vector<Question> slots = slots_of(asked, run.observe_settings.has_window());
  if (!run.rags || (run.mesh && !run.frozen()))
    throw Error(ExitCode::usage, file.root().where() + ": a run in memory must be a case without a mesh or with frozen flow");
  run.watches_rags = run.mesh != nullptr;
  run.start();
  const double dt = run.time_settings.step, last = last_time(slots, run.time_settings.end);
  Observer observer(*run.rags, *run.passage, run.observe_settings, std::move(slots), dt);
  const std::int64_t restart_step = restart ? static_cast<std::int64_t>(restart->time / dt + 1e-9) : -1;
  const auto restart_and_look = [&] {
    if (run.time_step() == restart_step) move(*run.rags, *restart, run.time());
    observer.look(run.time());
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
