#include "dem/contacts/contact_particles.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dem/bonds/elastic_bond.hpp"

namespace snag {

namespace {

ParticleSurface surface_of(const Tile& tile, int k) {
  const double w = tile.field(Tile::qw)[k];
  const auto [x, y, z] = tile.vector(Tile::qx, k);
  const auto mark = [](double bond) { return static_cast<float>(bond); };
  const Vec3 a = carried_direction<0>(w, x, y, z), b = carried_direction<1>(w, x, y, z);
  return {a, b, {mark(tile.bond_x[k - 1]), mark(tile.bond_x[k])}, {mark(tile.bond_y[k - tile.stride]), mark(tile.bond_y[k])}, cross(a, b)};
}

}  // namespace

bool ContactParticles::holds(std::span<Tile* const> owned, std::span<const Tile* const> ghosts) const {
  if (pieces_.size() != owned.size() + ghosts.size()) return false;
  const auto same = [this](std::size_t i, const Tile* tile, bool mine) {
    const Piece& p = pieces_[i];
    return p.tile == tile && p.owned == mine && p.rag == tile->rag && p.column == tile->column && p.row == tile->row && p.nx == tile->nx &&
           p.ny == tile->ny;
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

  row_of.clear(), is_owned.clear();
  int n = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].first = n;
    n += rows[r].count;
    row_of.insert(row_of.end(), rows[r].count, static_cast<int>(r));
    is_owned.insert(is_owned.end(), rows[r].count, rows[r].owned != nullptr);
  }
  rows_of_.assign(owned.size(), {});
  std::map<const Tile*, std::size_t> number;
  for (std::size_t i = 0; i < owned.size(); ++i) number[owned[i]] = i;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].owned) rows_of_[number[rows[r].owned]].push_back(static_cast<int>(r));
  position.resize(n), surface.resize(n), motion.resize(n), load.resize(n), present.resize(n);
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
  for (Piece& piece : pieces_) piece.n_breaks = piece.tile->n_breaks;
  largest_offset_ = 0, owned_offsets_ = offsets(true);
}

Box ContactParticles::offsets(bool of_owned) const {
  Box all;
  const std::vector<double>* marked[3] = {&marked_x_, &marked_y_, &marked_z_};
  for (const ParticleRow& row : rows) {
    if ((row.owned != nullptr) != of_owned) continue;
    const double* exists = row.tile->exists.data() + row.place;
    for (int c = 0; c < 3; ++c) {
      const double *x = row.tile->field(Tile::x + c) + row.place, *x0 = marked[c]->data() + row.first;
      double low = all.lower[c], high = all.upper[c];
#pragma omp simd reduction(min : low) reduction(max : high)
      for (int i = 0; i < row.count; ++i) {
        const double d = x[i] - x0[i];
        low = exists[i] > 0 && d < low ? d : low, high = exists[i] > 0 && d > high ? d : high;
      }
      all.lower[c] = low, all.upper[c] = high;
    }
  }
  return all;
}

/// A common shift is a rigid motion too.
bool ContactParticles::are_within(double distance, const Box& offsets) {
  if (offsets.empty()) return true;
  const auto& [lower, upper] = offsets;
  largest_offset_ = norm({std::max(-lower.x, upper.x), std::max(-lower.y, upper.y), std::max(-lower.z, upper.z)});
  return 0.5 * norm(upper - lower) <= distance;
}

bool ContactParticles::keeps_distances(double distance, const Box* moved) {
  if (moved && !moved->empty()) {
    owned_offsets_.lower += moved->lower, owned_offsets_.upper += moved->upper;
    Box all = offsets(false);
    all.include(owned_offsets_);
    if (are_within(distance, all)) return true;
  }
  for (int attempt = 0; attempt < 2; ++attempt) {
    Box all = owned_offsets_ = offsets(true);
    all.include(offsets(false));
    if (are_within(distance, all)) return true;
    if (attempt > 0 || !follow_marks()) return false;
  }
  return false;
}

/// Moves the marks by the rigid motion that brings them nearest to the present positions (Kabsch 1976): their distances from each other,
/// by which the pairs were listed, stay. False where that is not worth the effort.
bool ContactParticles::follow_marks() {
  constexpr int fewest = 200;
  if (size() < fewest) return false;
  const Vec3 near_0{marked_x_[0], marked_y_[0], marked_z_[0]}, near_1 = rows[0].tile->vector(Tile::x, rows[0].place);
  Vec3 from, to;  // means, at first from these points
  Mat3 moments{};
  double n = 0;
  for (const ParticleRow& row : rows)
    for (int i = 0; i < row.count; ++i) {
      const int p = row.first + i;
      if (!present[p]) continue;
      const Vec3 a = Vec3{marked_x_[p], marked_y_[p], marked_z_[p]} - near_0, b = row.tile->vector(Tile::x, row.place + i) - near_1;
      from += a, to += b, ++n;
      moments[0] += a.x * b, moments[1] += a.y * b, moments[2] += a.z * b;
    }
  if (n < 3) return false;
  from *= 1 / n, to *= 1 / n;
  Eigen::Matrix3d H;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) H(i, j) = moments[i][j] - n * from[i] * to[j];
  from += near_0, to += near_1;
  if (!H.allFinite()) return false;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d R = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  const Mat3 turn{Vec3{R(0, 0), R(0, 1), R(0, 2)}, Vec3{R(1, 0), R(1, 1), R(1, 2)}, Vec3{R(2, 0), R(2, 1), R(2, 2)}};
  double furthest = 0;
  for (int p = 0; p < size(); ++p) {
    const Vec3 x0{marked_x_[p], marked_y_[p], marked_z_[p]}, x = to + turn * (x0 - from);
    furthest = std::max(furthest, present[p] ? norm_squared(x - x0) : 0.0);
    marked_x_[p] = x.x, marked_y_[p] = x.y, marked_z_[p] = x.z;
  }
  path_ += std::sqrt(furthest);
  return true;
}

bool ContactParticles::bonds_changed() const {
  return std::any_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& piece) { return piece.owned && piece.tile->n_breaks != piece.n_breaks; });
}

bool ContactParticles::bonded(int p, int q) const {
  const ParticleRow &a = rows[row_of[p]], &b = rows[row_of[q]];
  if (a.tile->rag != b.tile->rag) return false;
  const int right = b.column + q - b.first - (a.column + p - a.first), up = b.lattice_row - a.lattice_row;
  const bool along_row = right == 1 && up == 0, between_rows = right == 0 && up == 1;
  if (!along_row && !between_rows) return false;
  // Bonds of ghosts may be those at birth here: read those of the owned end, which holds its bonds to the ring as well.
  const Tile& tile = a.owned ? *a.tile : *b.tile;
  const int k = a.owned ? place(p) : place(q) - (along_row ? 1 : tile.stride);
  return (along_row ? tile.bond_x : tile.bond_y)[k] > 0;
}

bool ContactParticles::near_on_lattice(int p, int q) const {
  constexpr int nearest = 3;  // places: a crease of three bonds turns back on itself, and its particles lie in each other's planes
  const ParticleRow &a = rows[row_of[p]], &b = rows[row_of[q]];
  return a.tile->rag == b.tile->rag && std::abs(b.column + q - b.first - (a.column + p - a.first)) <= nearest &&
         std::abs(b.lattice_row - a.lattice_row) <= nearest;
}

void ContactParticles::gather() {
  for (const ParticleRow& row : rows) {
    if (!row.near) continue;
    const double* field[Tile::wz + 1];
    for (int f = 0; f <= Tile::wz; ++f) field[f] = row.tile->field(f) + row.place;
    for (int i = 0; i < row.count; ++i) {
      position[row.first + i] = {field[Tile::x][i], field[Tile::y][i], field[Tile::z][i]};
      motion[row.first + i] = {field[Tile::vx][i], field[Tile::vy][i], field[Tile::vz][i], 0,
                               field[Tile::wx][i], field[Tile::wy][i], field[Tile::wz][i]};
      surface[row.first + i] = surface_of(*row.tile, row.place + i);
    }
  }
}

void ContactParticles::clear_loads() {
  for (const ParticleRow& row : rows)
    if (row.near || row.at_wall) std::fill_n(load.begin() + row.first, row.count, ParticleLoad{});
}

void ContactParticles::add_loads(std::size_t i) const {
  for (const int r : rows_of_[i]) {
    const ParticleRow& row = rows[r];
    if (!row.near && !row.at_wall) continue;
    double* field[6];
    for (int f = 0; f < 6; ++f) field[f] = row.owned->field(Tile::fx + f) + row.place;
    for (int k = 0; k < row.count; ++k) {
      const ParticleLoad& sum = load[row.first + k];
      field[0][k] += sum.fx, field[1][k] += sum.fy, field[2][k] += sum.fz;
      field[3][k] += sum.tx, field[4][k] += sum.ty, field[5][k] += sum.tz;
    }
  }
}

}  // namespace snag
