#include "dem/tile_halo.hpp"

#include <algorithm>

namespace snag {

double* pack_state(const Tile& tile, int first, int end, double* out) {
  for (int f = 0; f < Tile::n_state; ++f)
    for (int j = first; j < end; ++j) out = std::copy_n(tile.field(f) + tile.index(0, j), tile.nx, out);
  return out;
}

const double* unpack_state(Tile& tile, int first, int end, const double* in) {
  for (int f = 0; f < Tile::n_state; ++f)
    for (int j = first; j < end; ++j, in += tile.nx) std::copy_n(in, tile.nx, tile.field(f) + tile.index(0, j));
  return in;
}

namespace {

std::size_t message_size(std::span<const Tile> tiles, const std::vector<TileRows>& rows, bool with_bonds) {
  std::size_t n = 0;
  for (const TileRows& r : rows) {
    const int nx = tiles[r.tile].nx, n_rows = r.end - r.first;
    n += static_cast<std::size_t>(Tile::n_state) * nx * n_rows;
    if (with_bonds) n += static_cast<std::size_t>((nx + 1) * n_rows + nx * (n_rows + 1));
  }
  return n;
}

/// f(mark, number) for the rows of bond marks at the particles in rows first .. end of a tile, from the ring on.
template <class AnyTile, class F>
void for_bond_rows(AnyTile& tile, int first, int end, const F& f) {
  for (int j = first; j < end; ++j) f(&tile.bond_x[tile.index(-1, j)], tile.nx + 1);
  for (int j = first - 1; j < end; ++j) f(&tile.bond_y[tile.index(0, j)], tile.nx);
}

/// Copies n particles' states; places advance by `to_step`, `from_step`.
void copy_line(Tile& to, int to_place, int to_step, const Tile& from, int from_place, int from_step, int n) {
  for (int f = 0; f < Tile::n_state; ++f) {
    double* target = to.field(f) + to_place;
    const double* source = from.field(f) + from_place;
    for (int k = 0; k < n; ++k) target[k * to_step] = source[k * from_step];
  }
}

}  // namespace

TileHalo::TileHalo(MPI_Comm comm, std::vector<Neighbour> neighbours, std::span<Tile> owned, std::span<Tile> ghosts, bool with_bonds)
    : comm_(comm),
      neighbours_(std::move(neighbours)),
      owned_(owned),
      ghosts_(ghosts),
      with_bonds_(with_bonds),
      requests_(2 * neighbours_.size()) {
  for (Neighbour& n : neighbours_) {
    n.out.resize(message_size(owned_, n.send, with_bonds_));
    n.in.resize(message_size(ghosts_, n.receive, with_bonds_));
  }
}

void TileHalo::add_ring(Tile& tile, const Tile* left, const Tile* right, const Tile* below, const Tile* above) {
  rings_.push_back({&tile, {left, right, below, above}});
}

void TileHalo::exchange_ghosts() {
  constexpr int tag = 71;
  int r = 0;
  for (Neighbour& n : neighbours_) MPI_Irecv(n.in.data(), static_cast<int>(n.in.size()), MPI_DOUBLE, n.rank, tag, comm_, &requests_[r++]);
  for (Neighbour& n : neighbours_) {
    double* out = n.out.data();
    for (const auto& [t, first, end] : n.send) {
      out = pack_state(owned_[t], first, end, out);
      if (with_bonds_)
        for_bond_rows(owned_[t], first, end, [&out](const double* marks, int count) { out = std::copy_n(marks, count, out); });
    }
    MPI_Isend(n.out.data(), static_cast<int>(n.out.size()), MPI_DOUBLE, n.rank, tag, comm_, &requests_[r++]);
  }
  MPI_Waitall(r, requests_.data(), MPI_STATUSES_IGNORE);
  for (const Neighbour& n : neighbours_) {
    const double* in = n.in.data();
    for (const auto& [t, first, end] : n.receive) {
      in = unpack_state(ghosts_[t], first, end, in);
      if (with_bonds_)
        for_bond_rows(ghosts_[t], first, end, [&in](double* marks, int count) { std::copy_n(in, count, marks), in += count; });
    }
  }
}

void TileHalo::fill_rings() {
  for (const Ring& ring : rings_) {
    Tile& t = *ring.tile;
    const auto& [left, right, below, above] = ring.from;
    if (left) copy_line(t, t.index(-1, 0), t.stride, *left, left->index(left->nx - 1, 0), left->stride, t.ny);
    if (right) copy_line(t, t.index(t.nx, 0), t.stride, *right, right->index(0, 0), right->stride, t.ny);
    if (below) copy_line(t, t.index(0, -1), 1, *below, below->index(0, below->ny - 1), 1, t.nx);
    if (above) copy_line(t, t.index(0, t.ny), 1, *above, above->index(0, 0), 1, t.nx);
  }
}

void TileHalo::exchange() {
  exchange_ghosts();
  fill_rings();
}

}  // namespace snag
