#pragma once
// The drape test: a round piece of cloth laid upon a smaller round table, its middle held by a pin, seen from above (ISO 9073-9 with a
// smaller disc; Jensen 2018, sections 2.2.3 and 3.3.3).
//
// The cloth begins flat on the table, with a slow motion of waves along its normal that a seed draws: each seed is another laying of the
// cloth, and falls into other folds.
#include <array>
#include <vector>

#include "base/vec3.hpp"
#include "dem/rag_measures.hpp"
#include "observe/outline.hpp"
#include "textile/relaxation.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

struct DrapeTest {
  double sample_diameter = 0.210, disc_diameter = 0.100;  // m
  double mass_per_area = 0;                               // kg/m2
};

/// Cloth of the drape test: lattice, properties of its bonds, contacts.
struct DrapeCloth {
  double radius = 0;                     // r_p, m
  std::array<BondProperties, 2> bond{};  // lengthwise, crosswise
  double bond_damping = 0.5, rotation_friction = 0.001;
  double shear_modulus = 1e6;
  double restitution = 0.01, static_friction = 0.5, rolling_friction = 0.01;
};

DrapeTest drape_test(const TextileTests& tests);
DrapeCloth drape_cloth(const TextileTests& tests, double radius, const std::array<BondProperties, 2>& bond);

struct Drape {
  RagSheet sheet;       // at rest; the table's top is at z = 0, its axis the z axis
  RelaxationCost cost;  // n_peaks = 0: of a dynamic run
};

/// The cloth at rest by dynamic relaxation, from flat or from where `start` has it (then without waves). On this rank alone. Throws
/// Error(diverged) if it does not rest.
Drape relaxed_drape(const DrapeTest& test, const DrapeCloth& cloth, int seed, const RagSheet* start = nullptr);
/// The same by the motion of the cloth with its own dashpots and friction, for `duration` s, in air that slows it by `air` (1/s).
Drape moved_drape(const DrapeTest& test, const DrapeCloth& cloth, int seed, double duration, double air, const RagSheet* start = nullptr);

/// The cloth from above, to its rim (observe/cloth_to_rim.hpp). `pixel`: m.
Coverage seen_from_above(const RagSheet& sheet, double radius, double pixel);
/// Outline of that, from pixels of a thousandth of the published sample.
Outline outline_from_above(const RagSheet& sheet, double radius);

}  // namespace snag
