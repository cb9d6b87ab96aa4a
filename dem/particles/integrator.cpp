#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=512")
#endif
#include "dem/particles/integrator.hpp"

namespace snag {

namespace {

/// cos(sqrt u) and sin(sqrt u)/sqrt u by Taylor series: to the last digit for a half angle sqrt u up to 1.
inline double cosine(double u) {
  double c = 1.0 / 20922789888000;
  c = c * u - 1.0 / 87178291200;
  c = c * u + 1.0 / 479001600;
  c = c * u - 1.0 / 3628800;
  c = c * u + 1.0 / 40320;
  c = c * u - 1.0 / 720;
  c = c * u + 1.0 / 24;
  c = c * u - 1.0 / 2;
  return c * u + 1.0;
}
inline double sine_ratio(double u) {
  double s = 1.0 / 355687428096000;
  s = s * u - 1.0 / 1307674368000;
  s = s * u + 1.0 / 6227020800;
  s = s * u - 1.0 / 39916800;
  s = s * u + 1.0 / 362880;
  s = s * u - 1.0 / 5040;
  s = s * u + 1.0 / 120;
  s = s * u - 1.0 / 6;
  return s * u + 1.0;
}

/// The fields of a tile's rows 0 .. ny - 1, which are contiguous, rings of the columns included.
struct Rows {
  explicit Rows(Tile& tile) : n(tile.ny * tile.stride / 8 * 8) {
    for (int f = 0; f < Tile::n_fields; ++f) field[f] = tile.field(f) + tile.stride;
    free = tile.free.data() + tile.stride, exists = tile.exists.data() + tile.stride;
  }
  int n;
  double* field[Tile::n_fields];
  const double *free, *exists;
};

[[gnu::always_inline]] inline void drift_one(double* const* f, int k, double dt) {
  f[Tile::x][k] += dt * f[Tile::vx][k], f[Tile::y][k] += dt * f[Tile::vy][k], f[Tile::z][k] += dt * f[Tile::vz][k];
  const Vec3 half = (0.5 * dt) * Vec3{f[Tile::wx][k], f[Tile::wy][k], f[Tile::wz][k]};
  const double u = dot(half, half), c = cosine(u);
  const Vec3 p = sine_ratio(u) * half;
  const double w = f[Tile::qw][k];
  const Vec3 v{f[Tile::qx][k], f[Tile::qy][k], f[Tile::qz][k]};
  const double turned_w = c * w - dot(p, v);
  const Vec3 turned = c * v + w * p + cross(p, v);
  // One Newton step of 1/sqrt keeps the length at 1 to round-off.
  const double scale = 1.5 - 0.5 * (turned_w * turned_w + dot(turned, turned));
  f[Tile::qw][k] = scale * turned_w, f[Tile::qx][k] = scale * turned.x, f[Tile::qy][k] = scale * turned.y,
  f[Tile::qz][k] = scale * turned.z;
}

}  // namespace

void drift(Tile& tile, double dt) {
  const Rows rows(tile);
  double* f[Tile::n_state];
  std::copy_n(rows.field, Tile::n_state, f);
#pragma omp simd
  for (int k = 0; k < rows.n; ++k) drift_one(f, k, dt);
}

Box kick_and_drift(Tile& tile, const Inertia& inertia, double dt, double dt_drift) {
  const Rows rows(tile);
  double* f[Tile::n_fields];
  std::copy_n(rows.field, Tile::n_fields, f);
  const double *free = rows.free, *exists = rows.exists;
  const double per_mass = dt / inertia.mass, per_moment = dt / inertia.moment;
  const Vec3 fall = dt * inertia.gravity;
  Box all;
  double low_x = all.lower.x, low_y = low_x, low_z = low_x, high_x = all.upper.x, high_y = high_x, high_z = high_x;
#pragma omp simd reduction(min : low_x, low_y, low_z) reduction(max : high_x, high_y, high_z)
  for (int k = 0; k < rows.n; ++k) {
    const double moves = free[k] > 0.5 ? 1 : 0, turns = free[k] > 0 ? 1 : 0;
    f[Tile::vx][k] += moves * (per_mass * f[Tile::fx][k] + fall.x);
    f[Tile::vy][k] += moves * (per_mass * f[Tile::fy][k] + fall.y);
    f[Tile::vz][k] += moves * (per_mass * f[Tile::fz][k] + fall.z);
    f[Tile::wx][k] += turns * per_moment * f[Tile::tx][k];
    f[Tile::wy][k] += turns * per_moment * f[Tile::ty][k];
    f[Tile::wz][k] += turns * per_moment * f[Tile::tz][k];
    const bool counts = exists[k] > 0.5;  // also held ones; the columns of the ring have velocities that particles had
    const Vec3 v{f[Tile::vx][k], f[Tile::vy][k], f[Tile::vz][k]};
    low_x = std::min(low_x, counts ? v.x : low_x), high_x = std::max(high_x, counts ? v.x : high_x);
    low_y = std::min(low_y, counts ? v.y : low_y), high_y = std::max(high_y, counts ? v.y : high_y);
    low_z = std::min(low_z, counts ? v.z : low_z), high_z = std::max(high_z, counts ? v.z : high_z);
    drift_one(f, k, dt_drift);
  }
  all.lower = {low_x, low_y, low_z}, all.upper = {high_x, high_y, high_z};
  return all;
}

Box bounding_box(const Tile& tile, int j) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Box box;
  const double* exists = tile.exists.data();
  const int first = tile.index(0, j), end = first + tile.nx;
  for (int c = 0; c < 3; ++c) {
    const double* x = tile.field(Tile::x + c);
    double low = far, high = -far;
#pragma omp simd reduction(min : low) reduction(max : high)
    for (int k = first; k < end; ++k) {
      const bool here = exists[k] > 0.5;
      low = std::min(low, here ? x[k] : far), high = std::max(high, here ? x[k] : -far);
    }
    box.lower[c] = low, box.upper[c] = high;
  }
  return box;
}

}  // namespace snag
