#include "casework/case_run.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "casework/outline_moments.hpp"
#include "dem/bonds/bond_law.hpp"
#include "dem/particles/tile_particles.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

namespace {

enum What { x, y, z, vx, vy, vz, area, elongation_ratio, orientation, retention_time, recirculations, stuck, exited, n_observables };
constexpr std::array<const char*, n_observables> names{
    "x", "y", "z", "vx", "vy", "vz", "area", "elongation_ratio", "orientation", "retention_time", "recirculations", "stuck", "exited"};

What what_of(const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw Error(ExitCode::usage, "observable \"" + name +
                                     "\": a case without a mesh has no such number; there are: " + joined({names.begin(), names.end()}));
  return static_cast<What>(found - names.begin());
}

bool of_picture(What w) { return w == area || w == elongation_ratio || w == orientation; }
bool of_whole_run(What w) { return w >= retention_time; }

/// Centre of mass and its velocity.
struct Motion {
  Vec3 position, velocity;
};

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

/// Cubic in time through places and velocities at both ends of a step.
Vec3 place_between(const Motion& a, const Motion& b, double dt, double s) {
  const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s), h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
  return h00 * a.position + (dt * h10) * a.velocity + h01 * b.position + (dt * h11) * b.velocity;
}

double turned_by(double from, double to, double period) { return std::remainder(to - from, period); }

/// What is told of the whole run: the first passage of the exit, the turns of the path in the picture, the rest.
class Journey {
 public:
  Journey(const ObserveSettings& settings, const View& view, double end) : settings_(settings), view_(view), end_(end) {}

  void look(double time, const Motion& motion) {
    const std::optional<double> beyond = settings_.beyond_exit(motion.position);
    if (beyond && *beyond > 0 && !left_) {
      const double before = before_.value_or(0);
      left_ = before < 0 ? before_time_ + (time - before_time_) * before / (before - *beyond) : time;
    }
    before_ = beyond, before_time_ = time;
    const double a = dot(motion.velocity, view_.right), b = dot(motion.velocity, view_.up);
    if (std::hypot(a, b) > 0) {
      const double angle = std::atan2(b, a);
      if (angle_) turn_ += turned_by(*angle_, angle, 2 * std::numbers::pi);
      angle_ = angle;
    }
    if (time <= 0.8 * end_) late_ = motion.position;
    last_ = motion.position;
  }

  double told(What w, double size) const {
    switch (w) {
      case retention_time:
        return left_.value_or(std::numeric_limits<double>::quiet_NaN());
      case recirculations:
        return std::floor(std::abs(turn_) / (2 * std::numbers::pi));
      case stuck:
        return !left_ && norm(last_ - late_) < size ? 1 : 0;
      default:
        return left_ ? 1 : 0;
    }
  }

 private:
  const ObserveSettings& settings_;
  const View& view_;
  double end_;
  std::optional<double> left_, before_, angle_;  // s, m, rad
  double before_time_ = 0, turn_ = 0;
  Vec3 late_, last_;
};

/// Where the pieces are at the end of a step.
struct Instant {
  double time = 0;
  Motion motion;
  std::optional<Silhouette> picture;  // where one is needed
};

double between(double a, double b, double s) { return a + s * (b - a); }

/// `s`: share of the step from a to b that has passed.
double seen_between(What w, const Instant& a, const Instant& b, double s) {
  switch (w) {
    case x:
    case y:
    case z:
      return place_between(a.motion, b.motion, b.time - a.time, s)[w];
    case vx:
    case vy:
    case vz:
      return between(a.motion.velocity[w - vx], b.motion.velocity[w - vx], s);
    case area:
      return between(a.picture->area, b.picture->area, s);
    case elongation_ratio:
      return between(a.picture->elongation_ratio, b.picture->elongation_ratio, s);
    default: {
      const double turn = turned_by(a.picture->orientation, b.picture->orientation, std::numbers::pi);
      return turned_by(0, a.picture->orientation + s * turn, std::numbers::pi);  // an axis has no head: within +- pi/2
    }
  }
}

/// What is asked, in the order of time; numbers of the whole run last.
struct Question {
  double time;
  What what;
  std::size_t place;
};

std::vector<Question> slots_of(const std::vector<Asked>& asked, bool has_window) {
  std::vector<Question> slots;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const What w = what_of(asked[i].observable);
    const bool timed = !std::isnan(asked[i].time);
    if (timed ? of_whole_run(w) : !of_whole_run(w) && !has_window)
      throw Error(ExitCode::usage,
                  "observable \"" + asked[i].observable + "\" is asked " +
                      (timed ? "at a time, but is a number of the whole run; leave t_s empty"
                             : "without a time, but changes in time; give t_s, or a window of the camera in [observe] of the case"));
    slots.push_back({timed ? asked[i].time : infinity, w, i});
  }
  std::stable_sort(slots.begin(), slots.end(), [](const Question& a, const Question& b) { return a.time < b.time; });
  return slots;
}

/// Means over the instants at which the centre is in the window.
class WindowMean {
 public:
  void add(What w, const Instant& now) {
    const double value = seen_between(w, now, now, 1);
    // An axis has no head: angles are averaged on twice the circle.
    cosine_[w] += w == orientation ? std::cos(2 * value) : value, sine_[w] += std::sin(2 * value);
    ++n_[w];
  }
  double mean(What w) const {
    if (n_[w] == 0) return std::numeric_limits<double>::quiet_NaN();
    return w == orientation ? 0.5 * std::atan2(sine_[w], cosine_[w]) : cosine_[w] / n_[w];
  }

 private:
  std::array<double, n_observables> cosine_{}, sine_{};  // of other numbers: the first is their sum
  std::array<int, n_observables> n_{};
};

/// Answers as the run goes by.
class Observer {
 public:
  Observer(const RagSystem& rags, const ObserveSettings& settings, std::vector<Question> slots, double end, double dt)
      : rags_(rags), settings_(settings), view_(settings.view()), journey_(settings, view_, end), slots_(std::move(slots)), dt_(dt) {
    values_.resize(slots_.size(), std::numeric_limits<double>::quiet_NaN());
    for (const Question& slot : slots_) {
      if (of_picture(slot.what)) picture_times_.push_back(slot.time);
      if (of_whole_run(slot.what))
        whole_run_ = true;
      else if (std::isinf(slot.time))
        in_window_.push_back(slot.what), window_pictures_ = window_pictures_ || of_picture(slot.what);
    }
  }

  void look(double time) {
    Instant now{time, motion_of(rags_), {}};
    const bool seen = !in_window_.empty() && settings_.in_window(now.motion.position);
    if (needs_picture(time) || (seen && window_pictures_)) now.picture = outline_of(rags_, view_);
    if (seen)
      for (const What w : in_window_) window_.add(w, now);
    const double tolerance = 1e-9 * dt_;
    for (; next_ < slots_.size() && slots_[next_].time <= time + tolerance; ++next_) {
      const Question& slot = slots_[next_];
      const bool here = std::abs(slot.time - time) <= tolerance;
      const double share = here ? 1 : (slot.time - before_.time) / (time - before_.time);
      values_[slot.place] = seen_between(slot.what, here ? now : before_, now, share);
    }
    if (whole_run_) journey_.look(time, now.motion);
    before_ = now;
  }
  std::vector<double> values() {
    const double size = 2 * rags_.rags().front().radius;
    for (const Question& slot : slots_)
      if (std::isinf(slot.time)) values_[slot.place] = of_whole_run(slot.what) ? journey_.told(slot.what, size) : window_.mean(slot.what);
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
  Journey journey_;
  WindowMean window_;
  std::vector<Question> slots_;
  std::vector<What> in_window_;  // asked as means over the window
  std::vector<double> values_, picture_times_;
  std::size_t next_ = 0;
  double dt_;
  bool whole_run_ = false, window_pictures_ = false;
  Instant before_;
};

/// Steps that a run takes: as many as the case, over the factor.
std::int64_t n_steps_of(const TimeSettings& time, double step_factor) {
  return std::max<std::int64_t>(1, std::llround(static_cast<double>(time.n_steps()) / step_factor));
}

double last_time(const std::vector<Question>& slots, double end) {
  double last = 0;
  for (const Question& slot : slots) {
    if (std::isinf(slot.time)) return end;
    if (slot.time <= end * (1 + 1e-9)) last = slot.time;
  }
  return last;
}

PlaceInPiece place_in_piece(const Tile& tile, const Rag& rag, int k, int column) {
  const int n = rag.n_columns;
  PlaceInPiece place{.x = tile.vector(Tile::x, k), .along = 0, .mean_abs_along = 0, .normal = {}};
  if (n == 1) return place;
  place.along = (2.0 * (tile.column + column) - (n - 1)) / (n - 1);
  place.mean_abs_along = n % 2 == 0 ? 0.5 * n / (n - 1) : 0.5 * (n + 1) / n;
  const double qw = tile.field(Tile::qw)[k], qx = tile.field(Tile::qx)[k], qy = tile.field(Tile::qy)[k], qz = tile.field(Tile::qz)[k];
  place.normal = cross(carried_direction<0>(qw, qx, qy, qz), carried_direction<1>(qw, qx, qy, qz));
  return place;
}

void kick(RagSystem& rags, const OutsideForce& outside, double time, double dt) {
  for (Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[static_cast<std::size_t>(tile.rag)];
    for_particles(tile, [&](int k, int column, int) {
      tile.set_vector(Tile::vx, k, tile.vector(Tile::vx, k) + dt * outside(time, place_in_piece(tile, rag, k, column)));
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

bool is_observable_of_particles(const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

std::vector<double> run_for(const CaseFile& file, const std::vector<Asked>& asked, double step_factor, const OutsideForce& outside,
                            WaterStore* store, const std::optional<Restart>& restart) {
  const log::Silence silence;
  Simulation run(file, MPI_COMM_SELF, {}, store);
  std::vector<Question> slots = slots_of(asked, run.observe_settings.has_window());
  if (!run.rags || (run.mesh && !run.frozen()))
    throw Error(ExitCode::usage,
                file.root().where() + ": must be a case of particles without a mesh or in frozen water, to be run in a moment");
  run.start();
  run.insert_rags();
  const double end = run.time_settings.end;
  const std::int64_t n_steps = n_steps_of(run.time_settings, step_factor);
  const double dt = run.time_settings.step = end / static_cast<double>(n_steps);
  const double last = last_time(slots, end);
  Observer observer(*run.rags, run.observe_settings, std::move(slots), end, dt);
  const std::int64_t restart_step = restart ? static_cast<std::int64_t>(restart->time / dt + 1e-9) : -1;
  const auto restart_at = [&](std::int64_t n) {
    if (n == restart_step) move(*run.rags, *restart, static_cast<double>(n) * dt);
  };
  restart_at(0);
  observer.look(0);
  for (std::int64_t n = 0; n < n_steps && static_cast<double>(n) * dt < last * (1 - 1e-9); ++n) {
    // Without a mesh there are no openings to leave by, and nothing to be told of the way.
    if (run.mesh)
      run.step();
    else
      run.coupled ? run.coupled->step(dt) : run.rags->advance(dt);
    if (outside) kick(*run.rags, outside, (static_cast<double>(n) + 0.5) * dt, dt);
    if (run.mesh && run.passage->all_exited_at()) break;
    restart_at(n + 1);
    observer.look(static_cast<double>(n + 1) * dt);
  }
  return observer.values();
}

}  // namespace snag
