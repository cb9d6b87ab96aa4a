#include "dem/rag_measures.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dem/bonds/bond_law.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/quantile.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

/// Terms of one rag's sums on this rank; summed over ranks without regard to their order.
struct Terms {
  std::vector<Vec3> position, momentum, angular_momentum;
  std::vector<double> kinetic, bond;
  std::array<std::vector<double>, 6> moment;  // xx yy zz xy yz zx about the origin of the tile sums
  double tension = -infinity, strain = -infinity;
  std::int64_t tight_bond = 0;  // the bond under this tension: twice the id of its first end, 1 more between rows
  Vec3 tight_place;             // its middle, m
  Vec3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity}, first, last;
  double has_first = 0, has_last = 0;

  /// Of bonds under the same tension the one with the lowest number: the same on any number of ranks.
  void add_tension(double of_bond, std::int64_t number, const Vec3& place) {
    if (!(of_bond > tension || (of_bond == tension && number < tight_bond))) return;
    tension = of_bond, tight_bond = number, tight_place = place;
  }
};

void add_particles(const Tile& tile, const Rag& rag, Terms& terms) {
  for_particles(tile, [&](int k, int i, int j) {
    const Vec3 x = tile.vector(Tile::x, k), p = rag.mass * tile.vector(Tile::vx, k), w = tile.vector(Tile::wx, k);
    terms.position.push_back(x), terms.momentum.push_back(p);
    terms.angular_momentum.push_back(cross(x, p) + rag.inertia * w);
    terms.kinetic.push_back(0.5 * dot(p, p) / rag.mass + 0.5 * rag.inertia * dot(w, w));
    for (int c = 0; c < 3; ++c) {
      terms.lower[c] = std::min(terms.lower[c], x[c]), terms.upper[c] = std::max(terms.upper[c], x[c]);
      terms.moment[c].push_back(x[c] * x[c]), terms.moment[3 + c].push_back(x[c] * x[(c + 1) % 3]);
    }
    if (tile.row + j != rag.n_rows / 2) return;
    if (tile.column + i == 0) terms.first = x, terms.has_first = 1;
    if (tile.column + i == rag.n_columns - 1) terms.last = x, terms.has_last = 1;
  });
}

double elongation(const std::array<double, 6>& moment, const Vec3& centre) {
  Eigen::Matrix3d m;
  const double xy = moment[3] - centre.x * centre.y, yz = moment[4] - centre.y * centre.z, zx = moment[5] - centre.z * centre.x;
  m << moment[0] - centre.x * centre.x, xy, zx, xy, moment[1] - centre.y * centre.y, yz, zx, yz, moment[2] - centre.z * centre.z;
  const Eigen::Vector3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>().computeDirect(m, Eigen::EigenvaluesOnly).eigenvalues();
  const double noise = 1e-13 * (moment[0] + moment[1] + moment[2]);  // round-off of what was subtracted
  if (axes(2) <= noise) return 1;
  return axes(1) > noise ? std::sqrt(axes(2) / axes(1)) : infinity;
}

RagState state_of(MPI_Comm comm, const Rag& rag, const Terms& t) {
  RagState s;
  s.n_particles = sum(comm, static_cast<std::int64_t>(t.position.size()));
  if (s.n_particles == 0) return s;
  const double n = static_cast<double>(s.n_particles);
  s.centre = sum(comm, std::span<const Vec3>(t.position)) / n;
  s.momentum = sum(comm, std::span<const Vec3>(t.momentum));
  s.velocity = s.momentum / (n * rag.mass);
  s.angular_momentum = sum(comm, std::span<const Vec3>(t.angular_momentum));
  s.kinetic_energy = sum(comm, std::span<const double>(t.kinetic)), s.bond_energy = sum(comm, std::span<const double>(t.bond));
  std::array<double, 6> moment;
  for (int c = 0; c < 6; ++c) moment[c] = sum(comm, std::span<const double>(t.moment[c])) / n;
  s.elongation_ratio = elongation(moment, s.centre);
  for (int c = 0; c < 3; ++c) s.lower[c] = minimum(comm, t.lower[c]), s.upper[c] = maximum(comm, t.upper[c]);
  const bool has_bonds = maximum(comm, t.strain) > -infinity;
  if (has_bonds) {
    s.max_bond_tension = maximum(comm, t.tension), s.max_bond_strain = maximum(comm, t.strain);
    const double mine = t.tension == s.max_bond_tension ? static_cast<double>(t.tight_bond) : infinity;
    const double lowest = minimum(comm, mine);
    const bool is_mine = mine < infinity && lowest == mine;
    s.max_bond_tension_place = sum(comm, std::span<const Vec3>(&t.tight_place, is_mine ? 1 : 0));
  }
  const bool has_ends = sum(comm, t.has_first) == 1 && sum(comm, t.has_last) == 1;
  const Vec3 ends = sum(comm, std::span<const Vec3>(std::array<Vec3, 2>{t.last, -t.first}));
  s.end_to_end = has_ends ? norm(ends) : std::numeric_limits<double>::quiet_NaN();
  return s;
}

}  // namespace

std::vector<RagState> rag_states(const RagSystem& rags) {
  std::vector<Terms> terms(rags.rags().size());
  for (const Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[tile.rag];
    Terms& t = terms[tile.rag];
    add_particles(tile, rag, t);
    for (const MeasuredBond& bond : rags.bonds(tile.rag).measured(tile, false)) {
      const auto [a, b] = std::pair{bond.first, bond.second};
      t.bond.push_back(bond.energy);
      t.strain = std::max(t.strain, bond.length / (2 * rag.radius) - 1);
      const std::int64_t first = particle_id(rag, tile, a % tile.stride - 1, a / tile.stride - 1);
      t.add_tension(bond.tension, 2 * first + (b != a + 1), 0.5 * (tile.vector(Tile::x, a) + tile.vector(Tile::x, b)));
    }
  }
  std::vector<RagState> states;
  for (std::size_t r = 0; r < terms.size(); ++r) states.push_back(state_of(rags.comm(), rags.rags()[r], terms[r]));
  return states;
}

Vec3 force_on_clamped(const RagSystem& rags, int rag) {
  std::vector<Vec3> forces;
  for (const Tile& tile : rags.tiles())
    if (tile.rag == rag)
      for_particles(tile, [&](int k, int, int) {
        if (tile.free[k] < 0.5) forces.push_back(tile.vector(Tile::fx, k));
      });
  return sum(rags.comm(), std::span<const Vec3>(forces));
}

double bond_strain_quantile(const RagSystem& rags, int rag, double p) {
  const double length = 2 * rags.rags()[static_cast<std::size_t>(rag)].radius;
  std::vector<double> strain;
  for (const Tile& tile : rags.tiles())
    if (tile.rag == rag)
      for_whole_bonds(tile, false,
                      [&](int a, int b) { strain.push_back(norm(tile.vector(Tile::x, b) - tile.vector(Tile::x, a)) / length - 1); });
  return quantile(rags.comm(), std::move(strain), p);
}

namespace {

/// What one particle sends to rank 0, as doubles.
enum Column { c_id, c_rag, c_state, c_tension = c_state + 10, c_strain, c_bond_x, c_bond_y, n_sheet_columns };

std::vector<double> sheet_rows(const RagSystem& rags, const std::vector<const std::vector<Vec3>*>& more) {
  std::vector<double> rows;
  std::size_t n = 0;
  for (const Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[tile.rag];
    std::vector<double> tension(tile.exists.size(), -infinity), strain(tile.exists.size(), -infinity);
    for (const MeasuredBond& bond : rags.bonds(tile.rag).measured(tile, true))
      for (const int k : {bond.first, bond.second})
        tension[k] = std::max(tension[k], bond.tension), strain[k] = std::max(strain[k], bond.length / (2 * rag.radius) - 1);
    for_particles(tile, [&](int k, int i, int j) {
      rows.push_back(static_cast<double>(particle_id(rag, tile, i, j))), rows.push_back(tile.rag);
      for (int f = Tile::x; f <= Tile::qz; ++f) rows.push_back(tile.field(f)[k]);
      const bool bonded = tension[k] > -infinity;
      rows.push_back(bonded ? tension[k] : 0), rows.push_back(bonded ? strain[k] : 0);
      rows.push_back(tile.bond_x[k]), rows.push_back(tile.bond_y[k]);
      for (const std::vector<Vec3>* vectors : more)
        for (int c = 0; c < 3; ++c) rows.push_back((*vectors)[n][c]);
      ++n;
    });
  }
  return rows;
}

/// Two triangles for each lattice cell with four whole bonds; `rows` in order of ids.
void add_triangles(const std::vector<Rag>& rags, const std::vector<const double*>& rows, RagSheet& sheet) {
  const auto place = [&](std::int64_t id) {
    return static_cast<int>(std::lower_bound(sheet.id.begin(), sheet.id.end(), id) - sheet.id.begin());
  };
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k][c_bond_x] < 0.5 || rows[k][c_bond_y] < 0.5) continue;
    const int a = static_cast<int>(k), b = a + 1, c = place(sheet.id[k] + rags[sheet.rag[k]].n_columns);
    if (rows[b][c_bond_y] < 0.5 || rows[c][c_bond_x] < 0.5) continue;
    sheet.triangles.push_back({a, b, c + 1}), sheet.triangles.push_back({a, c + 1, c});
  }
}

}  // namespace

RagSheet gather_sheet(const RagSystem& rags, const std::vector<const std::vector<Vec3>*>& more) {
  const std::vector<double> all = gathered_on_first(rags.comm(), sheet_rows(rags, more));
  std::vector<const double*> rows;
  for (std::size_t k = 0; k < all.size(); k += n_sheet_columns + 3 * more.size()) rows.push_back(&all[k]);
  std::sort(rows.begin(), rows.end(), [](const double* a, const double* b) { return a[c_id] < b[c_id]; });
  RagSheet sheet;
  sheet.more.resize(more.size());
  for (const double* row : rows) {
    for (std::size_t m = 0; m < more.size(); ++m) {
      const double* v = row + n_sheet_columns + 3 * m;
      sheet.more[m].push_back({v[0], v[1], v[2]});
    }
    sheet.id.push_back(static_cast<std::int64_t>(row[c_id])), sheet.rag.push_back(static_cast<int>(row[c_rag]));
    const double* s = row + c_state;
    sheet.position.push_back({s[Tile::x], s[Tile::y], s[Tile::z]}), sheet.velocity.push_back({s[Tile::vx], s[Tile::vy], s[Tile::vz]});
    sheet.orientation.push_back({s[Tile::qw], s[Tile::qx], s[Tile::qy], s[Tile::qz]});
    sheet.tension.push_back(row[c_tension]), sheet.strain.push_back(row[c_strain]);
  }
  add_triangles(rags.rags(), rows, sheet);
  return sheet;
}

}  // namespace snag
