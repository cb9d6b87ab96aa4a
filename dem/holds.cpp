#include "dem/holds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
    for (const double value : given) text += (text.empty() ? "" : ", ") + words(value);
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
  if (hold.edge == "first_column") return {Range{0, 0}, rows};
  if (hold.edge == "last_column") return {Range{rag.n_columns - 1, rag.n_columns - 1}, rows};
  if (hold.edge == "first_row") return {columns, Range{0, 0}};
  if (hold.edge == "last_row") return {columns, Range{rag.n_rows - 1, rag.n_rows - 1}};
  return {columns, rows};
}

}  // namespace

Section HoldSettings::section() {
  return {"hold",
          "Particles of rags that are clamped: position and rotation are held. Reactions: monitors/holds.csv.",
          {setting("rag", &rag,
                   "Name of the piece as in outputs; without the number of a copy: all copies. Not given: every piece of the case."),
           setting("edge", &edge, "Edge of the lattice that is held; not given: the particles of `columns` and `rows`.",
                   {"", "first_column", "last_column", "first_row", "last_row"}),
           {.key = "columns",
            .target = &columns,
            .minimum = 0,
            .meaning = "First and last lattice column that is held, counted from 0 along `lengthwise`; not given: all columns."},
           {.key = "rows",
            .target = &rows,
            .minimum = 0,
            .meaning = "First and last lattice row that is held, counted from 0 along `crosswise`; not given: all rows."},
           {"release_time", &release_time, "s", 0, infinity, Basis::assumed,
            "The hold ends with the first time step that begins at this time or later; not given: it lasts to the end."}},
          true};
}

Holds::Holds(const Table& root, const RagSystem& rags, const Vec3& gravity) : gravity_(gravity) {
  std::vector<std::string> all_where;
  for (const Table& table : root.tables("hold")) {
    HoldSettings& hold = settings_.emplace_back();
    const std::string where = all_where.emplace_back(table.where());
    table.read(hold.section().parameters);
    if (hold.edge.empty() && hold.columns.empty() && hold.rows.empty())
      throw Error(ExitCode::usage, where + " selects no particles: must have one of edge, columns, rows; give one of them");
    if (!hold.edge.empty() && !(hold.columns.empty() && hold.rows.empty()))
      throw Error(ExitCode::usage, where + " edge = \"" + hold.edge + "\" with columns or rows: must have one kind of choice; remove one");
    if (hold_of_.empty()) {
      const Rag& last = rags.rags().back();
      hold_of_.assign(static_cast<std::size_t>(last.first_particle) + static_cast<std::size_t>(last.n_columns) * last.n_rows, -1);
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
}

void Holds::select(int hold, const std::string& where, const RagSystem& rags, int rag, const std::vector<std::string>& all_where) {
  const RagPiece& piece = rags.pieces()[static_cast<std::size_t>(rag)];
  const Rag& lattice = rags.rags()[static_cast<std::size_t>(rag)];
  const auto [columns, rows] = ranges_of(settings_[static_cast<std::size_t>(hold)], lattice, where);
  Place place{.hold = hold, .rag = rag, .rag_name = lattice.name, .n_particles = 0, .point = {}};
  for (int row = rows.first; row <= rows.last; ++row)
    for (int column = columns.first; column <= columns.last; ++column) {
      if (!piece.exists(column, row)) continue;
      int& holder = hold_of_[static_cast<std::size_t>(lattice.first_particle) + static_cast<std::size_t>(row) * lattice.n_columns + column];
      if (holder >= 0)
        throw Error(ExitCode::usage, where + " holds the particle at column " + std::to_string(column) + ", row " + std::to_string(row) +
                                         " of " + lattice.name + ", which " + all_where[static_cast<std::size_t>(holder)] +
                                         " holds already: a particle must have one hold at most; change columns or rows of one of them");
      holder = hold;
      ++place.n_particles;
      place.point += piece.pose(column, row).position;
    }
  if (place.n_particles == 0)
    throw Error(ExitCode::usage,
                where + " selects no particle of " + lattice.name +
                    ": must select one at least; a disc has no particles in the corners of its lattice, choose other places");
  place.point = place.point / static_cast<double>(place.n_particles);
  places_.push_back(place);
}

void Holds::apply(RagSystem& rags, double time) const {
  rags.clamp([&](std::int64_t id) {
    const int hold = hold_of_[static_cast<std::size_t>(id)];
    if (hold < 0) return false;
    const std::optional<double> release = settings_[static_cast<std::size_t>(hold)].release_time;
    return !release || time < *release * (1 - 1e-12);  // a step that begins at the release has its time to round-off only
  });
  rags.set_clamp_velocity([](std::int64_t) { return Vec3{}; });
}

std::vector<HoldReaction> Holds::reactions(const RagSystem& rags, double time) const {
  std::vector<HoldReaction> all;
  for (const Place& place : places_) {
    const Rag& rag = rags.rags()[static_cast<std::size_t>(place.rag)];
    if (rags.presence(place.rag) != RagSystem::Presence::present) continue;
    std::vector<Vec3> forces, moments;
    for (const Tile& tile : rags.tiles()) {
      if (tile.rag != place.rag) continue;
      for_particles(tile, [&](int k, int i, int j) {
        if (tile.free[k] > 0.5 || hold_of_[static_cast<std::size_t>(particle_id(rag, tile, i, j))] != place.hold) return;
        const Vec3 F = tile.vector(Tile::fx, k) + rag.mass * gravity_;
        forces.push_back(-1.0 * F);
        moments.push_back(-1.0 * (cross(tile.vector(Tile::x, k) - place.point, F) + tile.vector(Tile::tx, k)));
      });
    }
    all.push_back({.time = time,
                   .hold = place.hold,
                   .rag = place.rag,
                   .n_particles = sum(rags.comm(), static_cast<std::int64_t>(forces.size())),
                   .point = place.point,
                   .force = sum(rags.comm(), std::span<const Vec3>(forces)),
                   .moment = sum(rags.comm(), std::span<const Vec3>(moments))});
  }
  return all;
}

std::vector<std::string> Holds::lines() const {
  std::vector<std::string> all;
  for (const Place& place : places_) {
    const std::optional<double> release = settings_[static_cast<std::size_t>(place.hold)].release_time;
    all.push_back("hold " + std::to_string(place.hold) + ": " + counted(place.n_particles, "particle") + " of " + place.rag_name +
                  " clamped, mean position (" + words(place.point.x) + ", " + words(place.point.y) + ", " + words(place.point.z) + ") m" +
                  (release ? ", until " + words(*release) + " s" : ""));
  }
  return all;
}

}  // namespace snag
