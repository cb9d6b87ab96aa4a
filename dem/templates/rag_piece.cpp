// From settings to a piece: lattice, mass, hydrodynamic volume and bonds of its particles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/words.hpp"
#include "dem/templates/folded.hpp"
#include "dem/templates/passport.hpp"
#include "dem/templates/pose_file.hpp"
#include "dem/templates/rag_settings.hpp"

namespace snag {

double most_particles() {
  constexpr double by_counts = 2e8, bytes_per_particle = 2e3;
  return std::min(by_counts, physical_memory() / bytes_per_particle);
}

namespace {

using Shape = RagSettings::Shape;
using Properties = RagSettings::Properties;
constexpr double pi = std::numbers::pi;

/// Jensen (2018) Tables 3.3 (lengthwise) and 3.4 (crosswise); r_p in m, stiffness in N/m3, strength in Pa.
const Passport& published_passport() {
  static const Passport passport{"published bond properties",
                                 {{1.0e-3, {{{7.65e8, 5.0e6, 3.86e7, 5.47e5, 0}, {4.23e8, 5.0e6, 1.03e7, 2.23e5, 0}}}},
                                  {1.5e-3, {{{3.40e8, 1.0e6, 7.86e6, 3.65e5, 0}, {1.88e8, 1.0e6, 1.59e6, 1.49e5, 0}}}},
                                  {2.0e-3, {{{1.91e8, 5.0e5, 3.15e6, 2.74e5, 0}, {1.06e8, 5.0e5, 4.05e5, 1.12e5, 0}}}}}};
  return passport;
}

void check_size(const RagSettings& s, const std::string& where) {
  double n = 1;
  if (s.shape == Shape::rag) n = s.length * s.width / (4 * s.radius * s.radius);
  if (s.shape == Shape::disc) n = s.diameter * s.diameter / (4 * s.radius * s.radius);
  if (s.shape == Shape::fibre) n = s.n_points > 0 ? s.n_points : s.length / (2 * s.radius);
  if (n > most_particles())
    throw Error(ExitCode::usage, where + ": is a lattice of " + number_text(n) + " particles of radius " + number_text(s.radius) +
                                     " m, must be at most " + number_text(most_particles()) + " in the " +
                                     number_text(physical_memory() / 1e9) + " GB of this machine; give a larger radius or a smaller piece");
}

int whole_particles(double length, double radius) { return std::max(1, static_cast<int>(std::lround(length / (2 * radius)))); }

void set_lattice(const RagSettings& s, RagPiece& piece) {
  Rag& rag = piece.rag;
  rag.radius = s.radius;
  if (s.shape == Shape::rag) rag.n_columns = whole_particles(s.length, s.radius), rag.n_rows = whole_particles(s.width, s.radius);
  if (s.shape == Shape::disc) {
    rag.n_columns = rag.n_rows = whole_particles(s.diameter, s.radius);
    piece.rag.mask_radius = s.diameter / 2;
  }
  if (s.shape == Shape::fibre) {
    if (s.n_points > 0) rag.radius = s.length / (2 * s.n_points);
    rag.n_columns = s.n_points > 0 ? s.n_points : whole_particles(s.length, s.radius);
  }
  if (s.shape == Shape::particle) rag.radius = s.diameter / 2;
}

/// A cut without effect is refused.
void set_cuts(const RagSettings& s, const std::string& where, Rag& rag) {
  for (std::size_t c = 0; c < s.cuts.size(); ++c) {
    const std::string which = where + " cut " + std::to_string(c + 1) + ": ";
    for (const auto& [key, end] : {std::pair{"from", &s.cuts[c].from}, {"to", &s.cuts[c].to}})
      if (end->size() != 2)
        throw Error(ExitCode::usage, which + key + " has " + counted(end->size(), "number") +
                                         ", must have 2: lengthwise and crosswise from the centre of the cloth; correct it");
    const Cut cut{{s.cuts[c].from[0], s.cuts[c].from[1]}, {s.cuts[c].to[0], s.cuts[c].to[1]}};
    const auto crosses_a_bond = [&] {
      for (int row = 0; row < rag.n_rows; ++row)
        for (int column = 0; column < rag.n_columns; ++column)
          for (const int direction : {0, 1})
            if (rag.has_bond(column, row, direction) && crosses(cut, rag, column, row, direction)) return true;
      return false;
    };
    if (!crosses_a_bond())
      throw Error(ExitCode::usage, which + "from (" + number_text(cut.from[0]) + ", " + number_text(cut.from[1]) + ") to (" +
                                       number_text(cut.to[0]) + ", " + number_text(cut.to[1]) +
                                       ") m it crosses no bond of the cloth, whose lattice spacing is " + number_text(2 * rag.radius) +
                                       " m; correct the ends, which count from the centre of the cloth, or remove the cut");
    rag.cuts.push_back(cut);
  }
}

/// Thicker than a particle, neighbours on the lattice would touch each other.
void set_thickness(const RagSettings& s, const std::string& where, Rag& rag) {
  const double largest = 2 * rag.radius;
  for (const auto& [key, given, target] : {std::tuple{"contact_thickness", s.contact_thickness, &rag.contact_thickness},
                                           std::tuple{"layer_thickness", s.layer_thickness, &rag.layer_thickness}}) {
    if (given && *given > largest * (1 + 1e-12))
      throw Error(ExitCode::usage, where + ": " + key + " = " + number_text(*given) + " m, must be at most the lattice spacing, 2 r_p = " +
                                       number_text(largest) + " m; give a smaller one, or a larger radius");
    *target = given ? std::min(*given, largest) : 0;
  }
}

void set_mass(const RagSettings& s, Rag& rag) {
  const double d = 2 * rag.radius, sphere = pi / 6 * d * d * d;
  rag.hydrodynamic_diameter = d;
  switch (s.shape) {
    case Shape::particle:
      rag.hydrodynamic_volume = sphere, rag.mass = s.density * sphere;
      break;
    case Shape::fibre:
      if (s.diameter > 0) rag.hydrodynamic_diameter = s.diameter;
      rag.hydrodynamic_volume = pi / 4 * rag.hydrodynamic_diameter * rag.hydrodynamic_diameter * d;
      rag.mass = s.density * rag.hydrodynamic_volume;
      break;
    case Shape::rag:
    case Shape::disc:
      rag.hydrodynamic_volume = s.thickness * d * d;
      rag.mass = s.has_published_density() ? 538 * (1e-3 / rag.radius) * sphere : s.mass_per_area * d * d;
      break;
  }
  rag.inertia = 0.4 * rag.mass * rag.radius * rag.radius;
}

/// Bonds that give a chain the stretching and bending stiffness of a round beam: S A = E A_f/l0, S_nb I = E I_f/l0; S_t from the shear
/// modulus E/(2 (1 + nu)) in the same way (torsion then goes with the sphere's J, (2 r_p/d)^2 times that of the beam).
BondProperties beam_bond(const RagSettings& s, const Rag& rag) {
  const double l0 = 2 * rag.radius, ratio = rag.hydrodynamic_diameter / l0;
  BondProperties bond;
  bond.normal_stiffness = s.youngs_modulus * ratio * ratio / l0;
  bond.bending_stiffness = s.youngs_modulus * std::pow(ratio, 4) / l0;
  bond.tangential_stiffness = bond.normal_stiffness / (2 * (1 + s.poisson_ratio));
  return bond;
}

/// Of contacts: spheres harder than the beam that they make up would only shorten the step.
double shear_modulus(const RagSettings& s) {
  constexpr double published = 1e6;  // Pa, Jensen (2018), Table 3.1
  if (s.shear_modulus) return *s.shear_modulus;
  return s.properties == Properties::beam && s.passport.empty() ? std::min(published, s.youngs_modulus / (2 * (1 + s.poisson_ratio)))
                                                                : published;
}

void set_bonds_of(const Passport& passport, const std::string& where, Rag& rag) {
  try {
    rag.bond = {passport.bond(rag.radius, 0), passport.bond(rag.radius, 1)};
  } catch (const Error& error) {
    throw Error(error.code, where + ": " + error.what());
  }
}

void set_bonds(const RagSettings& s, const std::string& where, const std::filesystem::path& folder, Rag& rag) {
  rag.bond_damping = s.bond_damping, rag.rotation_friction = s.rotation_friction, rag.contact_radius_ratio = s.contact_radius_ratio;
  rag.breakage = s.breakage;
  rag.shear_modulus = shear_modulus(s), rag.poisson_ratio = s.poisson_ratio;
  if (s.shape == Shape::particle) return;
  rag.bond_law = s.law ? s.law : bond_laws().make(s.bond_law, where + " bond_law");
  if (!s.passport.empty()) {
    if (s.properties == Properties::custom)
      throw Error(ExitCode::usage,
                  where + ": passport = \"" + s.passport + "\" and properties = \"custom\" both set the bonds; keep one of them");
    set_bonds_of(read_passport(folder / s.passport), where, rag);
  } else if (s.properties == Properties::beam) {
    rag.bond = {beam_bond(s, rag), {}};
  } else if (s.properties == Properties::custom) {
    rag.bond = {s.along, s.across};
    const bool needs_across = s.shape != Shape::fibre;
    if (s.along.normal_stiffness <= 0 || (needs_across && s.across.normal_stiffness <= 0))
      throw Error(ExitCode::usage, where +
                                       ": properties = \"custom\" without a positive normal stiffness; give normal_stiffness_lengthwise" +
                                       std::string(needs_across ? " and normal_stiffness_crosswise" : ""));
  } else {
    set_bonds_of(published_passport(), where, rag);
  }
}

/// Keys that belong to another kind of pose are refused: they would be without effect.
void check_plan(const RagSettings& s, const std::string& where) {
  const PosePlan& plan = s.plan;
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, where + ": " + what); };
  if (!s.pose_file.empty() && plan.kind != PosePlan::Kind::flat)
    refuse("pose = \"" + plan.kind.word() + "\" and pose_file = \"" + s.pose_file + "\" both place the particles; keep one of them");
  if (plan.kind != PosePlan::Kind::folded && plan.folds_lengthwise + plan.folds_crosswise > 0)
    refuse("folds_lengthwise and folds_crosswise need pose = \"folded\", it is \"" + plan.kind.word() + "\"; set pose, or remove them");
  if (!plan.crumpled() && plan.confine_radius > 0)
    refuse("confine_radius needs pose = \"confined\" or \"hopper\", it is \"" + plan.kind.word() + "\"; set pose, or remove it");
  if (plan.kind != PosePlan::Kind::confined && plan.confine_length > 0)
    refuse("confine_length needs pose = \"confined\", it is \"" + plan.kind.word() + "\"; set pose, or remove it");
  if (!plan.crumpled() && plan.seed != PosePlan{}.seed)
    refuse("seed needs pose = \"confined\" or \"hopper\", it is \"" + plan.kind.word() + "\"; set pose, or remove it");
  if (plan.kind != PosePlan::Kind::hopper && plan.hopper_angle != PosePlan{}.hopper_angle)
    refuse("hopper_angle needs pose = \"hopper\", it is \"" + plan.kind.word() + "\"; set pose, or remove it");
  if (plan.crumpled() && plan.confine_radius <= 0)
    refuse("pose = \"" + plan.kind.word() + "\" without confine_radius, the radius of the pipe; give it");
}

}  // namespace

BondProperties published_bond(double radius, int direction) { return published_passport().bond(radius, direction); }

RagPiece make_piece(const RagSettings& s, const std::string& where, const std::filesystem::path& folder) {
  RagPiece piece;
  piece.rag.name = s.name;
  check_size(s, where);
  set_lattice(s, piece);
  set_cuts(s, where, piece.rag);
  set_thickness(s, where, piece.rag);
  piece.rag.wall_friction = s.wall_friction, piece.rag.cloth_friction = s.cloth_friction;
  set_mass(s, piece.rag);
  set_bonds(s, where, folder, piece.rag);
  piece.centre = s.position, piece.velocity = s.velocity, piece.spin = s.spin;
  piece.insert_time = s.insert_time, piece.match_flow_velocity = s.match_flow_velocity;
  // A chain needs one direction only: any other that is not parallel completes the frame.
  const Vec3 aside = std::abs(s.lengthwise.x) < 0.9 * norm(s.lengthwise) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  try {
    piece.orientation = rotation_to(s.lengthwise, s.shape == Shape::fibre ? aside : s.crosswise);
  } catch (const Error& error) {
    throw Error(error.code, where + ": " + error.what());
  }
  piece.plan = s.plan, piece.plan.where = where;
  check_plan(s, where);
  if (!s.pose_file.empty()) piece.poses = read_pose_file(folder / s.pose_file, piece.rag);
  if (s.plan.kind == PosePlan::Kind::folded) piece.poses = folded_poses(piece);
  return piece;
}

}  // namespace snag
