#include "dem/holds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

/// A piece's own name, or the one that it shares with its copies: "strip" of "strip 2".
bool is_named(const std::string& piece, const std::string& name) {
  if (name.empty() || piece == name) return true;
  return piece.starts_with(name + " ") && piece.find_first_not_of("0123456789", name.size() + 1) == std::string::npos;
}

using HoldKind = HoldSettings::Kind;

struct Range {
  int first = 0, last = 0;
  bool has(int place) const { return place >= first && place <= last; }
};

/// The places that a key gives, of n in the lattice.
Range range_of(const std::vector<double>& given, const char* key, int n, const Rag& rag, const std::string& where) {
  if (given.empty()) return {0, n - 1};
  const auto is_place = [&](double place) { return place >= 0 && place < n && place == std::floor(place); };
  if (given.size() != 2 || !is_place(given[0]) || !is_place(given[1]) || given[0] > given[1]) {
    std::string text;
    for (const double value : given) text += (text.empty() ? "" : ", ") + number_text(value);
    throw Error(ExitCode::usage, where + " " + key + " = [" + shortened(text) + "] of " + rag.name +
                                     ": must be the first and the last of whole numbers from 0 to " + std::to_string(n - 1) +
                                     "; correct it, or name another piece in `rag`");
  }
  return {static_cast<int>(given[0]), static_cast<int>(given[1])};
}

/// Columns and rows of a hold.
std::array<Range, 2> ranges_of(const HoldSettings& hold, const Rag& rag, const std::string& where) {
  const Range columns = range_of(hold.columns, "columns", rag.n_columns, rag, where);
  const Range rows = range_of(hold.rows, "rows", rag.n_rows, rag, where);
  switch (hold.edge) {
    case HoldSettings::Edge::first_column:
      return {Range{0, 0}, rows};
    case HoldSettings::Edge::last_column:
      return {Range{rag.n_columns - 1, rag.n_columns - 1}, rows};
    case HoldSettings::Edge::first_row:
      return {columns, Range{0, 0}};
    case HoldSettings::Edge::last_row:
      return {columns, Range{rag.n_rows - 1, rag.n_rows - 1}};
    case HoldSettings::Edge::none:
      break;
  }
  return {columns, rows};
}

bool is_in_box(const HoldSettings& hold, const Vec3& x) {
  for (std::size_t c = 0; c < 3; ++c)
    if (x[c] < hold.box_lower[c] || x[c] > hold.box_upper[c]) return false;
  return true;
}

/// Lattice places (row * n_columns + column) that a hold chooses, ascending; some may be outside the mask of the piece.
std::vector<int> chosen_places(const HoldSettings& hold, const RagPiece& piece, const Rag& rag, const std::string& where) {
  const int n = rag.n_columns * rag.n_rows;
  std::vector<int> places;
  for (const double given : hold.particles) {
    if (given < 0 || given >= n || given != std::floor(given))
      throw Error(ExitCode::usage, where + " particles: " + number_text(given) + " is not a particle of " + rag.name +
                                       ", must be a whole number from 0 to " + std::to_string(n - 1) + ", row * " +
                                       std::to_string(rag.n_columns) + " + column; correct it, or name another piece in `rag`");
    places.push_back(static_cast<int>(given));
  }
  if (!hold.particles.empty()) {
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
  }
  const auto [columns, rows] = ranges_of(hold, rag, where);
  for (int row = rows.first; row <= rows.last; ++row)
    for (int column = columns.first; column <= columns.last; ++column)
      if (hold.box_lower.empty() || (piece.exists(column, row) && is_in_box(hold, piece.pose(column, row).position)))
        places.push_back(row * rag.n_columns + column);
  return places;
}

/// Keys without effect are refused.
void check(const HoldSettings& hold, const std::string& where) {
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, where + what); };
  std::vector<std::string> given;
  const auto note = [&](const char* key, bool is_given) {
    if (is_given) given.emplace_back(key);
  };
  note("edge", hold.edge != HoldSettings::Edge::none), note("columns", !hold.columns.empty()), note("rows", !hold.rows.empty());
  note("particles", !hold.particles.empty()), note("box_lower", !hold.box_lower.empty()), note("box_upper", !hold.box_upper.empty());
  if (given.empty())
    refuse(" selects no particles: must have one of edge, columns, rows, particles, box_lower with box_upper; give one of them");
  const auto are_one_choice = [&](const char* one, const char* other) {
    return std::all_of(given.begin(), given.end(), [&](const std::string& key) { return key == one || key == other; });
  };
  if (given.size() > 1 && !are_one_choice("columns", "rows") && !are_one_choice("box_lower", "box_upper"))
    refuse(" has " + joined(given) + ": must have one kind of choice; remove the others");
  if (hold.box_lower.empty() != hold.box_upper.empty()) refuse(": box_lower and box_upper need each other; give both");
  for (const auto& [key, corner] : {std::pair{"box_lower", &hold.box_lower}, std::pair{"box_upper", &hold.box_upper}})
    if (!corner->empty() && corner->size() != 3)
      refuse(std::string(" ") + key + ": has " + counted(static_cast<std::int64_t>(corner->size()), "number") +
             ", must have three; give x, y and z");
  for (std::size_t c = 0; c < hold.box_lower.size(); ++c)
    if (hold.box_lower[c] > hold.box_upper[c])
      refuse(": box_lower (" + number_text(hold.box_lower[c]) + " m) is above box_upper (" + number_text(hold.box_upper[c]) +
             " m) along axis " + std::to_string(c) + "; exchange or correct them");
  if ((hold.kind == HoldKind::hinge) != (norm_squared(hold.hinge_axis) > 0))
    refuse(hold.kind == HoldKind::hinge
               ? " kind = \"hinge\" without hinge_axis, the direction about which its particles turn freely; give it"
               : " hinge_axis needs kind = \"hinge\", it is \"" + hold.kind.word() + "\"; set kind, or remove it");
  const HoldMotion& motion = hold.motion;
  if ((norm_squared(motion.amplitude) > 0) != (motion.frequency > 0))
    refuse(": amplitude and frequency of an oscillation need each other; give both, or none");
  if (motion.rotation_speed != 0 && norm_squared(motion.axis) == 0)
    refuse(" axis = (0, 0, 0), a hold that turns needs a direction; give axis");
}

/// What of a rotation the hold determines; hinge: `axis`, unit.
Vec3 held_part(const HoldSettings& hold, const Vec3& axis, const Vec3& w) {
  if (hold.kind == HoldKind::clamp) return w;
  return hold.kind == HoldKind::pin ? Vec3{} : w - dot(w, axis) * axis;
}

/// That takes x along during a drift, m/s.
Vec3 velocity_during(const HoldMotion& motion, const Vec3& x, double time, double drift) {
  return motion.moves() ? (motion.moved(x, time, time + drift) - x) / drift : Vec3{};
}

double freedom(const HoldSettings& hold, double time) {
  const bool released = hold.release_time && time >= *hold.release_time * (1 - 1e-12);  // a step that begins then has its time to round-off
  if (released) return 1;
  return hold.kind == HoldKind::clamp ? 0 : pinned;
}

}  // namespace

Section HoldSettings::section() {
  const auto vector = [](const char* key, Vec3* target, const char* unit, const char* meaning) {
    return Parameter{.key = key, .target = target, .unit = unit, .meaning = meaning};
  };
  return {
      "hold",
      "Particles of rags that are held, at rest or in a prescribed motion. Reactions: monitors/holds.csv.",
      {setting("rag", &rag,
               "Name of the piece as in outputs; without the number of a copy: all copies. Not given: every piece of the case."),
       setting("edge", &edge, "Edge of the lattice that is held; not given: the particles of `columns` and `rows`."),
       {.key = "columns",
        .target = &columns,
        .minimum = 0,
        .meaning = "First and last lattice column that is held, counted from 0 along `lengthwise`; not given: all columns."},
       {.key = "rows",
        .target = &rows,
        .minimum = 0,
        .meaning = "First and last lattice row that is held, counted from 0 along `crosswise`; not given: all rows."},
       {.key = "particles",
        .target = &particles,
        .minimum = 0,
        .meaning = "List of the particles that are held, each as row * number of columns + column."},
       {.key = "box_lower",
        .target = &box_lower,
        .unit = "m",
        .meaning = "Lowest corner x, y, z of a box: the particles that start between it and `box_upper` are held."},
       {.key = "box_upper", .target = &box_upper, .unit = "m", .meaning = "Highest corner of that box."},
       setting("kind", &kind,
               "clamp: position and rotation follow the hold. pin: the position alone. hinge: a particle turns freely about `hinge_axis`."),
       vector("hinge_axis", &hinge_axis, "1", "hinge: direction of the axis, a vector of any length; it turns with the hold."),
       vector("velocity", &motion.velocity, "m/s", "Velocity of translation of the hold."),
       vector("amplitude", &motion.amplitude, "m",
              "Amplitude A of an oscillation of the hold, A (sin(2 pi f t + phase) - sin(phase)), in addition to its other motion."),
       {.key = "frequency", .target = &motion.frequency, .unit = "Hz", .minimum = 0, .meaning = "Frequency f of the oscillation."},
       {.key = "phase", .target = &motion.phase, .unit = "rad", .meaning = "Phase of the oscillation at time 0."},
       vector("axis", &motion.axis, "1", "Direction of the axis of rotation of the hold, a vector of any length."),
       vector("origin", &motion.origin, "m", "A point on the axis of rotation at time 0; it moves with the hold."),
       {.key = "rotation_speed",
        .target = &motion.rotation_speed,
        .unit = "rad/s",
        .meaning = "Speed of rotation of the hold, right-handed about the axis."},
       {.key = "ramp",
        .target = &motion.ramp,
        .unit = "s",
        .minimum = 0,
        .meaning = "Time in which velocity and speed of rotation grow linearly from zero."},
       {"release_time", &release_time, "s", 0, infinity, Basis::assumed,
        "The hold ends with the first time step that begins at this time or later; not given: it lasts to the end."}},
      true};
}
const bool hold_table = add_case_table<HoldSettings>(180);

Holds::Holds(const Table& root, const RagSystem& rags, const Vec3& gravity) : rags_(rags), gravity_(gravity) {
  std::vector<std::string> all_where;
  for (const Table& table : root.tables("hold")) {
    HoldSettings& hold = settings_.emplace_back();
    const std::string where = all_where.emplace_back(table.where());
    table.read(hold.section().parameters);
    check(hold, where);
    if (place_of_.empty()) {
      const Rag& last = rags.rags().back();
      place_of_.assign(static_cast<std::size_t>(last.first_particle) + static_cast<std::size_t>(last.n_columns) * last.n_rows, -1);
    }
    const std::size_t n_before = places_.size();
    std::string known;
    for (std::size_t r = 0; r < rags.rags().size(); ++r) {
      known += (r > 0 ? ", " : "") + rags.rags()[r].name;
      if (is_named(rags.rags()[r].name, hold.rag))
        select(static_cast<int>(settings_.size()) - 1, where, rags, static_cast<int>(r), all_where);
    }
    if (places_.size() == n_before)
      throw Error(ExitCode::usage, where + " rag = \"" + shortened(hold.rag) + "\": must name a piece of the case; known: " + known);
  }
  reactions_.resize(places_.size());
}

void Holds::select(int hold, const std::string& where, const RagSystem& rags, int rag, const std::vector<std::string>& all_where) {
  const RagPiece& piece = rags.pieces()[static_cast<std::size_t>(rag)];
  const Rag& lattice = rags.rags()[static_cast<std::size_t>(rag)];
  const HoldSettings& settings = settings_[static_cast<std::size_t>(hold)];
  Place place{.hold = hold, .rag = rag, .rag_name = lattice.name, .n_particles = 0, .point = {}, .start_time = piece.insert_time};
  for (const int chosen : chosen_places(settings, piece, lattice, where)) {
    const int column = chosen % lattice.n_columns, row = chosen / lattice.n_columns;
    if (!piece.exists(column, row)) continue;
    int& holder = place_of_[static_cast<std::size_t>(lattice.first_particle) + static_cast<std::size_t>(chosen)];
    if (holder >= 0)
      throw Error(ExitCode::usage, where + " holds the particle at column " + std::to_string(column) + ", row " + std::to_string(row) +
                                       " of " + lattice.name + ", which " +
                                       all_where[static_cast<std::size_t>(places_[static_cast<std::size_t>(holder)].hold)] +
                                       " holds already: a particle must have one hold at most; change columns or rows of one of them");
    holder = static_cast<int>(places_.size());
    ++place.n_particles;
    const Vec3 x = piece.pose(column, row).position;
    place.point += x, place.reach = std::max(place.reach, norm(x - settings.motion.origin));
  }
  if (place.n_particles == 0)
    throw Error(ExitCode::usage,
                where + " selects no particle of " + lattice.name +
                    ": must select one at least; a disc has no particles in the corners of its lattice, and a box holds those "
                    "that start in it; choose other places, or name another piece in `rag`");
  place.point = place.point / static_cast<double>(place.n_particles);
  places_.push_back(place);
}

void Holds::apply(RagSystem& rags, double time) const {
  for (Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[static_cast<std::size_t>(tile.rag)];
    for_particles(tile, [&](int k, int i, int j) {
      const int place = place_of_[static_cast<std::size_t>(particle_id(rag, tile, i, j))];
      if (place < 0) return;
      const HoldSettings& hold = settings_[static_cast<std::size_t>(places_[static_cast<std::size_t>(place)].hold)];
      const double is = freedom(hold, time);
      if (is <= pinned && tile.free[k] > 0.5) {
        const Vec3 w = tile.vector(Tile::wx, k), axis = unit(hold.motion.turned(hold.hinge_axis, 0, time));
        tile.set_vector(Tile::vx, k, hold.motion.velocity_at(tile.vector(Tile::x, k), time));
        tile.set_vector(Tile::wx, k, w + held_part(hold, axis, hold.motion.spin(time) - w));
      }
      tile.free[k] = is;
    });
  }
}

void Holds::begin(std::span<Tile> tiles, double time, double drift) {
  duration_ = 0;
  std::fill(reactions_.begin(), reactions_.end(), Reaction{});
  held_.resize(tiles.size());
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    Tile& tile = tiles[t];
    const Rag& rag = rags_.rags()[static_cast<std::size_t>(tile.rag)];
    held_[t].clear();
    std::fill(tile.held_change.begin(), tile.held_change.end(), 0.0);
    for_particles(tile, [&](int k, int i, int j) {
      if (tile.free[k] > 0.5) return;
      const int place = place_of_[static_cast<std::size_t>(particle_id(rag, tile, i, j))];
      if (place < 0) return;
      const Vec3 v = tile.vector(Tile::vx, k);
      const Vec3 v_new = velocity_during(motion_of(place), tile.vector(Tile::x, k), time, drift);
      const Held& held = held_[t].emplace_back(Held{k, place, v_new - v, v_new});
      ++reactions_[static_cast<std::size_t>(place)].n_particles;
      move(tile, held, time, drift, {}, 0);
    });
  }
}

void Holds::announce(std::size_t index, Tile& tile, double time, double drift) {
  for (Held& held : held_[index]) {
    const HoldMotion& motion = motion_of(held.place);
    if (!motion.moves()) continue;
    const std::size_t n = tile.exists.size();
    if (tile.held_change.empty()) tile.held_change.assign(3 * n, 0.0);
    held.velocity = velocity_during(motion, tile.vector(Tile::x, held.k), time, drift);
    held.change += held.velocity - tile.vector(Tile::vx, held.k);
    for (std::size_t c = 0; c < 3; ++c) tile.held_change[c * n + static_cast<std::size_t>(held.k)] = held.change[static_cast<int>(c)];
    held.change = {};
  }
}

void Holds::kick(std::size_t index, Tile& tile, double time, double step, double drift) {
  if (index == 0) duration_ += step;
  const Rag& rag = rags_.rags()[static_cast<std::size_t>(tile.rag)];
  for (const Held& held : held_[index]) move(tile, held, time, drift, step * (tile.vector(Tile::fx, held.k) + rag.mass * gravity_), step);
}

/// Velocity and rotation of a held particle for the drift from `time` on, and what the hold gave for it.
void Holds::move(Tile& tile, const Held& held, double time, double drift, const Vec3& force_impulse, double step) {
  const Place& place = places_[static_cast<std::size_t>(held.place)];
  const HoldSettings& hold = settings_[static_cast<std::size_t>(place.hold)];
  const HoldMotion& motion = hold.motion;
  const Rag& rag = rags_.rags()[static_cast<std::size_t>(tile.rag)];
  const Vec3 x = tile.vector(Tile::x, held.k), v = tile.vector(Tile::vx, held.k), w = tile.vector(Tile::wx, held.k),
             torque = tile.vector(Tile::tx, held.k), axis = unit(motion.turned(hold.hinge_axis, 0, time));
  const Vec3 turn = held_part(hold, axis, motion.mean_spin(time, time + drift) - w);  // of what is held
  tile.set_vector(Tile::vx, held.k, held.velocity), tile.set_vector(Tile::wx, held.k, w + turn);
  const Vec3 held_torque = step > 0 ? held_part(hold, axis, torque) : Vec3{};
  if (step > 0) tile.set_vector(Tile::tx, held.k, torque - held_torque);  // the rest turns it

  const Vec3 J = rag.mass * (held.velocity - v) - force_impulse;
  const Vec3 point = motion.moved(place.point, place.start_time, time);
  const Vec3 L = cross(x - point, J) + rag.inertia * turn - step * held_torque;
  std::array<RunningSum, 6>& sums = reactions_[static_cast<std::size_t>(held.place)].impulse;
  for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)].add(J[c]), sums[static_cast<std::size_t>(3 + c)].add(L[c]);
}

std::vector<HoldReaction> Holds::reactions(const RagSystem& rags, double time) const {
  std::vector<RunningSum> terms;
  for (const Reaction& one : reactions_) terms.insert(terms.end(), one.impulse.begin(), one.impulse.end());
  const std::vector<double> impulse = sums(rags.comm(), terms);
  const double duration = maximum(rags.comm(), duration_);
  std::vector<HoldReaction> all;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& place = places_[p];
    const std::int64_t n = sum(rags.comm(), reactions_[p].n_particles);
    if (rags.presence(place.rag) != RagSystem::Presence::present) continue;
    const double* J = &impulse[6 * p];
    const double share = duration > 0 ? 1 / duration : 0;
    const HoldMotion& motion = settings_[static_cast<std::size_t>(place.hold)].motion;
    all.push_back({.time = time,
                   .hold = place.hold,
                   .rag = place.rag,
                   .n_particles = n,
                   .point = motion.moved(place.point, place.start_time, time),
                   .force = share * Vec3{J[0], J[1], J[2]},
                   .moment = share * Vec3{J[3], J[4], J[5]}});
  }
  return all;
}

double Holds::largest_speed() const {
  double speed = 0;
  for (const Place& place : places_)
    speed = std::max(speed, settings_[static_cast<std::size_t>(place.hold)].motion.largest_speed(place.reach));
  return speed;
}

std::vector<std::string> Holds::lines() const {
  const auto vector = [](const Vec3& v) { return "(" + number_text(v.x) + ", " + number_text(v.y) + ", " + number_text(v.z) + ")"; };
  std::vector<std::string> all;
  for (const Place& place : places_) {
    const HoldSettings& hold = settings_[static_cast<std::size_t>(place.hold)];
    const HoldMotion& motion = hold.motion;
    std::string line = "hold " + std::to_string(place.hold) + ": " + counted(place.n_particles, "particle") + " of " + place.rag_name;
    line += hold.kind == HoldKind::clamp ? " clamped"
            : hold.kind == HoldKind::pin ? " pinned"
                                         : " hinged about " + vector(unit(hold.hinge_axis));
    line += ", mean position " + vector(place.point) + " m";
    if (norm_squared(motion.velocity) > 0) line += ", moves with " + vector(motion.velocity) + " m/s";
    if (motion.rotation_speed != 0)
      line += ", turns at " + number_text(motion.rotation_speed) + " rad/s about " + vector(unit(motion.axis));
    if (motion.frequency > 0) line += ", oscillates by " + vector(motion.amplitude) + " m at " + number_text(motion.frequency) + " Hz";
    if (hold.release_time) line += ", until " + number_text(*hold.release_time) + " s";
    all.push_back(line);
  }
  return all;
}

}  // namespace snag
