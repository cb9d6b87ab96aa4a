// Every bond law of the registry is held to the same rules; a new file in dem/bonds/laws/ is tested without a line here.
#include <gtest/gtest.h>

#include <random>

#include "dem/bonds/bond_law.hpp"
#include "dem/bonds/stable_step.hpp"
#include "dem/rag_system.hpp"
#include "dem/templates/lattice.hpp"
#include "tests/sources.hpp"

namespace snag {
namespace {

struct Pose {
  Vec3 x;
  Quaternion q;
  Vec3 v, w;
};
using Ends = std::array<Pose, 2>;

/// What the bond of two particles does, through the tile that holds them.
struct BondOfTwo {
  double tension = 0, energy = 0;  // N, J
  Vec3 force, torque[2];           // on end 2, N; on both ends, N m
  double sum = 0;                  // of the forces on both ends, N
};

class Pair {
 public:
  Pair(const BondLaw& law, Rag rag, int direction) : direction_(direction) {
    rag.name = "pair", rag.n_columns = direction == 0 ? 2 : 1, rag.n_rows = 3 - rag.n_columns;
    bonds_ = law.bonds(rag);
    RagPiece piece;
    piece.rag = rag;
    tile_ = make_tile(piece, 0, tile_grid(rag.n_columns, rag.n_rows), 0);
  }
  const BondCoefficients& coefficients() const { return bonds_->coefficients(direction_); }
  BondOfTwo at(const Ends& ends) {
    const int place[2] = {tile_.index(0, 0), direction_ == 0 ? tile_.index(1, 0) : tile_.index(0, 1)};
    for (const int e : {0, 1}) {
      const auto& [x, q, v, w] = ends[static_cast<std::size_t>(e)];
      tile_.set_vector(Tile::x, place[e], x), tile_.set_vector(Tile::vx, place[e], v), tile_.set_vector(Tile::wx, place[e], w);
      tile_.field(Tile::qw)[place[e]] = q.w, tile_.set_vector(Tile::qx, place[e], {q.x, q.y, q.z});
    }
    bonds_->set_forces(false, tile_, tile_);
    const MeasuredBond measured = bonds_->measured(tile_, false).at(0);
    const Vec3 on_1 = tile_.vector(Tile::fx, place[0]), on_2 = tile_.vector(Tile::fx, place[1]);
    return {
        measured.tension, measured.energy, on_2, {tile_.vector(Tile::tx, place[0]), tile_.vector(Tile::tx, place[1])}, norm(on_1 + on_2)};
  }

 private:
  int direction_;
  std::unique_ptr<PieceBonds> bonds_;
  Tile tile_;
};

Rag cloth() {
  Rag rag;
  rag.radius = 1e-3, rag.mass = 2.25e-6, rag.inertia = 0.4 * rag.mass * 1e-6;
  rag.bond[0] = {7.65e8, 5e6, 3.86e7, 0, 0}, rag.bond[1] = {4.23e8, 5e6, 1.03e7, 0, 0};
  return rag;
}

struct Random {
  std::mt19937_64 engine{7};
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine); }
  Vec3 vector(double scale) { return scale * Vec3{(*this)(), (*this)(), (*this)()}; }
};

/// Two ends far from rest: stretched by tens of per cent, bent and twisted by up to about a radian, turned at will.
Ends random_ends(Random& random, int direction) {
  const double l0 = 2e-3;
  const Pose one{random.vector(0.1), rotation_by(random.vector(3)), random.vector(1), random.vector(500)};
  const Vec3 along = rotate(one.q, direction == 0 ? Vec3{l0, 0, 0} : Vec3{0, l0, 0});
  return {one,
          {one.x + along + random.vector(0.3 * l0), product(rotation_by(random.vector(0.8)), one.q), random.vector(1), random.vector(500)}};
}

template <class Work>
void for_each_law(const Work& work) {
  ASSERT_FALSE(bond_laws().names().empty());
  for (const std::string& name : bond_laws().names()) {
    SCOPED_TRACE(name);
    const auto law = bond_laws().make(name, "test");
    for (const int direction : {0, 1}) work(*law, direction);
  }
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
  EXPECT_LE(norm(a - b), tolerance) << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x << ", " << b.y << ", " << b.z
                                    << ")";
}

// Requirement: no law is dropped by the linker: the registry holds what its folder holds, and the default one is there.
TEST(BondLaws, RegistryHoldsTheFolder) {
  EXPECT_EQ(bond_laws().names().size(), n_sources("dem/bonds/laws"));
  EXPECT_EQ(bond_laws().make(default_bond_law, "test")->description().name, default_bond_law);
}

// Requirement: a law has a description, its numbers have ranges that hold the defaults, and it gives the exact limits and published numbers
// that it names, and names at least one.
TEST(BondLaws, ReferenceCases) {
  for_each_law([](BondLaw& law, int direction) {
    const BondLawDescription description = law.description();
    EXPECT_FALSE(description.equation.empty() || description.source.empty() || description.valid_for.empty());
    for (const Parameter& parameter : law.parameters())
      if (const auto* number = std::get_if<double*>(&parameter.target)) {
        EXPECT_TRUE(**number >= parameter.minimum && **number <= parameter.maximum) << parameter.key;
      }
    EXPECT_FALSE(law.reference_cases().empty());
    if (direction == 1) return;  // the cases are along the row
    for (const BondReference& reference : law.reference_cases()) {
      Rag rag = reference.rag;
      rag.bond_damping = rag.rotation_friction = 0;
      const BondOfTwo bond = Pair(law, rag, 0)
                                 .at({Pose{{}, rotation_by(reference.turn[0]), {}, {}},
                                      Pose{Vec3{2 * rag.radius, 0, 0} + reference.shift, rotation_by(reference.turn[1]), {}, {}}});
      const double couple = std::max(norm(reference.torque[0]), norm(reference.torque[1]));
      const double force = std::max(norm(reference.force), couple / rag.radius),
                   torque = std::max(couple, norm(reference.force) * rag.radius);
      expect_near(bond.force, reference.force, reference.tolerance * force, reference.what);
      for (const std::size_t e : {0, 1}) expect_near(bond.torque[e], reference.torque[e], reference.tolerance * torque, reference.what);
    }
  });
}

// Requirement: without damping the force on end 2 and the torques are minus the derivative of the energy.
TEST(BondLaws, AreDerivativesOfTheirEnergy) {
  for_each_law([](BondLaw& law, int direction) {
    Rag rag = cloth();
    rag.bond_damping = rag.rotation_friction = 0;
    Pair pair(law, rag, direction);
    Random random;
    for (int sample = 0; sample < 20; ++sample) {
      const Ends ends = random_ends(random, direction);
      const BondOfTwo bond = pair.at(ends);
      const auto slope = [&](std::size_t e, const Vec3& shift, const Vec3& turn, double size) {
        const auto energy = [&](double by) {
          Ends moved = ends;
          moved[e].x += by * shift, moved[e].q = product(rotation_by(by * turn), ends[e].q);
          return pair.at(moved).energy;
        };
        return (energy(size) - energy(-size)) / (2 * size);
      };
      for (int c = 0; c < 3; ++c) {
        Vec3 axis;
        axis[c] = 1;
        EXPECT_NEAR(-slope(1, axis, {}, 1e-8), bond.force[c], 1e-6 * norm(bond.force));
        for (const std::size_t e : {0, 1}) EXPECT_NEAR(-slope(e, {}, axis, 1e-5), bond.torque[e][c], 1e-6 * norm(bond.torque[e]));
      }
    }
  });
}

// Requirement: with damping too, linear and angular momentum of the pair are kept to round-off, a rigid motion turns forces and torques
// with it, and damping only takes energy.
TEST(BondLaws, KeepMomentumAndAreObjective) {
  for_each_law([](BondLaw& law, int direction) {
    Rag elastic = cloth();
    elastic.bond_damping = elastic.rotation_friction = 0;
    Pair pair(law, cloth(), direction), undamped(law, elastic, direction);
    Random random;
    for (int sample = 0; sample < 20; ++sample) {
      const Ends ends = random_ends(random, direction);
      const BondOfTwo bond = pair.at(ends);
      const double force = norm(bond.force), moment = norm(bond.torque[0]) + norm(bond.torque[1]) + force * 2e-3;
      EXPECT_EQ(bond.sum, 0);
      EXPECT_LT(norm(bond.torque[0] + bond.torque[1] + cross(ends[1].x - ends[0].x, bond.force)), 1e-14 * moment);

      const Quaternion Q = rotation_by(random.vector(2));
      const Vec3 shift = random.vector(0.05), spin = random.vector(300);
      Ends moved = ends;
      for (Pose& p : moved)
        p = {rotate(Q, p.x) + shift, product(Q, p.q), rotate(Q, p.v) + cross(spin, rotate(Q, p.x) + shift), rotate(Q, p.w) + spin};
      const BondOfTwo turned = pair.at(moved);
      const double scale = pair.coefficients().normal * pair.coefficients().length;
      EXPECT_LT(norm(turned.force - rotate(Q, bond.force)), 1e-12 * scale);
      for (const int e : {0, 1}) EXPECT_LT(norm(turned.torque[e] - rotate(Q, bond.torque[e])), 1e-12 * moment);

      const BondOfTwo rest = undamped.at(ends);
      EXPECT_LT(dot(bond.force - rest.force, ends[1].v - ends[0].v) + dot(bond.torque[0] - rest.torque[0], ends[0].w) +
                    dot(bond.torque[1] - rest.torque[1], ends[1].w),
                0);
    }
  });
}

// Requirement: the coefficients by which the stable step is chosen are no softer than the bond anywhere: no strain has a steeper force.
TEST(BondLaws, CoefficientsAreTheStiffest) {
  for_each_law([](BondLaw& law, int direction) {
    Rag rag = cloth();
    rag.bond_damping = rag.rotation_friction = 0;
    Pair pair(law, rag, direction);
    const Vec3 along = direction == 0 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const double l0 = 2e-3, step = 1e-6 * l0;
    double steepest = 0;
    for (int i = -30; i < 60; ++i) {
      const double strain = 0.01 * i;
      const auto tension = [&](double l) { return pair.at({Pose{}, Pose{l * along, {}, {}, {}}}).tension; };
      const double slope = (tension((1 + strain) * l0 + step) - tension((1 + strain) * l0 - step)) / (2 * step);
      EXPECT_LE(slope, pair.coefficients().normal * (1 + 1e-6)) << strain;
      steepest = std::max(steepest, slope);
    }
    EXPECT_NEAR(steepest / pair.coefficients().normal, 1, 0.01);
  });
}

}  // namespace
}  // namespace snag
