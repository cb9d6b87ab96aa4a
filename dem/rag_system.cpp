#include "dem/rag_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/tile_halo.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr int pressed_interval = 16;  // sub-steps: contacts change little in so few of them, and ranks have to agree on the limit

Inertia inertia_of(const Rag& rag, const Vec3& gravity) { return {rag.mass, rag.inertia, gravity}; }

}  // namespace

RagSystem::RagSystem(MPI_Comm comm, const DemSettings& settings, std::vector<RagPiece> pieces)
    : comm_(comm), settings_(settings), pieces_(std::move(pieces)) {
  std::int64_t id = 0;
  int n_tiles = 0;
  for (RagPiece& piece : pieces_) {
    Rag& rag = piece.rag;
    rag.first_particle = id;
    id += static_cast<std::int64_t>(rag.n_columns) * rag.n_rows;
    rag.n_particles = count_particles(piece), rag.n_bonds = count_bonds(piece);
    rags_.push_back(rag);
    bonds_.push_back(bonds_of(rag));
    grids_.push_back(tile_grid(rag.n_columns, rag.n_rows));
    grids_.back().first_tile = n_tiles;
    n_tiles += grids_.back().n_tiles();
  }
  broken_.assign(rags_.size(), 0);
  owner_.assign(n_tiles, -1);
  presence_.assign(rags_.size(), Presence::waiting);
  for (std::size_t r = 0; r < pieces_.size(); ++r)
    if (pieces_[r].insert_time <= 0 && !pieces_[r].match_flow_velocity) add_tiles(static_cast<int>(r));
  set_limit();
  set_pointers();
  find_ghosts();
}

RagSystem::~RagSystem() = default;

/// Makes the tiles of a rag, in equal blocks of all tiles over the ranks.
void RagSystem::add_tiles(int rag) {
  const int first = grids_[rag].first_tile, end = first + grids_[rag].n_tiles();
  const auto place = std::lower_bound(numbers_.begin(), numbers_.end(), first) - numbers_.begin();
  std::vector<int> numbers;
  std::vector<Tile> tiles;
  for (int t = first; t < end; ++t) {
    owner_[t] = static_cast<int>(static_cast<std::int64_t>(t) * size_of(comm_) / n_all_tiles());
    if (owner_[t] == rank_of(comm_)) numbers.push_back(t), tiles.push_back(tile_at_birth(t));
  }
  numbers_.insert(numbers_.begin() + place, numbers.begin(), numbers.end());
  tiles_.insert(tiles_.begin() + place, std::make_move_iterator(tiles.begin()), std::make_move_iterator(tiles.end()));
  presence_[rag] = Presence::present;
}

void RagSystem::insert(int rag) {
  add_tiles(rag);
  set_pointers();
  find_ghosts();
  halo_->exchange();
}

void RagSystem::remove(int rag) {
  const int first = grids_[rag].first_tile, end = first + grids_[rag].n_tiles();
  const auto from = std::lower_bound(numbers_.begin(), numbers_.end(), first) - numbers_.begin();
  const auto to = std::lower_bound(numbers_.begin(), numbers_.end(), end) - numbers_.begin();
  numbers_.erase(numbers_.begin() + from, numbers_.begin() + to);
  tiles_.erase(tiles_.begin() + from, tiles_.begin() + to);
  std::fill(owner_.begin() + first, owner_.begin() + end, -1);
  presence_[rag] = Presence::removed;
  set_pointers();
  find_ghosts();
  halo_->exchange();
}

void RagSystem::add_velocity(int rag, const Vec3& velocity) {
  for (Tile& tile : tiles_)
    if (tile.rag == rag) for_particles(tile, [&](int k, int, int) { tile.set_vector(Tile::vx, k, tile.vector(Tile::vx, k) + velocity); });
  halo_->exchange();
}

void RagSystem::set_contacts(std::unique_ptr<ContactSolver> contacts) {
  contacts_ = std::move(contacts);
  set_limit();
  find_ghosts();
}

void RagSystem::set_damping_rate(double rate) {
  damping_rate_ = rate;
  set_limit();
}

std::int64_t RagSystem::n_particles() const {
  std::int64_t n = 0;
  for (const Rag& rag : rags_) n += rag.n_particles;
  return n;
}

void RagSystem::set_limit() {
  limit_ = {std::numeric_limits<double>::infinity(), "nothing"};
  rates_.clear();
  for (const Rag& rag : rags_) {
    rates_.push_back(bond_rates(rag, damping_rate_));
    const StepLimit of_rag = stable_bond_step(rag, damping_rate_);
    if (of_rag.step < limit_.step) limit_ = of_rag;
  }
  // A single sphere without walls has nothing to touch.
  const bool can_touch = contacts_ && (n_particles() > 1 || !contacts_->wall_touches().empty());
  if (can_touch && contacts_->stable_step() < limit_.step) limit_ = {contacts_->stable_step(), contacts_->stable_step_reason()};
  if (settings_.step && *settings_.step > limit_.step)
    throw Error(ExitCode::usage, "[dem] step: " + number_text(*settings_.step) + " s is above the stable step of " +
                                     number_text(limit_.step) + " s, set by " + limit_.reason +
                                     "; give a shorter step, or none to let Snag choose");
}

double RagSystem::stable_step() const { return settings_.step ? *settings_.step : settings_.safety * limit_.step; }
double RagSystem::pressed_step() const { return settings_.step ? *settings_.step : settings_.safety * pressed_limit_; }

/// Drift-kick-drift (dem/particles/integrator.hpp); the half drifts between two sub-steps are one.
void RagSystem::advance(double dt, TileForce* force) {
  const auto n_of = [&](double time) {
    return std::max(1, static_cast<int>(std::ceil(time / std::min(stable_step(), pressed_step()) * (1 - 1e-12))));
  };
  int n_left = n_of(dt);
  double step = dt / n_left, left = dt;
  if (contacts_) contacts_->set_time(time_ + step / 2), contacts_->start_wall_loads();
  if (motion_) motion_->begin(tiles_, time_, step / 2);
  for (Tile& tile : tiles_) drift(tile, step / 2);
  const Box* moved = nullptr;  // not known of the half drift and of what was done to the rags in between
  int& k = n_last_sub_steps_;
  for (k = 0; n_left > 0; ++k) {
    exchange_ghosts(moved);
    halo_->fill_rings();
    evaluate_contacts(step, moved, k % pressed_interval == 0);
    --n_left, left -= step;
    double next = step;
    if (contacts_ && n_left > 0 && (step > pressed_step() || 2 * step < std::min(stable_step(), pressed_step()))) {
      n_left = n_of(left), next = left / n_left;
      contacts_->set_time(time_ + dt - left + next / 2);
    }
    kick_and_drift_tiles(time_ + dt - left - step / 2, step, n_left > 0 ? step / 2 + next / 2 : step / 2, force);
    moved = &moved_;
    step = next;
  }
  time_ += dt, n_sub_steps_ += k, n_particle_steps_ += k * n_owned_particles_;
  halo_->exchange();
  check();
}

void RagSystem::exchange_ghosts(const Box* moved) {
  if (contacts_ && size_of(comm_) > 1) {
    int outdated = ghosts_outdated(moved), any = 0;
    MPI_Allreduce(&outdated, &any, 1, MPI_INT, MPI_MAX, comm_);
    if (any) renew_ghosts();
  }
  halo_->exchange_ghosts();
}

void RagSystem::evaluate_contacts() {
  if (!contacts_) return;
  contacts_->set_time(time_);
  exchange_ghosts();
  contacts_->add_forces(owned_pointers_, ghost_pointers_, 0);
}

void RagSystem::evaluate_contacts(double step, const Box* moved, bool with_limit) {
  if (!contacts_) return;
  if (!with_limit) return contacts_->evaluate(owned_pointers_, ghost_pointers_, step, moved);
  pressed_limit_ = contacts_->evaluate_with_limit(owned_pointers_, ghost_pointers_, step, moved, rates_, limit_.step);
  MPI_Allreduce(MPI_IN_PLACE, &pressed_limit_, 1, MPI_DOUBLE, MPI_MIN, comm_);
  if (settings_.step && *settings_.step > pressed_limit_ && !warned_of_step_) {
    warned_of_step_ = true;
    if (rank_of(comm_) == 0)
      log::warning("[dem] step of " + number_text(*settings_.step) + " s is above the stable step of " + number_text(pressed_limit_) +
                   " s at t = " + number_text(time_) +
                   " s, where particles are pressed by several contacts at once: the rags may heat up; leave the key out, "
                   "or give a shorter step");
  }
}

void RagSystem::kick_and_drift_tiles(double time, double step, double drift_step, TileForce* force) {
  Box velocities;
  // Everything else a tile at a time, while it is in the cache.
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    Tile& tile = tiles_[i];
    if (rags_[tile.rag].n_bonds == 0) {
      std::fill_n(tile.field(Tile::fx), (Tile::n_fields - Tile::fx) * tile.field_size, 0.0);
    } else {
      broken_[tile.rag] += bonds_[tile.rag]->set_forces(rags_[tile.rag].breakage, tile, tiles_[(i + 1) % tiles_.size()]);
    }
    if (contacts_) contacts_->add_to_tile(i);
    if (motion_) motion_->announce(i, tile, time, drift_step);
    if (force) force->add(i, tile, step);  // last: an implicit drag needs the sum of all other forces
    if (motion_) motion_->kick(i, tile, time, step, drift_step);
    velocities.include(kick_and_drift(tile, inertia_of(rags_[tile.rag], gravity_), step, drift_step));
  }
  moved_ = {};
  if (!velocities.empty()) moved_.lower = drift_step * velocities.lower, moved_.upper = drift_step * velocities.upper;
}

void RagSystem::clamp(const std::function<bool(std::int64_t)>& held) {
  for (Tile& tile : tiles_)
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) {
        const int k = tile.index(i, j);
        tile.free[k] = tile.exists[k] > 0.5 && !held(particle_id(rags_[tile.rag], tile, i, j)) ? 1 : 0;
      }
}

void RagSystem::set_clamp_velocity(const std::function<Vec3(std::int64_t)>& velocity) {
  for (Tile& tile : tiles_)
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) {
        const int k = tile.index(i, j);
        if (tile.exists[k] < 0.5 || tile.free[k] > 0.5) continue;
        tile.set_vector(Tile::vx, k, velocity(particle_id(rags_[tile.rag], tile, i, j)));
        tile.set_vector(Tile::wx, k, {});
      }
}

}  // namespace snag
