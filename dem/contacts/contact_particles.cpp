#include "dem/contacts/contact_particles.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

bool ContactParticles::holds(std::span<Tile* const> owned, std::span<const Tile* const> ghosts) const {
  if (pieces_.size() != owned.size() + ghosts.size()) return false;
  const auto same = [this](std::size_t i, const Tile* tile, bool is_owned) {
    const Piece& p = pieces_[i];
    return p.tile == tile && p.owned == is_owned && p.rag == tile->rag && p.column == tile->column && p.row == tile->row &&
           p.nx == tile->nx && p.ny == tile->ny;
  };
  for (std::size_t i = 0; i < owned.size(); ++i)
    if (!same(i, owned[i], true)) return false;
  for (std::size_t i = 0; i < ghosts.size(); ++i)
    if (!same(owned.size() + i, ghosts[i], false)) return false;
  return true;
}

void ContactParticles::assign(std::span<Tile* const> owned, std::span<const Tile* const> ghosts) {
  pieces_.clear(), rows.clear();
  const auto add = [this](const Tile* tile, Tile* mine) {
    pieces_.push_back({tile, tile->rag, tile->column, tile->row, tile->nx, tile->ny, mine != nullptr, 0});
    const Rag& rag = (*rags_)[tile->rag];
    for (int j = 0; j < tile->ny; ++j)
      rows.push_back({tile, mine, tile->index(0, j), tile->nx, 0, tile->row + j, tile->column,
                      rag.first_particle + std::int64_t(tile->row + j) * rag.n_columns + tile->column});
  };
  for (Tile* tile : owned) add(tile, tile);
  for (const Tile* tile : ghosts) add(tile, nullptr);
  std::sort(rows.begin(), rows.end(), [](const ParticleRow& a, const ParticleRow& b) { return a.id < b.id; });

  row_of.clear();
  int n = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].first = n;
    n += rows[r].count;
    row_of.insert(row_of.end(), rows[r].count, static_cast<int>(r));
  }
  position.resize(n), motion.resize(n), load.resize(n), present.resize(n);
  marked_x_.resize(n), marked_y_.resize(n), marked_z_.resize(n);
}

void ContactParticles::mark_positions() {
  n_not_finite = 0;
  for (const ParticleRow& row : rows) {
    const double* exists = row.tile->exists.data() + row.place;
    for (int i = 0; i < row.count; ++i) {
      const Vec3 x = row.tile->vector(Tile::x, row.place + i);
      const int p = row.first + i;
      const bool finite = std::isfinite(x.x + x.y + x.z);
      present[p] = exists[i] > 0 && finite;
      n_not_finite += exists[i] > 0 && !finite && row.owned;
      position[p] = {x.x, x.y, x.z};
      marked_x_[p] = x.x, marked_y_[p] = x.y, marked_z_[p] = x.z;
    }
  }
  for (Piece& piece : pieces_) piece.bonds = bond_count(piece);
}

bool ContactParticles::moved(double distance) const {
  double largest = 0;
  for (const ParticleRow& row : rows) {
    const double *x = row.tile->field(Tile::x) + row.place, *y = row.tile->field(Tile::y) + row.place,
                 *z = row.tile->field(Tile::z) + row.place;
    const double *x0 = marked_x_.data() + row.first, *y0 = marked_y_.data() + row.first, *z0 = marked_z_.data() + row.first;
    const double* exists = row.tile->exists.data() + row.place;
#pragma omp simd reduction(max : largest)
    for (int i = 0; i < row.count; ++i) {
      const double dx = x[i] - x0[i], dy = y[i] - y0[i], dz = z[i] - z0[i];
      const double square = exists[i] > 0 ? dx * dx + dy * dy + dz * dz : 0.0;
      largest = square > largest ? square : largest;
    }
  }
  return largest > distance * distance;
}

double ContactParticles::bond_count(const Piece& piece) const {
  if (!piece.owned || !(*rags_)[piece.rag].breakage) return 0;
  double n = 0;
  const double *bx = piece.tile->bond_x.data(), *by = piece.tile->bond_y.data();
  const int size = static_cast<int>(std::min(piece.tile->bond_x.size(), piece.tile->bond_y.size()));
#pragma omp simd reduction(+ : n)
  for (int k = 0; k < size; ++k) n += bx[k] + by[k];
  return n;
}

bool ContactParticles::bonds_changed() const {
  return std::any_of(pieces_.begin(), pieces_.end(), [this](const Piece& piece) { return bond_count(piece) != piece.bonds; });
}

bool ContactParticles::bonded(int p, int q) const {
  const ParticleRow &a = rows[row_of[p]], &b = rows[row_of[q]];
  if (a.tile->rag != b.tile->rag) return false;
  const int right = b.column + q - b.first - (a.column + p - a.first), up = b.lattice_row - a.lattice_row;
  const bool along_row = right == 1 && up == 0, between_rows = right == 0 && up == 1;
  if (!along_row && !between_rows) return false;
  // Masks of ghosts may be out of date: read those of the owned end, which holds its bonds to the ring as well.
  const Tile& tile = a.owned ? *a.tile : *b.tile;
  const int k = a.owned ? place(p) : place(q) - (along_row ? 1 : tile.stride);
  return (along_row ? tile.bond_x : tile.bond_y)[k] > 0;
}

void ContactParticles::gather_positions() {
  for (const ParticleRow& row : rows) {
    if (!row.near) continue;
    const double *x = row.tile->field(Tile::x) + row.place, *y = row.tile->field(Tile::y) + row.place,
                 *z = row.tile->field(Tile::z) + row.place;
    for (int i = 0; i < row.count; ++i) position[row.first + i] = {x[i], y[i], z[i]};
  }
}

void ContactParticles::gather_motion() {
  for (const ParticleRow& row : rows) {
    if (!row.near) continue;
    const double* field[6];
    for (int f = 0; f < 3; ++f)
      field[f] = row.tile->field(Tile::vx + f) + row.place, field[3 + f] = row.tile->field(Tile::wx + f) + row.place;
    for (int i = 0; i < row.count; ++i) {
      motion[row.first + i] = {field[0][i], field[1][i], field[2][i], 0, field[3][i], field[4][i], field[5][i]};
      load[row.first + i] = {};
    }
  }
}

void ContactParticles::scatter_loads() const {
  for (const ParticleRow& row : rows) {
    if (!row.near || !row.owned) continue;
    double* field[6];
    for (int f = 0; f < 6; ++f) field[f] = row.owned->field(Tile::fx + f) + row.place;
    for (int i = 0; i < row.count; ++i) {
      const ParticleLoad& sum = load[row.first + i];
      field[0][i] += sum.fx, field[1][i] += sum.fy, field[2][i] += sum.fz;
      field[3][i] += sum.tx, field[4][i] += sum.ty, field[5][i] += sum.tz;
    }
  }
}

}  // namespace snag
