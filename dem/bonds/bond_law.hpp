#pragma once
// Laws of the bonds between the particles of a piece: one law a file of dem/bonds/laws/, chosen by name for each piece (`bond_law`).
//
// A law makes PieceBonds of the properties of a piece. These evaluate all bonds of a tile in one call: which law it is, is decided once a
// tile, never once a bond (dem/bonds/tile_bonds.hpp). A law whose stiffnesses are constants only says what they are (linear_bonds).
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"
#include "dem/bonds/elastic_bond.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

/// The elastic part of one bond of a tile.
struct MeasuredBond {
  int first = 0, second = 0;                   // places of its ends
  double tension = 0, length = 0, energy = 0;  // N, m, J
};

/// The bonds of one piece.
class PieceBonds {
 public:
  virtual ~PieceBonds() = default;
  /// Sets fx .. tz (N, N m) of the tile's particles to what their bonds give; the ring must be up to date. Bonds across the tile's edge are
  /// evaluated too, from the same numbers as the neighbour does. With `breakage` bonds that do not hold get the mark 0 and no force from
  /// this call on; returns how many broke of those that the tile owns (end 1 in the tile), else 0. Particles of the ring get arbitrary
  /// values. `next` is fetched from memory meanwhile: the tile that is due after this one, or the same.
  virtual int set_forces(bool breakage, Tile& tile, const Tile& next) const = 0;
  /// The whole bonds whose first end is in the tile, or with `from_ring` also those from the ring; row by row, of a place the bond along
  /// the row first.
  virtual std::vector<MeasuredBond> measured(const Tile& tile, bool from_ring) const = 0;
  /// Coefficients of the bonds of a direction, 0 along the row, 1 between rows, with the largest stiffnesses that the law reaches: the
  /// stable step follows from them (dem/bonds/stable_step.hpp).
  virtual const BondCoefficients& coefficients(int direction) const = 0;
};

/// What a law is, for the manual.
struct BondLawDescription {
  std::string name, equation, source, valid_for;
};

/// Force and torques of one bond known from outside this code: an exact limit or a published number. End 1 is at the origin, end 2 at the
/// bond's length along x; then end 2 is moved by `shift`, and the ends are turned by `turn` (axis times angle).
struct BondReference {
  std::string what, source;
  Rag rag;                          // a row of two particles
  Vec3 shift = {};                  // m
  std::array<Vec3, 2> turn = {};    // rad
  Vec3 force = {};                  // on end 2, N
  std::array<Vec3, 2> torque = {};  // on both ends, N m
  double tolerance = 0;             // of |force| and of the larger |torque|, 1
};

class BondLaw {
 public:
  virtual ~BondLaw() = default;
  virtual BondLawDescription description() const = 0;
  /// Table [rag.NAME] of the case file, and likewise of [[disc]] and [[fibre]].
  virtual std::vector<Parameter> parameters() { return {}; }
  virtual std::unique_ptr<PieceBonds> bonds(const Rag& rag) const = 0;
  virtual std::vector<BondReference> reference_cases() const = 0;
};

Registry<BondLaw>& bond_laws();
inline constexpr const char* default_bond_law = "parallel_bond";
/// Tables of the laws, for the manual.
std::vector<Section> bond_law_sections();

/// The bonds of a rag under its law, or under the default one if it has none.
std::unique_ptr<PieceBonds> bonds_of(const Rag& rag);
/// Bonds that are linear in all four strains.
std::unique_ptr<PieceBonds> linear_bonds(const std::array<BondCoefficients, 2>& coefficients);

}  // namespace snag
