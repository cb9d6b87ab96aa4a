// State of the rags in a checkpoint: particles by id, contact history by tile, counters. A bond is kept with its first end.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"
#include "dem/tile_halo.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr int n_particle_values = Tile::n_state + 3;  // state, free, bond_x, bond_y
constexpr int history_width = 16;                     // doubles in a row of contact history
constexpr std::int64_t max_history_rows = std::int64_t{1} << 32;

/// Visits the existing particles of tiles: f(tile, place, id).
template <class Tiles, class F>
void for_all_particles(Tiles& tiles, const std::vector<Rag>& rags, const F& f) {
  for (auto& tile : tiles) for_particles(tile, [&](int k, int i, int j) { f(tile, k, particle_id(rags[tile.rag], tile, i, j)); });
}

/// Visits the bonds into a tile from its ring: f(marks, place, id of the first end).
template <class F>
void for_ring_bonds(Tile& tile, const Rag& rag, const F& f) {
  for (int j = 0; j < tile.ny; ++j)
    if (tile.bond_x[tile.index(-1, j)] > 0.5) f(tile.bond_x, tile.index(-1, j), particle_id(rag, tile, -1, j));
  for (int i = 0; i < tile.nx; ++i)
    if (tile.bond_y[tile.index(i, -1)] > 0.5) f(tile.bond_y, tile.index(i, -1), particle_id(rag, tile, i, -1));
}

}  // namespace

void RagSystem::save(CheckpointWriter& writer) const {
  std::vector<std::int64_t> tile_ids(numbers_.begin(), numbers_.end()), history_rows, particle_ids, row_ids;
  std::vector<double> particles, history;
  for_all_particles(tiles_, rags_, [&](const Tile& tile, int k, std::int64_t id) {
    particle_ids.push_back(id);
    for (int f = 0; f < Tile::n_state; ++f) particles.push_back(tile.field(f)[k]);
    particles.push_back(tile.free[k]), particles.push_back(tile.bond_x[k]), particles.push_back(tile.bond_y[k]);
  });
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const std::vector<double> values = contacts_ ? contacts_->pack(tiles_[i]) : std::vector<double>();
    const std::int64_t n_rows = (static_cast<std::int64_t>(values.size()) + history_width - 1) / history_width;
    history_rows.push_back(static_cast<std::int64_t>(values.size()));
    for (std::int64_t r = 0; r < n_rows; ++r) row_ids.push_back(numbers_[i] * max_history_rows + r);
    history.insert(history.end(), values.begin(), values.end());
    history.resize(row_ids.size() * history_width, 0.0);
  }
  writer.rows("rags/contact_history_length", tile_ids, history_rows, 1);
  writer.rows("rags/contact_history", row_ids, history, history_width);
  writer.rows("rags/particles", particle_ids, particles, n_particle_values);
  std::vector<std::int64_t> counters(broken_);
  MPI_Allreduce(MPI_IN_PLACE, counters.data(), static_cast<int>(counters.size()), MPI_INT64_T, MPI_SUM, comm_);
  counters.push_back(n_sub_steps_);
  writer.shared("rags/counters", std::span<const std::int64_t>(counters));
  std::vector<std::int64_t> removed;
  for (std::size_t r = 0; r < rags_.size(); ++r)
    if (presence_[r] == Presence::removed) removed.push_back(static_cast<std::int64_t>(r));
  writer.shared("rags/removed", std::span<const std::int64_t>(removed));
  writer.shared("rags/time", std::vector<double>{time_, pressed_limit_});
}

void RagSystem::load(CheckpointReader& reader) {
  std::vector<std::int64_t> tile_ids = reader.ids("rags/contact_history_length");
  std::sort(tile_ids.begin(), tile_ids.end());
  numbers_.assign(tile_ids.begin(), tile_ids.end());
  tiles_.clear();
  for (const int number : numbers_) tiles_.push_back(tile_at_birth(number));
  std::fill(owner_.begin(), owner_.end(), -1);
  for (const int number : numbers_) owner_.at(number) = rank_of(comm_);
  MPI_Allreduce(MPI_IN_PLACE, owner_.data(), static_cast<int>(owner_.size()), MPI_INT, MPI_MAX, comm_);

  const std::vector<std::int64_t> removed = reader.shared_integers("rags/removed");
  for (std::size_t r = 0; r < rags_.size(); ++r) {
    const bool is_gone = std::find(removed.begin(), removed.end(), static_cast<std::int64_t>(r)) != removed.end();
    presence_[r] = owner_[grids_[r].first_tile] >= 0 ? Presence::present : is_gone ? Presence::removed : Presence::waiting;
  }

  std::vector<std::int64_t> ids;
  for_all_particles(tiles_, rags_, [&](const Tile&, int, std::int64_t id) { ids.push_back(id); });
  for (Tile& tile : tiles_) for_ring_bonds(tile, rags_[tile.rag], [&](auto&, int, std::int64_t id) { ids.push_back(id); });
  const std::vector<double> particles = reader.rows("rags/particles", ids, n_particle_values);
  const double* row = particles.data();
  for_all_particles(tiles_, rags_, [&](Tile& tile, int k, std::int64_t) {
    for (int f = 0; f < Tile::n_state; ++f) tile.field(f)[k] = row[f];
    tile.free[k] = row[Tile::n_state], tile.bond_x[k] = row[Tile::n_state + 1], tile.bond_y[k] = row[Tile::n_state + 2];
    row += n_particle_values;
  });
  for (Tile& tile : tiles_)
    for_ring_bonds(tile, rags_[tile.rag], [&](AlignedDoubles& marks, int k, std::int64_t) {
      marks[k] = row[Tile::n_state + (&marks == &tile.bond_x ? 1 : 2)];
      row += n_particle_values;
    });

  const std::vector<std::int64_t> length = reader.integer_rows("rags/contact_history_length", tile_ids, 1);
  std::vector<std::int64_t> row_ids;
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    for (std::int64_t r = 0; r < (length[i] + history_width - 1) / history_width; ++r)
      row_ids.push_back(numbers_[i] * max_history_rows + r);
  const std::vector<double> history = reader.rows("rags/contact_history", row_ids, history_width);
  std::size_t start = 0;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (contacts_) contacts_->unpack(tiles_[i], std::span(history).subspan(start, length[i]));
    start += (length[i] + history_width - 1) / history_width * history_width;
  }
  const std::vector<std::int64_t> counters = reader.shared_integers("rags/counters");
  if (counters.size() != rags_.size() + 1)
    throw Error(ExitCode::io, "checkpoint: state of " + std::to_string(counters.size() - 1) + " rags, the case has " +
                                  std::to_string(rags_.size()) + "; resume with the case that wrote it");
  for (std::size_t r = 0; r < rags_.size(); ++r) broken_[r] = rank_of(comm_) == 0 ? counters[r] : 0;
  n_sub_steps_ = counters.back();
  const std::vector<double> times = reader.shared("rags/time");
  if (times.size() != 2)
    throw Error(ExitCode::io, "checkpoint: written by an earlier version, without the limit of the sub-step; start the run anew");
  time_ = times[0], pressed_limit_ = times[1];
  set_pointers();
  find_ghosts();
  halo_->exchange();
  check();
}

}  // namespace snag
