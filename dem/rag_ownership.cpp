// Which rank owns which tile, who needs whose tiles, and moving tiles between ranks.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_system.hpp"
#include "dem/tile_halo.hpp"
#include "dem/tile_particles.hpp"
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

/// Lower corners and negative upper corners of all tiles, by number.
std::vector<double> RagSystem::all_boxes() {
  std::vector<double> boxes(6 * owner_.size(), std::numeric_limits<double>::infinity());
  boxes_.clear();
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Box box = bounding_box(tiles_[i]);
    boxes_.push_back(box);
    const std::array<double, 6> corners{box.lower.x, box.lower.y, box.lower.z, -box.upper.x, -box.upper.y, -box.upper.z};
    std::copy(corners.begin(), corners.end(), &boxes[6 * numbers_[i]]);
  }
  MPI_Allreduce(MPI_IN_PLACE, boxes.data(), static_cast<int>(boxes.size()), MPI_DOUBLE, MPI_MIN, comm_);
  return boxes;
}

bool RagSystem::near(int a, int b, const std::vector<double>& boxes) const {
  for (const auto& [column, row] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
    if (neighbour_number(a, column, row) == b) return true;
  if (!contacts_) return false;
  const double reach = contacts_->cutoff();
  return box_distance_squared(&boxes[6 * a], &boxes[6 * b]) <= reach * reach;
}

/// True once a tile has left its box by more than what the ghosts were chosen for.
bool RagSystem::ghosts_outdated() const {
  const double margin = contacts_->skin() / 2;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Box now = bounding_box(tiles_[i]), &then = boxes_[i];
    for (int c = 0; c < 3; ++c)
      if (now.lower[c] < then.lower[c] - margin || now.upper[c] > then.upper[c] + margin) return true;
  }
  return false;
}

/// For each rank that owns tiles near those of this rank: which tiles to send to it, which to receive, by ascending number. "Near" is
/// mutual: what one side sends for a pair, the other expects.
std::map<int, RagSystem::TileLists> RagSystem::exchange_lists() {
  const int rank = rank_of(comm_);
  const std::vector<double> boxes = contacts_ && size_of(comm_) > 1 ? all_boxes() : std::vector<double>();
  std::map<int, TileLists> lists;
  for (const int mine : numbers_)
    for (int other = 0; other < n_all_tiles(); ++other)
      if (owner_[other] >= 0 && owner_[other] != rank && near(mine, other, boxes)) {
        lists[owner_[other]].send.push_back(mine);
        lists[owner_[other]].receive.push_back(other);
      }
  for (auto& [other_rank, list] : lists)
    for (std::vector<int>* numbers : {&list.send, &list.receive}) {
      std::sort(numbers->begin(), numbers->end());
      numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
    }
  return lists;
}

void RagSystem::find_ghosts() {
  const std::map<int, TileLists> lists = exchange_lists();
  ghost_numbers_.clear(), ghosts_.clear(), ghost_pointers_.clear();
  for (const auto& [other_rank, list] : lists) ghost_numbers_.insert(ghost_numbers_.end(), list.receive.begin(), list.receive.end());
  std::sort(ghost_numbers_.begin(), ghost_numbers_.end());
  for (const int number : ghost_numbers_) ghosts_.push_back(tile_at_birth(number));
  for (const Tile& tile : ghosts_) ghost_pointers_.push_back(&tile);

  const auto place = [](const std::vector<int>& list, int number) {
    const auto found = std::lower_bound(list.begin(), list.end(), number);
    return found != list.end() && *found == number ? static_cast<int>(found - list.begin()) : -1;
  };
  std::vector<TileHalo::Neighbour> neighbours;
  for (const auto& [other_rank, list] : lists) {
    TileHalo::Neighbour n;
    n.rank = other_rank;
    for (const int number : list.send) n.send.push_back(place(numbers_, number));
    for (const int number : list.receive) n.receive.push_back(place(ghost_numbers_, number));
    neighbours.push_back(std::move(n));
  }
  halo_ = std::make_unique<TileHalo>(comm_, std::move(neighbours), tiles_, ghosts_);
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
  if (owner != owner_) move_tiles(owner);
  find_ghosts();
  halo_->exchange();
}

std::vector<double> RagSystem::pack(const Tile& tile) const {
  std::vector<double> values(static_cast<std::size_t>(Tile::n_state) * tile.nx * tile.ny);
  pack_state(tile, values.data());
  for (const AlignedDoubles* mask : {&tile.free, &tile.bond_x, &tile.bond_y}) values.insert(values.end(), mask->begin(), mask->end());
  values.push_back(static_cast<double>(tile.memory.size()));
  values.insert(values.end(), tile.memory.begin(), tile.memory.end());
  if (contacts_) {
    const std::vector<double> history = contacts_->pack(tile);
    values.insert(values.end(), history.begin(), history.end());
  }
  return values;
}

Tile RagSystem::unpack(int number, std::span<const double> values) {
  Tile tile = tile_at_birth(number);
  const double* in = unpack_state(tile, values.data());
  for (AlignedDoubles* mask : {&tile.free, &tile.bond_x, &tile.bond_y}) {
    std::copy_n(in, mask->size(), mask->begin());
    in += mask->size();
  }
  const auto n_memory = static_cast<std::size_t>(*in++);
  tile.memory.assign(in, in + n_memory);
  in += n_memory;
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
  Letters<double> out;
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
