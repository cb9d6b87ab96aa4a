// Chains and sheets under their own weight, vibrating, and carried around: against exact solutions of beams.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "dem/rag_measures.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;
constexpr double pi = std::numbers::pi;

/// A chain of n particles that hardly stretches or shears.
struct Beam {
  int n;
  double EI, length, mass_per_length;
  RagPiece piece() const {
    RagPiece beam = cloth(n, 1);
    Rag& rag = beam.rag;
    rag.radius = length / (n - 1) / 2;
    const double l0 = 2 * rag.radius, A = pi * rag.radius * rag.radius, I = pi * std::pow(rag.radius, 4) / 4;
    rag.mass = mass_per_length * l0, rag.inertia = 1e-3 * rag.mass * l0 * l0;
    const double stiff = 2e4 * EI / (length * length * length) * (n - 1);
    rag.bond[0] = {stiff / A, stiff / A, EI / l0 / I, 0, 0};
    return beam;
  }
};

/// Tip of a clamped inextensible elastica under its own weight q per length: EI theta'' = -q (L - s) cos(theta), theta(0) = theta'(L) = 0,
/// theta downwards. Shooting for the curvature at the clamp with Runge-Kutta.
std::array<double, 2> heavy_elastica(double load) {  // load = q L^3/EI; returns x/L and depth/L of the tip
  std::array<double, 2> tip{};
  const auto end_curvature = [&](double curvature) {
    std::array<double, 4> y{0, curvature, 0, 0};  // theta, theta', x, depth; s from 0 to 1
    const auto rate = [&](double s, const std::array<double, 4>& v) {
      return std::array<double, 4>{v[1], -load * (1 - s) * std::cos(v[0]), std::cos(v[0]), std::sin(v[0])};
    };
    const int steps = 2000;
    const double h = 1.0 / steps;
    for (int k = 0; k < steps; ++k) {
      const double s = k * h;
      const auto moved = [&](const std::array<double, 4>& d, double f) {
        std::array<double, 4> v = y;
        for (int c = 0; c < 4; ++c) v[c] += f * h * d[c];
        return v;
      };
      const auto a = rate(s, y), b = rate(s + h / 2, moved(a, 0.5)), c = rate(s + h / 2, moved(b, 0.5)), d = rate(s + h, moved(c, 1));
      for (int i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    }
    tip = {y[2], y[3]};
    return y[1];
  };
  double low = 0, high = load;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (end_curvature(middle) < 0 ? low : high) = middle;
  }
  return tip;
}

TEST(BondWaves, HeavyElastica) {
  // Requirement: a clamped strip bends under its own weight as the heavy elastica, to 5e-4 of its length with ten particles,
  // nearer with more. Small loads: q L^4/(8 EI).
  EXPECT_NEAR(heavy_elastica(1e-3)[1] / (1e-3 / 8), 1, 1e-4);
  const double EI = 6e-8, L = 0.018, g = 9.81;
  for (const double load : {1.0, 5.0}) {
    const std::array<double, 2> exact = heavy_elastica(load);
    const auto difference = [&](int n) {
      const Beam beam{n, EI, L, load * EI / (L * L * L) / g};
      RagPiece piece = beam.piece();
      piece.rag.bond_damping = 0.3;
      piece.rag.inertia = 0.4 * piece.rag.mass * piece.rag.radius * piece.rag.radius;
      RagSystem rags(MPI_COMM_SELF, DemSettings{}, {piece});
      rags.clamp([](std::int64_t id) { return id == 0; });
      const double rate = 6 * std::sqrt(EI / (beam.mass_per_length * L * L * L * L));
      rags.set_damping_rate(rate);
      EachParticle weight(rags, [&](Tile& tile, int k, std::int64_t id) {
        add_drag(rags, tile, k, rate);
        // The last particle stands for half a spacing of the strip.
        add_to(tile, Tile::fx, k, {0, 0, -g * piece.rag.mass * (id == n - 1 ? 0.5 : 1)});
      });
      rags.advance(60 / rate, &weight);
      const Vec3 tip = position(rags, n - 1) - position(rags, 0);
      return std::hypot(tip.x / L - exact[0], -tip.z / L - exact[1]);
    };
    const double ten = difference(10), nineteen = difference(19);
    EXPECT_LT(ten, 5e-4) << load;  // 2.5e-5 load of it: the beam shears a little
    EXPECT_LT(nineteen, 2e-4) << load;
  }
}

TEST(BondWaves, FirstThreeBendingFrequencies) {
  // Requirement: a free chain vibrates at f_k = (b_k/L)^2 sqrt(EI/m)/(2 pi), b = 4.7300, 7.8532, 10.9956 (free beam), within 2 %: displaced
  // into a mode it swings through half a period to the mirrored shape. A chain of n particles has length n l0.
  constexpr std::array<double, 3> b{4.730041, 7.853205, 10.995608};
  const int n = 60;
  const double EI = 6e-8, m = 5e-4, l0 = 0.018 / (n - 1), L = n * l0;
  for (int k = 0; k < 3; ++k) {
    const double omega = b[k] * b[k] / (L * L) * std::sqrt(EI / m);
    RagPiece piece = Beam{n, EI, 0.018, m}.piece();
    const double sigma = (std::cosh(b[k]) - std::cos(b[k])) / (std::sinh(b[k]) - std::sin(b[k]));
    const auto shape = [&](double s) {
      const double u = b[k] * s;
      return std::cosh(u) + std::cos(u) - sigma * (std::sinh(u) + std::sin(u));
    };
    const double amplitude = 1e-5;
    std::vector<double> w(n);
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) / n;
      w[i] = amplitude * shape(s);
      const double slope = amplitude * (shape(s + 1e-5) - shape(s - 1e-5)) / (2e-5 * L);
      piece.poses.push_back({{l0 * i, 0, w[i]}, {std::cos(slope / 2), 0, -std::sin(slope / 2), 0}});
    }
    RagSystem rags(MPI_COMM_SELF, {.step = {}, .safety = 0.5}, {piece});
    // Frequency from the zero of the projection on the mode: a quarter period.
    const auto projection = [&] {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += w[i] * position(rags, i).z;
      return sum;
    };
    const double dt = 2 * pi / omega / 400;
    double before = projection(), time = 0;
    for (int step = 0; step < 400; ++step) {
      rags.advance(dt);
      const double now = projection();
      if (now <= 0) {
        time = dt * (step + before / (before - now));
        break;
      }
      before = now;
    }
    EXPECT_NEAR(pi / 2 / time / omega, 1, 0.02) << "mode " << k + 1;
  }
}

TEST(BondWaves, TorsionalFrequency) {
  // Requirement: a chain clamped at one end twists at the frequencies of its masses and springs, 2 sqrt(k/i) sin(pi/(4 n + 2)) for n free
  // particles, within 0.1 %.
  const int n = 12;
  RagPiece piece = cloth(n + 1, 1);
  const double k = piece.rag.bond[0].tangential_stiffness * pi * 1e-12 / 2,
               omega = 2 * std::sqrt(k / piece.rag.inertia) * std::sin(pi / (4 * n + 2));
  RagSystem rags(MPI_COMM_SELF, {.step = {}, .safety = 0.3}, {piece});
  rags.clamp([](std::int64_t id) { return id == 0; });
  for (int i = 1; i <= n; ++i) {
    const auto [tile, place] = find(rags, i);
    tile->field(Tile::wx)[place] = 0.01 * omega * std::sin(i * pi / (2 * n + 1));  // twists through zero
  }
  const auto spin = [&] {
    const auto [tile, place] = find(rags, n);
    return tile->field(Tile::wx)[place];
  };
  double before = spin(), time = 0;
  const double dt = 2 * pi / omega / 1000;
  for (int step = 0; step < 1000; ++step) {
    rags.advance(dt);
    const double now = spin();
    if (now <= 0) {
      time = dt * (step + before / (before - now));
      break;
    }
    before = now;
  }
  EXPECT_NEAR(pi / 2 / time / omega, 1, 1e-3);
}

/// Rolled onto a cylinder, slightly sheared.
RagPiece bent_sheet(double radius) {
  RagPiece piece = cloth(20, 10);
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 20; ++column) {
      const double angle = 2e-3 * column / radius;
      piece.poses.push_back({{radius * std::sin(angle), 2.05e-3 * row + 1e-4 * column, radius * (1 - std::cos(angle))},
                             {std::cos(angle / 2), 0, -std::sin(angle / 2), 0}});
    }
  return piece;
}

/// Positions, bond forces and torques of the particles of a system.
struct Loads {
  explicit Loads(RagSystem& rags) {
    for (Tile tile : rags.tiles()) {
      rags.bonds(0).set_forces(false, tile, tile);
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i < tile.nx; ++i)
          for (int c = 0; c < 3; ++c) vectors[c].push_back(tile.vector(fields[c], tile.index(i, j)));
    }
  }
  static constexpr std::array<Tile::Field, 3> fields{Tile::x, Tile::fx, Tile::tx};
  std::array<std::vector<Vec3>, 3> vectors;
};

TEST(BondWaves, CarriedSheetKeepsItsBondForces) {
  // Requirement: a bent sheet carried rigidly about z at 1200 rpm for ten turns has the bond forces and moments it began with, turned with
  // it like its places, to 1e-9 of the largest of each; also where it does not stand as it began, after 0.3 and 10.3 turns. Carried: its
  // particles are clamped and their velocities are those of the rigid motion along chords of the circle.
  const double speed = 1200 * 2 * pi / 60;
  const RagPiece piece = bent_sheet(12e-3);
  RagSystem rags(MPI_COMM_SELF, {.step = {}, .safety = 0.5}, {piece});
  rags.clamp([](std::int64_t) { return true; });
  const int steps = 2000;
  const double dt = 2 * pi / speed / steps, chord = std::sin(speed * dt / 2) / (speed * dt / 2);
  const auto carry = [&] {
    for (Tile& tile : rags.tiles())
      for (int j = -1; j <= tile.ny; ++j)
        for (int i = -1; i <= tile.nx; ++i) {
          const int k = tile.index(i, j);
          const Vec3 x = tile.vector(Tile::x, k);
          // From x over the chord to its place after the step: perpendicular to the mean of both radii.
          const double half = speed * dt / 2;
          tile.set_vector(
              Tile::vx, k,
              speed * chord * Vec3{-(std::cos(half) * x.y + std::sin(half) * x.x), std::cos(half) * x.x - std::sin(half) * x.y, 0});
          tile.set_vector(Tile::wx, k, {0, 0, speed});
        }
  };
  const Loads before(rags);
  int step = 0;
  for (const double turns : {0.3, 10.0, 10.3}) {
    for (; step < std::lround(turns * steps); ++step) carry(), rags.advance(dt);
    const Loads after(rags);
    const double c = std::cos(2 * pi * turns), s = std::sin(2 * pi * turns);
    for (const int f : {0, 1, 2}) {
      double largest = 0, worst = 0;
      for (std::size_t k = 0; k < before.vectors[f].size(); ++k) {
        const Vec3 v = before.vectors[f][k];
        largest = std::max(largest, norm(v));
        worst = std::max(worst, norm(after.vectors[f][k] - Vec3{c * v.x - s * v.y, s * v.x + c * v.y, v.z}));
      }
      EXPECT_GT(largest, f == 2 ? 1e-6 : 1e-3);
      EXPECT_LT(worst, 1e-9 * largest) << turns << " turns, " << std::array{"place", "force", "torque"}[f];
    }
  }
}

}  // namespace
}  // namespace snag
