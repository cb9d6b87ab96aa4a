#include "dem/templates/rag_settings.hpp"

#include <array>

#include "base/case_tables.hpp"

namespace snag {

namespace {

using Shape = RagSettings::Shape;

struct ShapeText {
  const char* table;
  const char* meaning;
};
constexpr std::array<ShapeText, 4> shape_texts{{
    {"rag", "A rectangular sheet of cloth: spheres in an in-line grid, bonded to their four neighbours."},
    {"disc", "A round sheet of cloth."},
    {"fibre", "A chain of bonded spheres."},
    {"particle", "A single sphere."},
}};

using Records = std::vector<Parameter>;

Parameter number(const char* key, ParameterTarget target, const char* unit, double minimum, Basis basis, const char* meaning) {
  return {.key = key, .target = target, .unit = unit, .minimum = minimum, .basis = basis, .meaning = meaning};
}

void add_size(RagSettings& s, Records& r) {
  if (s.shape == Shape::rag) {
    r.push_back(number("length", &s.length, "m", 1e-6, Basis::measured, "Side along the lattice's rows, rounded to whole particles."));
    r.push_back(number("width", &s.width, "m", 1e-6, Basis::measured, "Side across the rows, rounded to whole particles."));
  }
  if (s.shape == Shape::fibre) {
    r.push_back(number("length", &s.length, "m", 1e-6, Basis::assumed, "Length, rounded to whole particles unless n_points is given."));
    r.push_back({.key = "n_points",
                 .target = &s.n_points,
                 .minimum = 0,
                 .meaning = "Number of particles; the particle radius then follows from the length. 0: length over particle diameter."});
    r.push_back(number("diameter", &s.diameter, "m", 0, Basis::assumed,
                       "Diameter of the fibre for mass, drag and stiffness as a beam; 0: the particle diameter."));
  }
  if (s.shape == Shape::disc) r.push_back(number("diameter", &s.diameter, "m", 1e-6, Basis::measured, "Diameter of the disc."));
  if (s.shape == Shape::particle) {
    r.push_back(number("diameter", &s.diameter, "m", 1e-9, Basis::assumed, "Diameter of the sphere."));
    r.push_back(number("density", &s.density, "kg/m3", 1e-3, Basis::assumed, "Density of the sphere."));
  } else {
    r.push_back(number("radius", &s.radius, "m", 1e-7, Basis::literature, "Radius r_p of a particle; the lattice spacing is twice that."));
  }
}

void add_mass(RagSettings& s, Records& r) {
  if (s.shape == Shape::particle) return;
  if (s.shape == Shape::fibre) {
    r.push_back(number("density", &s.density, "kg/m3", 1e-3, Basis::literature, "Density of the fibre; the default is that of polyester."));
    return;
  }
  r.push_back(
      number("thickness", &s.thickness, "m", 1e-7, Basis::measured,
             "Thickness of the cloth; times (2 r_p)^2 it is the volume of a particle for buoyancy, added mass and pressure gradient."));
  r.push_back(number("mass_per_area", &s.mass_per_area, "kg/m2", 1e-4, Basis::measured,
                     "Mass of the soaked cloth per area: 0.060 kg/m2 of polyester, and water in the rest of the thickness."));
  r.push_back(renamed(setting("density_model", &s.density_model,
                              "mass_per_area: the mass of the particles follows from that key. jensen_2018: the density of the spheres is "
                              "538 (1 mm/r_p) kg/m3, as in the coupled simulations of Jensen (2018)."),
                      {.key = "as_published", .values = {{"false", "\"mass_per_area\""}, {"true", "\"jensen_2018\""}}}));
}

void add_plan(PosePlan& p, Records& r) {
  r.push_back(
      setting("pose", &p.kind,
              "How the sheet lies. folded: like a fan. confined: crumpled by a smooth pipe that closes in around the flat sheet, in "
              "a run of the particles alone. hopper: fallen through a smooth cone into the pipe (Jensen 2018, section 5.2.2)."));
  const auto folds = [&](const char* key, int* target, const char* meaning) {
    r.push_back({.key = key, .target = target, .minimum = 0, .maximum = 1e6, .meaning = meaning});
  };
  folds("folds_lengthwise", &p.folds_lengthwise, "folded: number of folds, which shorten the length; layers are 4 r_p apart.");
  folds("folds_crosswise", &p.folds_crosswise,
        "folded: number of folds, which shorten the width; cloth is folded in one of the two directions only.");
  r.push_back(number("confine_radius", &p.confine_radius, "m", 0, Basis::assumed,
                     "confined, hopper: radius of the pipe, whose axis goes through centre."));
  r.push_back(number("confine_length", &p.confine_length, "m", 0, Basis::assumed,
                     "confined: length of the pipe between two ends, which close in too; 0: the pipe has no ends, and the mean of the "
                     "particles along the axis is at centre."));
  r.push_back(number("confine_axis", &p.confine_axis, "1", -infinity, Basis::assumed,
                     "confined, hopper: direction of the pipe, a vector of any length; for a hopper the direction of gravity."));
  r.push_back({.key = "hopper_angle",
               .target = &p.hopper_angle,
               .unit = "rad",
               .minimum = 0.05,
               .maximum = 1.5,
               .meaning = "hopper: angle between the side of the cone and its axis."});
  r.push_back({.key = "seed",
               .target = &p.seed,
               .minimum = 0,
               .meaning = "confined, hopper: seed of the slow waves that the sheet begins with; each seed gives another pose."});
}

void add_pose(RagSettings& s, Records& r) {
  const bool point = s.shape == Shape::particle;
  r.push_back(number(point ? "position" : "centre", &s.position, "m", -infinity, Basis::assumed,
                     point ? "Centre of the sphere." : "Centre of the lattice."));
  r.push_back(number("velocity", &s.velocity, "m/s", -infinity, Basis::assumed, "Velocity of the piece at its insertion."));
  r.push_back(number("spin", &s.spin, "rad/s", -infinity, Basis::assumed,
                     "Angular velocity of the whole piece about its centre at its insertion."));
  r.push_back(number("insert_time", &s.insert_time, "s", 0, Basis::assumed,
                     "Time at which the piece is put into the flow; walls that turn have their position at that time."));
  r.push_back(renamed(setting("match_flow_velocity", &s.match_flow_velocity,
                              "The mean velocity of the water at the particles is added to `velocity` when the piece is put in."),
                      {.key = "with_water"}));
  for (const Parameter& parameter : s.copies.parameters()) r.push_back(parameter);
  if (point) return;
  r.push_back(number("lengthwise", &s.lengthwise, "1", -infinity, Basis::assumed, "Direction of the rows, a vector of any length."));
  if (s.shape != Shape::fibre)
    r.push_back(number("crosswise", &s.crosswise, "1", -infinity, Basis::assumed,
                       "Direction across the rows; its component along `lengthwise` is removed."));
  if (s.shape != Shape::fibre) add_plan(s.plan, r);
  r.push_back(
      file_setting("pose_file", &s.pose_file,
                   "File with the positions of all particles relative to centre, instead of directions and pose, such as rags/pose_<n>.csv "
                   "of another run: CSV with a header and rows id,x,y,z,qw,qx,qy,qz in m; id = row * n_columns + column."));
}

void add_bond_direction(const std::string& direction, BondProperties& p, Records& r) {
  const auto add = [&](const char* key, double* target, const char* unit, const char* meaning) {
    r.push_back(number((key + direction).c_str(), target, unit, 0, Basis::calibrated, meaning));
  };
  add("normal_stiffness_", &p.normal_stiffness, "N/m3", "S_n: normal stiffness per unit area of the bond, for properties = \"custom\".");
  add("tangential_stiffness_", &p.tangential_stiffness, "N/m3", "S_t: stiffness in shear and torsion per unit area of the bond.");
  add("bending_stiffness_", &p.bending_stiffness, "N/m3", "S_nb: stiffness in bending per unit area of the bond.");
  add("normal_strength_", &p.normal_strength, "Pa", "Tensile stress at which a bond breaks; 0: it never breaks in tension.");
  add("shear_strength_", &p.shear_strength, "Pa", "Shear stress at which a bond breaks; 0: it never breaks in shear.");
}

void add_bonds(RagSettings& s, Records& r) {
  if (s.shape == Shape::particle) return;
  r.push_back(setting("bond_law", &s.bond_law, "Law of the bonds; the keys of the law are in a table of its name.", bond_laws().names()));
  r.push_back(file_setting(
      "passport", &s.passport,
      "Textile passport with the bonds that `snag calibrate` found from tests of the cloth, instead of `properties`, such as "
      "cases/textile-aro/passport.toml; between its radii the logarithms are interpolated. A fibre takes the lengthwise bonds."));
  std::vector<std::string> choices{"published", "custom"};
  if (s.shape == Shape::fibre) choices.insert(choices.begin(), "beam");
  r.push_back(renamed(setting("properties", &s.properties,
                              "Properties of the bonds. published: calibrated by Jensen (2018), Tables 3.3 and 3.4, for a particle radius "
                              "of 1 to 2 mm (logarithms interpolated in between). custom: the stiffnesses and strengths below. beam: "
                              "those of a round elastic beam of the fibre's diameter.",
                              choices),
                      {.values = {{"\"given\"", "\"custom\""}}}));
  if (s.shape == Shape::fibre)
    r.push_back(
        number("youngs_modulus", &s.youngs_modulus, "Pa", 1, Basis::assumed, "Young's modulus of a fibre, for properties = \"beam\"."));
  add_bond_direction("lengthwise", s.along, r);
  if (s.shape != Shape::fibre) add_bond_direction("crosswise", s.across, r);
  r.push_back(number("bond_damping", &s.bond_damping, "1", 0, Basis::literature,
                     "c_d: damping ratio of the shortest wave; Jensen (2018) App. 1.4, after Guo et al. (2013)."));
  r.push_back(
      number("rotation_friction", &s.rotation_friction, "1", 0, Basis::literature,
             "c_r: moment against relative rotation of bonded particles over normal bond force and radius; Jensen (2018) App. 1.4."));
  r.push_back(
      number("contact_radius_ratio", &s.contact_radius_ratio, "1", 1, Basis::literature, "r_c/r_p: a bond longer than 2 r_c breaks."));
  r.push_back(setting("breakage", &s.breakage, "true: bonds break by strength and by length."));
}

/// Where and how the piece touches others.
void add_contacts(RagSettings& s, Records& r) {
  r.push_back(number("shear_modulus", &s.shear_modulus, "Pa", 1, Basis::literature,
                     "Shear modulus G of a particle in contacts; by default 1 MPa (Jensen 2018, Table 3.1), for a fibre as a beam at most "
                     "its own, E/(2 (1 + nu))."));
  if (s.shape != Shape::particle) {
    r.push_back(
        number("contact_thickness", &s.contact_thickness, "m", 1e-7, Basis::assumed,
               "Thickness of the cloth in contacts with walls, at most 2 r_p, the default: cloth enters a gap that is wider. A thin one "
               "may need a larger [contact] wall_stiffness_factor, as it may be pressed in by half of it only."));
    r.push_back(
        number("layer_thickness", &s.layer_thickness, "m", 1e-7, Basis::assumed,
               "Distance of layers of cloth that lie on each other, at most 2 r_p, the default. Below sqrt(2) r_p the particles of one "
               "layer fit through the lattice of the other where the two meet at more than 37 degrees."));
  }
  const auto friction = [&](const char* key, std::optional<double>* target, const char* meaning) {
    r.push_back({.key = key, .target = target, .minimum = 0, .maximum = 10, .basis = Basis::assumed, .meaning = meaning});
  };
  friction("wall_friction", &s.wall_friction,
           "Coulomb coefficient of this piece with walls; not given: [contact] wall_friction. Assumed range of wet "
           "cloth on steel: 0.2 to 1.3; sources in the tutorial on cloth.");
  friction("cloth_friction", &s.cloth_friction,
           "Coulomb coefficient with cloth, its own and that of other pieces; of two different ones the geometric mean counts; not given: "
           "[contact] static_friction. Wet textiles: 0.15 to 0.85; sources in the tutorial on cloth.");
  r.push_back({.key = "poisson_ratio",
               .target = &s.poisson_ratio,
               .minimum = 0,
               .maximum = 0.5,
               .basis = Basis::assumed,
               .meaning = "Poisson ratio of a particle in contacts."});
}

}  // namespace

RagSettings::RagSettings(Shape piece_shape) : shape(piece_shape) {
  if (shape == Shape::disc) diameter = 0.210;
  if (shape == Shape::particle) diameter = 2e-3;
  if (shape == Shape::fibre) length = 0.05, properties = Properties::beam;
}

Section RagSettings::section() {
  const ShapeText& text = shape_texts[static_cast<std::size_t>(shape)];
  Records r{setting("name", &name, "Name in outputs; by default the table and the number of the piece.")};
  add_size(*this, r), add_mass(*this, r), add_pose(*this, r), add_bonds(*this, r), add_contacts(*this, r);
  return {text.table, text.meaning, r, true};
}
const bool rag_table = add_case_table<RagSettings>(130, RagSettings::Shape::rag);
const bool disc_table = add_case_table<RagSettings>(140, RagSettings::Shape::disc);
const bool fibre_table = add_case_table<RagSettings>(150, RagSettings::Shape::fibre);
const bool particle_table = add_case_table<RagSettings>(160, RagSettings::Shape::particle);

Section CutSettings::section() {
  return {
      "rag.cut",
      "A straight cut in a `[[rag]]`; in a `[[disc]]` the table is `[[disc.cut]]`. Bonds that cross the line from one end to the other are "
      "not made, so that both sides can move apart. Places are those of the flat cloth, from its centre: lengthwise, crosswise. A particle "
      "on the line belongs to the left of it. A cut that crosses no bond is an error.",
      {{.key = "from", .target = &from, .unit = "m", .meaning = "One end of the cut, two numbers."},
       {.key = "to", .target = &to, .unit = "m", .meaning = "The other end."}},
      true};
}
const bool cut_table = add_case_table<CutSettings>(145);

Section DemSettings::section() {
  return {"dem",
          "Motion of the rags within a step of the water.",
          {number("step", &step, "s", 1e-12, Basis::assumed,
                  "Sub-step of the rags; by default safety times the stable one. A larger one than the stable one is refused."),
           {.key = "safety",
            .target = &safety,
            .minimum = 0.01,
            .maximum = 1,
            .basis = Basis::assumed,
            .meaning = "Sub-step over the stable sub-step."}}};
}
const bool dem_table = add_case_table<DemSettings>(190);

namespace {

std::shared_ptr<const BondLaw> read_bond_law(const std::string& name, const Table& table) {
  std::shared_ptr<BondLaw> law = bond_laws().make(name, table.where() + " bond_law");
  table.table(name).read(law->parameters());
  return law;
}

}  // namespace

std::vector<RagPiece> read_pieces(const CaseFile& file) {
  std::vector<RagPiece> pieces;
  for (const Shape shape : {Shape::rag, Shape::disc, Shape::fibre, Shape::particle}) {
    int count = 0;
    const std::string name = shape_texts[static_cast<std::size_t>(shape)].table;
    for (const Table& table : file.root().tables(name)) {
      RagSettings settings(shape);
      table.read(settings.section().parameters);
      if (shape == Shape::rag || shape == Shape::disc)
        for (const Table& cut : table.tables("cut")) cut.read(settings.cuts.emplace_back().section().parameters);
      if (shape != Shape::particle) settings.law = read_bond_law(settings.bond_law, table);
      for (RagPiece& piece : copies_of(make_piece(settings, table.where(), file.path(".")), settings.copies, table.where())) {
        ++count;
        if (piece.rag.name.empty()) piece.rag.name = name + " " + std::to_string(count);
        pieces.push_back(std::move(piece));
      }
    }
  }
  return pieces;
}

}  // namespace snag
