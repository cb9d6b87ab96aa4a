// Counting: every tile has one owner, every particle is there and has a position, every bond is whole or counted as broken, and both tiles
// of a bond agree on it.
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/words.hpp"
#include "dem/rag_system.hpp"

namespace snag {

namespace {

enum Count { particles, whole, broken, seen_by_first, seen_by_second, n_counts };

/// Adds a tile's counts. Bonds across its right and upper edge belong to it; those across its left and lower edge to the neighbour.
void add_counts(const Tile& tile, std::int64_t* count) {
  for (int j = 0; j < tile.ny; ++j)
    for (int i = 0; i < tile.nx; ++i) {
      const int k = tile.index(i, j);
      count[particles] += tile.exists[k] > 0.5;
      count[whole] += (tile.bond_x[k] > 0.5) + (tile.bond_y[k] > 0.5);
    }
  for (int j = 0; j < tile.ny; ++j) {
    count[seen_by_first] += tile.bond_x[tile.index(tile.nx - 1, j)] > 0.5;
    count[seen_by_second] += tile.bond_x[tile.index(-1, j)] > 0.5;
  }
  for (int i = 0; i < tile.nx; ++i) {
    count[seen_by_first] += tile.bond_y[tile.index(i, tile.ny - 1)] > 0.5;
    count[seen_by_second] += tile.bond_y[tile.index(i, -1)] > 0.5;
  }
}

constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

/// Lowest id of a particle whose position or orientation is no number.
std::int64_t first_not_finite(const Tile& tile, const Rag& rag) {
  double sum = 0;  // any bad number makes it bad: one pass that vectorises
  for (int f = Tile::x; f < Tile::n_state; ++f) {
    const double* value = tile.field(f);
    for (int j = 0; j < tile.ny; ++j)
      for (int k = tile.index(0, j); k < tile.index(tile.nx, j); ++k) sum += 0 * value[k];
  }
  if (sum == 0) return none;
  for (int j = 0; j < tile.ny; ++j)
    for (int i = 0; i < tile.nx; ++i)
      for (int f = Tile::x; f < Tile::n_state; ++f)
        if (!std::isfinite(tile.field(f)[tile.index(i, j)])) return particle_id(rag, tile, i, j);
  return none;
}

std::string ids(std::int64_t first, std::int64_t last) { return std::to_string(first) + " to " + std::to_string(last); }

}  // namespace

std::vector<BondCount> RagSystem::check() const {
  const std::size_t n_rags = rags_.size();
  std::vector<std::int64_t> count(n_counts * n_rags + owner_.size() + 1, 0);
  std::int64_t bad = none;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    add_counts(tiles_[i], &count[n_counts * tiles_[i].rag]);
    count[n_counts * n_rags + numbers_[i]] += 1;
    bad = std::min(bad, first_not_finite(tiles_[i], rags_[tiles_[i].rag]));
  }
  for (std::size_t r = 0; r < n_rags; ++r) count[n_counts * r + broken] = broken_[r];
  count.back() = bad != none;
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT64_T, MPI_SUM, comm_);

  if (count.back() > 0) {
    MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT64_T, MPI_MIN, comm_);
    throw Error(ExitCode::diverged, "rags: particle " + std::to_string(bad) +
                                        " has a position or velocity that is not a number at t = " + number_text(time_) +
                                        " s; use a shorter [time] step or a softer force, or [dem] step or safety where contacts throw it");
  }
  for (std::size_t t = 0; t < owner_.size(); ++t) {
    if (count[n_counts * n_rags + t] == (owner_[t] >= 0 ? 1 : 0)) continue;
    const Tile tile = tile_at_birth(static_cast<int>(t));
    const Rag& rag = rags_[tile.rag];
    throw Error(ExitCode::invariant, "rags: " + std::to_string(count[n_counts * n_rags + t]) + " ranks own the particles " +
                                         ids(particle_id(rag, tile, 0, 0), particle_id(rag, tile, tile.nx - 1, tile.ny - 1)) + " of " +
                                         rag.name + ", must be 1; particles were lost in a transfer between ranks");
  }
  std::vector<BondCount> bonds(n_rags);
  for (std::size_t r = 0; r < n_rags; ++r) {
    if (presence_[r] == Presence::waiting) continue;
    if (presence_[r] == Presence::removed) {
      bonds[r] = {rags_[r].n_bonds - count[n_counts * r + broken], count[n_counts * r + broken]};
      continue;
    }
    const Rag& rag = rags_[r];
    const std::int64_t* c = &count[n_counts * r];
    bonds[r] = {c[whole], c[broken]};
    const auto where = [&] {
      return "rags: " + rag.name + " (particles " + ids(rag.first_particle, rag.first_particle + rag.n_columns * rag.n_rows - 1) + ")";
    };
    if (c[particles] != rag.n_particles)
      throw Error(ExitCode::invariant,
                  where() + " has " + std::to_string(c[particles]) + " particles, must be " + std::to_string(rag.n_particles));
    if (c[whole] + c[broken] != rag.n_bonds)
      throw Error(ExitCode::invariant, where() + " has " + std::to_string(c[whole]) + " whole and " + std::to_string(c[broken]) +
                                           " broken bonds, together must be " + std::to_string(rag.n_bonds));
    if (c[seen_by_first] != c[seen_by_second])
      throw Error(ExitCode::invariant, where() + ": " + std::to_string(c[seen_by_first]) +
                                           " whole bonds between tiles seen by their first tile, " + std::to_string(c[seen_by_second]) +
                                           " by their second, must be equal");
  }
  return bonds;
}

RagCounts RagSystem::count() const {
  std::vector<std::int64_t> count(n_counts * rags_.size(), 0);
  for (const Tile& tile : tiles_) add_counts(tile, &count[n_counts * tile.rag]);
  for (std::size_t r = 0; r < rags_.size(); ++r) count[n_counts * r + broken] = broken_[r];
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT64_T, MPI_SUM, comm_);
  RagCounts counts;
  for (std::size_t r = 0; r < rags_.size(); ++r) {
    const bool is_gone = presence_[r] == Presence::removed;  // it left complete
    const std::int64_t n_broken = count[n_counts * r + broken];
    counts.particles.push_back(is_gone ? rags_[r].n_particles : count[n_counts * r + particles]);
    counts.bonds.push_back({is_gone ? rags_[r].n_bonds - n_broken : count[n_counts * r + whole], n_broken});
  }
  return counts;
}

}  // namespace snag
