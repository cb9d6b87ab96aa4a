#include "textile/cantilever.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"
#include "textile/relaxation.hpp"
#include "textile/still_air.hpp"

namespace snag {

namespace {

/// Weight of the strip; the last particle carries its share at the middle of what is left of its cell.
class StripWeight : public TileForce {
 public:
  StripWeight(double weight, int last, double share, double radius) : weight_(weight), last_(last), share_(share), radius_(radius) {}
  void add(std::size_t, Tile& tile, double) override {
    for_particles(tile, [&](int k, int i, int) {
      const bool last = tile.column + i == last_;
      const Vec3 force{0, 0, -weight_ * (last ? share_ : 1)};
      tile.set_vector(Tile::fx, k, tile.vector(Tile::fx, k) + force);
      if (!last) return;
      const Vec3 v = tile.vector(Tile::qx, k);
      const Vec3 arm = (share_ - 1) * radius_ * carried_direction<0>(tile.field(Tile::qw)[k], v.x, v.y, v.z);
      tile.set_vector(Tile::tx, k, tile.vector(Tile::tx, k) + cross(arm, force));
    });
  }

 private:
  double weight_;
  int last_;
  double share_, radius_;
};

constexpr double strip_tolerance = 2e-6;  // m, of the places at rest
constexpr double bracket_share = 2e-4;    // of S_nb: moves the tip by a few thousandths of a millimetre
constexpr std::uintmax_t most_evaluations = 60;
// Of S_nb from Peirce's, either way: further off the strip bends by something else, such as the shear of a bond as long as the overhang,
// and the steps of ever stiffer strips become ever smaller.
constexpr double largest_factor = 1e4;

/// Particles beyond the edge, and what the last stands for.
struct StripCells {
  int n = 0;
  double share = 0;  // phi

  explicit StripCells(const Strip& strip) {
    const double cells = strip.overhang / (2 * strip.radius);
    n = static_cast<int>(std::ceil(cells - 0.5 - 1e-9));
    share = cells - n + 0.5;
    if (n < 1)
      throw Error(ExitCode::usage, "bending test: an overhang of " + number_text(strip.overhang) +
                                       " m is too short for a particle of radius " + number_text(strip.radius) +
                                       " m, it must be longer than the radius; use a smaller --radius");
  }
};

RagPiece strip_piece(const Strip& strip, int n) {
  RagPiece piece;
  Rag& rag = piece.rag;
  rag.name = "strip", rag.n_columns = n + 1, rag.radius = strip.radius;
  rag.mass = strip.mass_per_area * 4 * strip.radius * strip.radius;
  rag.inertia = 0.4 * rag.mass * strip.radius * strip.radius;
  rag.bond = {strip.bond, {}};
  piece.centre = {n * strip.radius, 0, 0};
  return piece;
}

/// The strip, held at the edge, and its weight.
struct HeldStrip {
  HeldStrip(const Strip& strip, const StripCells& cells, const RagPiece& piece, double safety)
      : rags(MPI_COMM_SELF, DemSettings{{}, safety}, {piece}),
        weight(piece.rag.mass * standard_gravity, cells.n, cells.share, strip.radius) {
    rags.clamp([](std::int64_t id) { return id == 0; });
  }
  RagSystem rags;
  StripWeight weight;
};

StripShape shape_of(const RagSystem& rags, const Strip& strip, int n) {
  StripShape shape;
  shape.centres.resize(n + 1);
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int i, int) {
      const int column = tile.column + i;
      shape.centres[column] = tile.vector(Tile::x, k);
      if (column < n) return;
      const Vec3 v = tile.vector(Tile::qx, k);
      shape.tip = shape.centres[n] + (strip.overhang - 2 * strip.radius * n) * carried_direction<0>(tile.field(Tile::qw)[k], v.x, v.y, v.z);
    });
  return shape;
}

/// S_nb of a strip after Peirce (1930): B = w L^3 cos(angle/2)/(8 tan(angle)), S_nb = B/I.
double stiffness_of_peirce(const Strip& strip, double angle) {
  const double I = std::numbers::pi / 4 * std::pow(strip.radius, 4);
  return strip.mass_per_area * standard_gravity * std::pow(strip.overhang, 3) * std::cos(angle / 2) / (8 * std::tan(angle)) / I;
}

}  // namespace

Strip strip_of(const TextileTests& tests, int direction, double radius, const BondProperties& bond) {
  return {radius, tests.bending[direction].overhang, tests.bending[direction].mass_per_area, bond};
}

StripShape hanging_strip(const Strip& strip) {
  const StripCells cells(strip);
  HeldStrip held(strip, cells, relaxing(strip_piece(strip, cells.n)), 0.9);
  relax(held.rags, {.gravity = standard_gravity, .length = strip.overhang, .tolerance = strip_tolerance}, &held.weight);
  return shape_of(held.rags, strip, cells.n);
}

StripShape moved_strip(const Strip& strip, double bond_damping, double duration, double air, double share) {
  const StripCells cells(strip);
  RagPiece piece = strip_piece(strip, cells.n);
  piece.rag.bond_damping = bond_damping;
  HeldStrip held(strip, cells, piece, share);
  held.rags.set_damping_rate(air);
  StillAir slowing(piece.rag, air, &held.weight);
  held.rags.advance(duration, &slowing);
  return shape_of(held.rags, strip, cells.n);
}

double height_above_plane(const Vec3& tip, double angle) { return tip.x * std::sin(angle) + tip.z * std::cos(angle); }

double bending_stiffness_to_plane(Strip strip, double angle) {
  const double guess = stiffness_of_peirce(strip, angle);
  const auto height = [&](double stiffness) {
    if (stiffness > largest_factor * guess || stiffness < guess / largest_factor) throw boost::math::evaluation_error("no root");
    strip.bond.bending_stiffness = stiffness;
    return height_above_plane(hanging_strip(strip).tip, angle);
  };
  const auto close = [](double low, double high) { return high - low < bracket_share * low; };
  std::uintmax_t evaluations = most_evaluations;
  std::pair<double, double> bracket;
  try {
    bracket = boost::math::tools::bracket_and_solve_root(height, guess, 1.5, true, close, evaluations);
  } catch (const boost::math::evaluation_error&) {
    evaluations = most_evaluations;
  }
  if (evaluations >= most_evaluations)
    throw Error(ExitCode::usage,
                "bending test: the tip of a strip of " + number_text(strip.overhang) + " m and " + number_text(strip.mass_per_area) +
                    " kg/m2 does not reach the plane at " + number_text(angle * 180 / std::numbers::pi) +
                    " degrees with any bending stiffness; check overhang, mass_per_area and plane_angle of [bending], or use a "
                    "smaller --radius (" +
                    number_text(strip.radius) + " m now)");
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace snag
