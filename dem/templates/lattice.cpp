#include "dem/templates/lattice.hpp"

#include <Eigen/Geometry>

#include "base/error.hpp"

namespace snag {

Vec3 rotate(const Quaternion& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z}, t = 2 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

Quaternion product(const Quaternion& p, const Quaternion& q) {
  const Vec3 u{p.x, p.y, p.z}, v{q.x, q.y, q.z}, w = p.w * v + q.w * u + cross(u, v);
  return {p.w * q.w - dot(u, v), w.x, w.y, w.z};
}

Quaternion rotation_by(const Vec3& angle) {
  const double a = norm(angle);
  const Vec3 v = a > 0 ? std::sin(a / 2) / a * angle : 0.5 * angle;
  return {std::cos(a / 2), v.x, v.y, v.z};
}

Quaternion rotation_to(const Vec3& lengthwise, const Vec3& crosswise) {
  const Vec3 a = unit(lengthwise);
  const Vec3 across = crosswise - dot(crosswise, a) * a;
  if (norm(a) == 0 || norm(across) <= 1e-9 * norm(crosswise) || norm(crosswise) == 0)
    throw Error(ExitCode::usage, "pose of a rag: lengthwise and crosswise are parallel or zero; give two directions that span the cloth");
  const Vec3 b = unit(across), c = cross(a, b);
  Eigen::Matrix3d m;
  m << a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z;
  const Eigen::Quaterniond q = Eigen::Quaterniond(m).normalized();
  return {q.w(), q.x(), q.y(), q.z()};
}

ParticlePose RagPiece::pose(int column, int row) const {
  if (!poses.empty() && column >= 0 && row >= 0 && column < rag.n_columns && row < rag.n_rows) {
    const ParticlePose& placed = poses[static_cast<std::size_t>(row) * rag.n_columns + column];
    return {centre + placed.position, placed.orientation};
  }
  const auto [x, y] = rag.place(column, row);
  return {centre + rotate(orientation, {x, y, 0}), orientation};
}

namespace {

/// Starts of equal parts of n, as many as make the cost of the padded parts least.
std::vector<int> equal_parts(int n, int most, bool padded) {
  const auto size = [n](int parts, int p) {
    return static_cast<int>(static_cast<std::int64_t>(n) * (p + 1) / parts - static_cast<std::int64_t>(n) * p / parts);
  };
  const int fewest = (n + most - 1) / most;
  int best = fewest, least = 0;
  for (int parts = fewest; parts <= fewest + 2 && parts <= n; ++parts) {
    int cost = 0;
    for (int p = 0; p < parts; ++p) cost += padded ? (size(parts, p) + 2 + 7) / 8 * 8 : size(parts, p) + 1;
    if (parts == fewest || cost < least) best = parts, least = cost;
  }
  std::vector<int> start{0};
  for (int p = 0; p < best; ++p) start.push_back(start.back() + size(best, p));
  return start;
}

}  // namespace

TileGrid tile_grid(int n_columns, int n_rows) {
  TileGrid grid;
  grid.column_start = equal_parts(n_columns, max_tile_columns, true), grid.row_start = equal_parts(n_rows, max_tile_rows, false);
  grid.columns = static_cast<int>(grid.column_start.size()) - 1, grid.rows = static_cast<int>(grid.row_start.size()) - 1;
  return grid;
}

Tile make_tile(const RagPiece& piece, int rag_index, const TileGrid& grid, int t) {
  const int tc = t % grid.columns, tr = t / grid.columns;
  Tile tile;
  tile.rag = rag_index, tile.column = grid.column_start[tc], tile.row = grid.row_start[tr];
  tile.allocate(grid.column_start[tc + 1] - tile.column, grid.row_start[tr + 1] - tile.row);
  for (int j = -1; j <= tile.ny; ++j) {
    for (int i = -1; i <= tile.nx; ++i) {
      const int k = tile.index(i, j), column = tile.column + i, row = tile.row + j;
      const ParticlePose pose = piece.pose(column, row);
      tile.set_vector(Tile::x, k, pose.position);
      tile.field(Tile::qw)[k] = pose.orientation.w;
      tile.set_vector(Tile::qx, k, {pose.orientation.x, pose.orientation.y, pose.orientation.z});
      if (!piece.exists(column, row)) continue;
      const bool column_inside = i >= 0 && i < tile.nx, row_inside = j >= 0 && j < tile.ny;
      tile.exists[k] = 1, tile.free[k] = column_inside && row_inside ? 1 : 0;
      tile.set_vector(Tile::vx, k, piece.velocity + cross(piece.spin, pose.position - piece.centre));
      tile.set_vector(Tile::wx, k, piece.spin);
      // Only bonds with an end in the tile: those between two particles of the ring are the neighbours' business.
      if (row_inside && i < tile.nx && piece.rag.has_bond(column, row, 0)) tile.bond_x[k] = 1;
      if (column_inside && j < tile.ny && piece.rag.has_bond(column, row, 1)) tile.bond_y[k] = 1;
    }
  }
  return tile;
}

std::int64_t count_particles(const RagPiece& piece) {
  std::int64_t n = 0;
  for (int row = 0; row < piece.rag.n_rows; ++row)
    for (int column = 0; column < piece.rag.n_columns; ++column) n += piece.exists(column, row);
  return n;
}

std::int64_t count_bonds(const RagPiece& piece) {
  std::int64_t n = 0;
  for (int row = 0; row < piece.rag.n_rows; ++row)
    for (int column = 0; column < piece.rag.n_columns; ++column)
      n += piece.rag.has_bond(column, row, 0) + piece.rag.has_bond(column, row, 1);
  return n;
}

}  // namespace snag
