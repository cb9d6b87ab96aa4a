// Which rank owns which tile, who needs whose tiles, and moving tiles between ranks.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"
#include "dem/tile_halo.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// Mean position of the particles of a tile; their number is `n`.
Vec3 centre_of(const Tile& tile, int& n) {
  Vec3 sum;
  n = 0;
  for_particles(tile, [&](int k, int, int) { sum += tile.vector(Tile::x, k), ++n; });
  return n > 0 ? sum / n : sum;
}

/// Square of the distance of two boxes, each given as lower corner and minus upper corner.
double box_distance_squared(const double* a, const double* b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double gap = std::max({0.0, a[c] + b[3 + c], b[c] + a[3 + c]});
    sum += gap * gap;
  }
  return sum;
}

/// How far a particle may go beyond skin/2 before ghosts are chosen anew, m: more tiles are sent against fewer searches.
double ghost_path(const ContactSolver& contacts) { return contacts.cutoff(); }

}  // namespace

int RagSystem::rag_of_tile(int number) const {
  const auto after =
      std::upper_bound(grids_.begin(), grids_.end(), number, [](int n, const TileGrid& grid) { return n < grid.first_tile; });
  return static_cast<int>(after - grids_.begin()) - 1;
}

Tile RagSystem::tile_at_birth(int number) const {
  const int r = rag_of_tile(number);
  return make_tile(pieces_[r], r, grids_[r], number - grids_[r].first_tile);
}

int RagSystem::neighbour_number(int number, int column_step, int row_step) const {
  const TileGrid& grid = grids_[rag_of_tile(number)];
  const int t = number - grid.first_tile, column = t % grid.columns + column_step, row = t / grid.columns + row_step;
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return -1;
  return grid.first_tile + row * grid.columns + column;
}

void RagSystem::set_pointers() {
  owned_pointers_.clear();
  n_owned_particles_ = 0;
  for (Tile& tile : tiles_) {
    owned_pointers_.push_back(&tile);
    int n = 0;
    centre_of(tile, n);
    n_owned_particles_ += n;
  }
}

int RagSystem::n_rows_of(int number) const {
  const TileGrid& grid = grids_[rag_of_tile(number)];
  const int row = (number - grid.first_tile) / grid.columns;
  return grid.row_start[row + 1] - grid.row_start[row];
}

/// Lower corners and negative upper corners of the rows of all tiles, by number and row.
std::vector<double> RagSystem::all_row_boxes() {
  std::vector<std::size_t> first(owner_.size() + 1, 0);
  for (int t = 0; t < n_all_tiles(); ++t) first[t + 1] = first[t] + static_cast<std::size_t>(n_rows_of(t));
  std::vector<double> boxes(6 * first.back(), std::numeric_limits<double>::infinity());
  boxes_.clear();
  grown_.lower = grown_.upper = {};
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    for (int j = 0; j < tiles_[i].ny; ++j) {
      const Box box = bounding_box(tiles_[i], j);
      boxes_.push_back(box);
      const std::array<double, 6> corners{box.lower.x, box.lower.y, box.lower.z, -box.upper.x, -box.upper.y, -box.upper.z};
      std::copy(corners.begin(), corners.end(), &boxes[6 * (first[numbers_[i]] + j)]);
    }
  MPI_Allreduce(MPI_IN_PLACE, boxes.data(), static_cast<int>(boxes.size()), MPI_DOUBLE, MPI_MIN, comm_);
  return boxes;
}

/// True once a row may have left its box by more than what the ghosts were chosen for: two rows then approach by 2 margin at most, in any
/// direction.
bool RagSystem::ghosts_outdated(const Box* moved) {
  const double margin = contacts_->skin() / 2 + ghost_path(*contacts_);
  const auto within = [&] {
    Vec3 furthest;
    for (int c = 0; c < 3; ++c) furthest[c] = std::max({0.0, -grown_.lower[c], grown_.upper[c]});
    return norm_squared(furthest) <= margin * margin;
  };
  if (moved && !moved->empty()) {  // a look at all particles only if this bound is not enough
    grown_.lower += moved->lower, grown_.upper += moved->upper;
    if (within()) return false;
  }
  grown_ = {};
  auto then = boxes_.begin();
  for (const Tile& tile : tiles_)
    for (int j = 0; j < tile.ny; ++j, ++then) {
      const Box now = bounding_box(tile, j);
      if (now.empty()) continue;
      for (int c = 0; c < 3; ++c) {
        grown_.lower[c] = std::min(grown_.lower[c], now.lower[c] - then->lower[c]);
        grown_.upper[c] = std::max(grown_.upper[c], now.upper[c] - then->upper[c]);
      }
    }
  return !within();
}

/// What is sent and received, by rank and tile: of each tile the rows between the first and the last that are needed. "Needed" is found by
/// both sides from the same numbers, so what one sends for a pair the other expects.
class RagSystem::NeededRows {
 public:
  explicit NeededRows(const std::vector<int>& owner) : owner_(owner) {}
  /// Rows of an owned tile and of another rank's tile that are near each other.
  void add(int mine, int first, int end, int other, int other_first, int other_end) {
    grow(lists_[owner_[other]].send, mine, first, end);
    grow(lists_[owner_[other]].receive, other, other_first, other_end);
  }
  std::map<int, TileLists> lists() const {
    std::map<int, TileLists> all;
    for (const auto& [rank, rows] : lists_) {
      for (const auto& [tile, range] : rows.send) all[rank].send.push_back(range);
      for (const auto& [tile, range] : rows.receive) all[rank].receive.push_back(range);
    }
    return all;
  }

 private:
  using Rows = std::map<int, TileRows>;
  struct OfRank {
    Rows send, receive;
  };
  static void grow(Rows& rows, int tile, int first, int end) {
    TileRows& range = rows.try_emplace(tile, TileRows{tile, first, end}).first->second;
    range.first = std::min(range.first, first), range.end = std::max(range.end, end);
  }
  const std::vector<int>& owner_;
  std::map<int, OfRank> lists_;
};

void RagSystem::add_ring_sources(NeededRows& needed) const {
  for (const int mine : numbers_)
    for (const auto& [column, row] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int other = neighbour_number(mine, column, row);
      if (other < 0 || owner_[other] < 0 || owner_[other] == rank_of(comm_)) continue;
      const int n = n_rows_of(mine), n_other = n_rows_of(other);
      if (row == 0) needed.add(mine, 0, n, other, 0, n_other);
      if (row > 0) needed.add(mine, n - 1, n, other, 0, 1);
      if (row < 0) needed.add(mine, 0, 1, other, n_other - 1, n_other);
    }
}

void RagSystem::add_near_rows(NeededRows& needed) {
  struct Rows {
    const double* box = nullptr;
    int n = 0;
    std::array<double, 6> all{};  // box of all rows
  };
  const std::vector<double> boxes = all_row_boxes();
  std::vector<Rows> tiles(owner_.size());
  const double* box = boxes.data();
  for (int t = 0; t < n_all_tiles(); ++t) {
    tiles[t] = {box, n_rows_of(t)};
    tiles[t].all.fill(std::numeric_limits<double>::infinity());
    for (int j = 0; j < tiles[t].n; ++j, box += 6)
      for (int c = 0; c < 6; ++c) tiles[t].all[c] = std::min(tiles[t].all[c], box[c]);
  }
  const double reach = contacts_->cutoff() + 2 * ghost_path(*contacts_);
  const auto are_near = [&](const double* a, const double* b) { return box_distance_squared(a, b) <= reach * reach; };
  for (const int mine : numbers_)
    for (int other = 0; other < n_all_tiles(); ++other) {
      if (owner_[other] < 0 || owner_[other] == rank_of(comm_) || !are_near(tiles[mine].all.data(), tiles[other].all.data())) continue;
      for (int i = 0; i < tiles[mine].n; ++i)
        for (int j = 0; j < tiles[other].n; ++j)
          if (are_near(tiles[mine].box + 6 * i, tiles[other].box + 6 * j)) needed.add(mine, i, i + 1, other, j, j + 1);
    }
}

/// For each rank that owns rows near those of this rank: which to send to it, which to receive.
std::map<int, RagSystem::TileLists> RagSystem::exchange_lists() {
  NeededRows needed(owner_);
  add_ring_sources(needed);
  if (contacts_ && size_of(comm_) > 1) add_near_rows(needed);
  return needed.lists();
}

void RagSystem::find_ghosts() { set_ghosts(exchange_lists()); }

void RagSystem::renew_ghosts() {
  std::map<int, TileLists> lists = exchange_lists();
  if (lists != lists_) set_ghosts(std::move(lists));
}

void RagSystem::set_ghosts(std::map<int, TileLists> new_lists) {
  lists_ = std::move(new_lists);
  const std::map<int, TileLists>& lists = lists_;
  ghost_numbers_.clear(), ghosts_.clear(), ghost_pointers_.clear();
  std::vector<TileRows> of_others;
  for (const auto& [other_rank, list] : lists) of_others.insert(of_others.end(), list.receive.begin(), list.receive.end());
  std::sort(of_others.begin(), of_others.end(), [](const TileRows& a, const TileRows& b) { return a.tile < b.tile; });
  for (const auto& [number, first, end] : of_others) {
    ghost_numbers_.push_back(number), ghosts_.push_back(tile_at_birth(number));
    Tile& ghost = ghosts_.back();
    for (int j = 0; j < ghost.ny; ++j)
      if (j < first || j >= end) std::fill_n(&ghost.exists[ghost.index(0, j)], ghost.nx, 0.0);
  }
  if (contacts_) contacts_->renew_lists();
  for (const Tile& tile : ghosts_) ghost_pointers_.push_back(&tile);

  const auto place = [](const std::vector<int>& list, int number) {
    const auto found = std::lower_bound(list.begin(), list.end(), number);
    return found != list.end() && *found == number ? static_cast<int>(found - list.begin()) : -1;
  };
  std::vector<TileHalo::Neighbour> neighbours;
  for (const auto& [other_rank, list] : lists) {
    TileHalo::Neighbour n;
    n.rank = other_rank;
    for (const auto& [number, first, end] : list.send) n.send.push_back({place(numbers_, number), first, end});
    for (const auto& [number, first, end] : list.receive) n.receive.push_back({place(ghost_numbers_, number), first, end});
    neighbours.push_back(std::move(n));
  }
  const bool can_break = std::any_of(rags_.begin(), rags_.end(), [](const Rag& rag) { return rag.breakage; });
  halo_ = std::make_unique<TileHalo>(comm_, std::move(neighbours), tiles_, ghosts_, contacts_ && can_break);
  const auto local = [&](int number) -> const Tile* {
    if (number < 0) return nullptr;
    const int owned = place(numbers_, number);
    return owned >= 0 ? &tiles_[owned] : &ghosts_[place(ghost_numbers_, number)];
  };
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const int n = numbers_[i];
    halo_->add_ring(tiles_[i], local(neighbour_number(n, -1, 0)), local(neighbour_number(n, 1, 0)), local(neighbour_number(n, 0, -1)),
                    local(neighbour_number(n, 0, 1)));
  }
}

void RagSystem::migrate(const OwnerOf& owner_of) {
  std::vector<int> occupied;  // places of tiles with particles; an empty one (corner of a disc) stays where it is
  std::vector<Vec3> centres;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    int n = 0;
    const Vec3 centre = centre_of(tiles_[i], n);
    if (n > 0) occupied.push_back(static_cast<int>(i)), centres.push_back(centre);
  }
  std::vector<int> owner(owner_.size(), -1);
  for (std::size_t i = 0; i < tiles_.size(); ++i) owner[numbers_[i]] = rank_of(comm_);
  if (owner_of) {
    const std::vector<int> ranks = owner_of(centres);
    for (std::size_t c = 0; c < occupied.size(); ++c) owner[numbers_[occupied[c]]] = ranks.at(c);
  } else {
    for (const int number : numbers_) owner[number] = static_cast<int>(static_cast<std::int64_t>(number) * size_of(comm_) / n_all_tiles());
  }
  MPI_Allreduce(MPI_IN_PLACE, owner.data(), static_cast<int>(owner.size()), MPI_INT, MPI_MAX, comm_);
  for (std::size_t t = 0; t < owner.size(); ++t)
    if (owner_[t] >= 0 && (owner[t] < 0 || owner[t] >= size_of(comm_)))
      throw Error(ExitCode::invariant, "rags: tile " + std::to_string(t) + " was given to rank " + std::to_string(owner[t]) +
                                           ", must be 0 to " + std::to_string(size_of(comm_) - 1) + "; is a rag outside the mesh?");
  if (owner != owner_) {
    move_tiles(owner);
    find_ghosts();
  } else {
    renew_ghosts();
  }
  halo_->exchange();
}

std::vector<double> RagSystem::pack(const Tile& tile) const {
  std::vector<double> values(static_cast<std::size_t>(Tile::n_state) * tile.nx * tile.ny);
  pack_state(tile, 0, tile.ny, values.data());
  for (const AlignedDoubles* mask : {&tile.free, &tile.bond_x, &tile.bond_y}) values.insert(values.end(), mask->begin(), mask->end());
  values.push_back(static_cast<double>(tile.particle_state.size()));
  values.insert(values.end(), tile.particle_state.begin(), tile.particle_state.end());
  if (contacts_) {
    const std::vector<double> history = contacts_->pack(tile);
    values.insert(values.end(), history.begin(), history.end());
  }
  return values;
}

Tile RagSystem::unpack(int number, std::span<const double> values) {
  Tile tile = tile_at_birth(number);
  const double* in = unpack_state(tile, 0, tile.ny, values.data());
  for (AlignedDoubles* mask : {&tile.free, &tile.bond_x, &tile.bond_y}) {
    std::copy_n(in, mask->size(), mask->begin());
    in += mask->size();
  }
  const auto n_particle_state = static_cast<std::size_t>(*in++);
  tile.particle_state.assign(in, in + n_particle_state);
  in += n_particle_state;
  if (contacts_) contacts_->unpack(tile, {in, values.data() + values.size()});
  return tile;
}

/// Messages: for each tile its number, the length of its values, the values.
void RagSystem::move_tiles(const std::vector<int>& owner) {
  const int size = size_of(comm_), rank = rank_of(comm_);
  std::vector<std::vector<double>> parcels(size);
  std::vector<std::pair<int, Tile>> kept;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const int to = owner[numbers_[i]];
    if (to == rank) {
      kept.emplace_back(numbers_[i], std::move(tiles_[i]));
      continue;
    }
    const std::vector<double> values = pack(tiles_[i]);
    parcels[to].push_back(numbers_[i]), parcels[to].push_back(static_cast<double>(values.size()));
    parcels[to].insert(parcels[to].end(), values.begin(), values.end());
  }
  RowsByRank<double> out;
  for (const auto& parcel : parcels) {
    out.counts.push_back(static_cast<int>(parcel.size()));
    out.rows.insert(out.rows.end(), parcel.begin(), parcel.end());
  }
  const std::vector<double> in = exchanged(comm_, out).rows;
  for (std::size_t k = 0; k < in.size();) {
    const int number = static_cast<int>(in[k]);
    const std::size_t n = static_cast<std::size_t>(in[k + 1]);
    kept.emplace_back(number, unpack(number, {&in[k + 2], n}));
    k += 2 + n;
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  numbers_.clear(), tiles_.clear();
  for (auto& [number, tile] : kept) numbers_.push_back(number), tiles_.push_back(std::move(tile));
  owner_ = owner;
  set_pointers();
}

}  // namespace snag
