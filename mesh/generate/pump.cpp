// Wastewater pump of one to seven vanes in two zones, rotor and stator, that share no node: their common surface slides.
//
//   rotor   disc of the sliding radius and the turning eye, less the vanes     (pump_solids.cpp; dimensions in pump_plan.hpp)
//   stator  spiral casing with outlet pipe, and the inlet pipe or a tank: two parts that only the rotor connects
//
// Both sides of the interface have the same sizes, so that their faceted areas agree; the rotor is meshed at an angle, because one
// thread meshes the same cylinder twice alike and a sliding interface would be conformal without anyone noticing.
// Sizes follow the shape where a preset is too coarse for it: a quarter of each round nose has an edge of its own, and the walls of
// the vanes are fine enough for `cells_across_passage` cells in the narrowest passage.
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "mesh/generate/cad.hpp"
#include "mesh/generate/geometry.hpp"
#include "mesh/generate/pump_solids.hpp"
#include "mesh/generate/sizes.hpp"

namespace snag::generate {

namespace {

enum Volume { rotor = 1, stator };
enum Surface { inlet = 11, outlet, impeller_walls, casing_walls, interface_rotor, interface_stator, tank_walls, plate };

struct PumpSizes {
  double wall, edge, interface, core, pipe, tank;  // m
  double vane = wall, nose = edge;                 // m, of the vanes' walls and noses
};

const std::map<std::string, PumpSizes>& presets() {
  static const std::map<std::string, PumpSizes> sizes = {
      {"coarse", {12.5e-3, 4.4e-3, 11e-3, 16.5e-3, 27e-3, 60e-3}},
      {"medium", {5.5e-3, 2.0e-3, 5.4e-3, 8.6e-3, 12.2e-3, 32e-3}},
      {"fine", {2.9e-3, 1.0e-3, 2.9e-3, 4.65e-3, 6.8e-3, 18e-3}},
  };
  return sizes;
}

constexpr double edge_over_thickness = 0.9;  // a quarter of a round nose has the length pi/4 of the thickness: one edge
constexpr double cells_across_passage = 2;   // at least, of the size at the walls of the vanes
constexpr double edges_across_passage = 3;   // at least, of the size at the noses; narrower passages are refused

struct Pump final : Geometry {
  static constexpr const char* name = "pump";
  PumpDimensions dimensions;
  SuctionTank tank;
  std::string suction = "pipe", resolution = "coarse";
  std::optional<double> wall_size, edge_size, interface_size, core_size, pipe_size, tank_size;
  int mesh_seed = 1;
  double minimum_quality = poor_quality;

  std::string meaning() const override {
    return "Wastewater pump of one to seven vanes, rotor and stator with a sliding interface; tetrahedra.";
  }
  std::vector<Parameter> parameters() override;
  Expectation build(double size_factor) override;

 private:
  /// Faces of each named surface.
  struct Faces {
    std::map<Surface, std::vector<int>> of;
    std::vector<int> vanes, noses, tongue, pipes;  // sides and noses of vanes; outlet transition and pipes: subsets of the walls
  };
  PumpSizes sizes(double factor) const;
  void fit_to_shape(PumpSizes& h, std::vector<std::string>& remarks) const;
  void sort_rotor(const std::vector<int>& volumes, Faces& faces) const;
  void sort_casing(const std::vector<int>& volumes, Faces& faces) const;
  void sort_suction(const std::vector<int>& volumes, Faces& faces) const;
  void name_surfaces(const Faces& faces) const;
  void size_mesh(const Faces& faces, const PumpSizes& h) const;
  bool is_sliding_cylinder(const Face& face) const;
  bool is_nose(const Face& face, double radius, double height) const;
};

std::vector<Parameter> Pump::parameters() {
  auto all = dimensions.parameters();
  all.push_back(setting("inlet", &suction, "Where the pump takes its water from.", {"pipe", "tank"}));
  for (auto& parameter : tank.parameters()) all.push_back(parameter);
  all.push_back(setting("resolution", &resolution,
                        "About 30 thousand, 200 thousand or 1 million cells; a size given replaces that of the preset.",
                        {"coarse", "medium", "fine"}));
  using enum Basis;
  for (const auto& [key, target, meaning] :
       {std::tuple{"wall_size", &wall_size, "Edge length at the walls of impeller and casing."},
        std::tuple{"edge_size", &edge_size, "Edge length at the noses of vanes and tongue."},
        std::tuple{"interface_size", &interface_size, "Edge length on both sides of the sliding interface."},
        std::tuple{"core_size", &core_size, "Edge length away from the walls."},
        std::tuple{"pipe_size", &pipe_size, "Edge length in the middle of the pipes; 0.625 of it at their walls."},
        std::tuple{"tank_size", &tank_size, "Edge length in the tank, far from the inlet."}})
    all.push_back({key, target, "m", 1e-4, 1, assumed, std::string(meaning) + " By default that of the resolution."});
  all.push_back(
      {"mesh_seed", &mesh_seed, "1", 1, 1e6, assumed, "Seed of the mesh: another number makes another mesh of the same shape and sizes."});
  all.push_back({"minimum_quality", &minimum_quality, "1", 0.01, 0.3, assumed,
                 "A mesh with a cell of less quality (signed inverse condition number) is made again with sizes 1 % smaller."});
  return all;
}

PumpSizes Pump::sizes(double factor) const {
  const PumpSizes preset = presets().at(resolution);
  return {factor * wall_size.value_or(preset.wall),           factor * edge_size.value_or(preset.edge),
          factor * interface_size.value_or(preset.interface), factor * core_size.value_or(preset.core),
          factor * pipe_size.value_or(preset.pipe),           factor * tank_size.value_or(preset.tank)};
}

// Sizes that are too large for the shape are reduced, with a remark. Throws Error(usage) where no size fits between the vanes.
void Pump::fit_to_shape(PumpSizes& h, std::vector<std::string>& remarks) const {
  const auto limit = [&](double& size, double largest, const std::string& what, const std::string& reason) {
    if (size <= largest) return;
    remarks.push_back(fmt::format("{} {:.3g} m reduced to {:.3g} m: {}", what, size, largest, reason));
    size = largest;
  };
  limit(h.edge, 0.8 * (dimensions.tongue_tip_radius() - dimensions.impeller_radius()), "edge_size", "0.8 of the gap at the tongue");
  h.nose = h.edge;
  limit(h.nose, edge_over_thickness * std::min(dimensions.leading_thickness(), dimensions.trailing_thickness()), "edge_size at the vanes",
        fmt::format("{:g} of their thickness", edge_over_thickness));
  const double passage = narrowest_passage(dimensions), least = edges_across_passage * h.nose;
  if (passage < least)
    throw Error(
        ExitCode::usage,
        fmt::format("[pump]: narrowest passage between the vanes ({:.3g} m{}), must hold {:g} cells of edge_size ({:.3g} m); take fewer "
                    "vanes, a smaller wrap_angle, thinner vanes or a smaller edge_size",
                    passage, passage < 0 ? ", they overlap" : "", edges_across_passage, least));
  limit(h.vane, passage / cells_across_passage, "wall_size at the vanes",
        fmt::format("{:g} cells across their narrowest passage ({:.3g} m)", cells_across_passage, passage));
}

bool Pump::is_sliding_cylinder(const Face& face) const {
  const double area = 2 * std::numbers::pi * dimensions.sliding_radius() * dimensions.impeller_width;
  return face.type == "Cylinder" && face.spans(2, 0, dimensions.impeller_width) && std::abs(face.area / area - 1) < 1e-6;
}

// Noses are parts of round bars: cylinders over the whole height whose area is below that of half the bar.
bool Pump::is_nose(const Face& face, double radius, double height) const {
  return face.type == "Cylinder" && face.area < 1.01 * std::numbers::pi * radius * height &&
         std::abs(face.upper.z - face.lower.z - height) < 1e-5;
}

void Pump::sort_rotor(const std::vector<int>& volumes, Faces& faces) const {
  const double nose = std::max(dimensions.leading_thickness(), dimensions.trailing_thickness()) / 2;
  for (const Face& face : faces_of(volumes)) {
    const bool slides = is_sliding_cylinder(face) || face.lies_at(2, dimensions.eye_height());
    faces.of[slides ? interface_rotor : impeller_walls].push_back(face.tag);
    if (slides || !face.spans(2, 0, dimensions.impeller_width)) continue;
    (is_nose(face, nose, dimensions.impeller_width) ? faces.noses : faces.vanes).push_back(face.tag);
  }
}

void Pump::sort_casing(const std::vector<int>& volumes, Faces& faces) const {
  const VolutePlan plan = volute_plan(dimensions);
  const double loft_end = plan.outlet_start + dimensions.outlet_loft_length;
  const double outlet_end = loft_end + dimensions.outlet_length.value_or(8 * dimensions.outlet_diameter);
  for (const Face& face : faces_of(volumes)) {
    const Surface surface = is_sliding_cylinder(face) ? interface_stator : face.lies_at(1, outlet_end) ? outlet : casing_walls;
    faces.of[surface].push_back(face.tag);
    if (surface != casing_walls) continue;
    const bool in_pipe = face.lower.y > plan.outlet_start - 1e-5;
    if (in_pipe) faces.pipes.push_back(face.tag);
    if (!in_pipe && is_nose(face, dimensions.tongue_radius, dimensions.casing_width())) faces.tongue.push_back(face.tag);
  }
}

void Pump::sort_suction(const std::vector<int>& volumes, Faces& faces) const {
  const bool from_tank = suction == "tank";
  const double z_eye = dimensions.eye_height(), z_plate = tank.plate(dimensions);
  const double pipe_end = z_eye + dimensions.inlet_length.value_or(3 * dimensions.inlet_diameter);
  for (const Face& face : faces_of(volumes)) {
    Surface surface = casing_walls;
    if (face.lies_at(2, z_eye)) surface = interface_stator;
    if (!from_tank && face.lies_at(2, pipe_end)) surface = inlet;
    if (from_tank && face.lies_at(1, tank.depth - tank.axis_height)) surface = inlet;
    if (from_tank && surface == casing_walls) {
      const bool wide =
          face.upper.x - face.lower.x > tank.width - 1e-4 || face.lies_at(0, tank.width / 2) || face.lies_at(0, -tank.width / 2);
      const bool on_plate = face.lower.z > z_plate - 1e-5 && face.upper.z < z_plate + tank.plate_thickness + 1e-5;
      surface = wide ? tank_walls : on_plate ? plate : casing_walls;
    }
    faces.of[surface].push_back(face.tag);
    if (surface == casing_walls) faces.pipes.push_back(face.tag);
  }
}

std::vector<int> without(std::vector<int> all, const std::vector<int>& excluded) {
  std::erase_if(all, [&](int tag) { return std::ranges::find(excluded, tag) != excluded.end(); });
  return all;
}

std::vector<int> joined_lists(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Expectation Pump::build(double size_factor) {
  Expectation expectation;
  PumpSizes h = sizes(size_factor);
  fit_to_shape(h, expectation.remarks);

  const bool from_tank = suction == "tank";
  const double inlet_length = dimensions.inlet_length.value_or((from_tank ? 0.3 : 3) * dimensions.inlet_diameter);
  const auto casing = casing_solid(dimensions), wheel = rotor_solid(dimensions);
  const auto supply = from_tank ? tank_solid(dimensions, tank, inlet_length) : inlet_pipe_solid(dimensions, inlet_length);
  remove_helpers();

  Faces faces;
  sort_rotor(wheel, faces);
  sort_casing(casing, faces);
  sort_suction(supply, faces);
  name_group(3, rotor, "rotor", wheel);
  name_group(3, stator, "stator", joined_lists(casing, supply));
  name_surfaces(faces);

  expectation.volumes = {{"rotor", 1, volume_of(wheel)}, {"stator", 2, volume_of(casing) + volume_of(supply)}};
  expectation.equal_areas = {{"interface_rotor", "interface_stator"}};
  expectation.minimum_quality = minimum_quality;
  size_mesh(faces, h);
  gmsh::option::setNumber("Mesh.RandomSeed", mesh_seed);
  return expectation;
}

void Pump::name_surfaces(const Faces& faces) const {
  const auto named = [&](Surface surface, const char* label) {
    const auto found = faces.of.find(surface);
    name_group(2, surface, label, found == faces.of.end() ? std::vector<int>{} : found->second);
  };
  named(inlet, "inlet");
  named(outlet, "outlet");
  named(impeller_walls, "impeller_walls");
  named(casing_walls, "casing_walls");
  named(interface_rotor, "interface_rotor");
  named(interface_stator, "interface_stator");
  if (suction != "tank") return;
  named(tank_walls, "tank_walls");
  named(plate, "plate");
}

void Pump::size_mesh(const Faces& faces, const PumpSizes& h) const {
  const auto& of = faces.of;
  const auto edges = joined_lists(faces.noses, faces.tongue);
  const auto walls = without(without(joined_lists(of.at(impeller_walls), of.at(casing_walls)), edges), faces.pipes);
  // Growth is slow on coarse meshes and quick on fine ones: in between the core's size and the casing's radius.
  const double growth_distance = std::sqrt(h.core * dimensions.tongue_tip_radius());
  SizeField field;
  field.around(walls, {h.wall, h.core, 0, growth_distance});
  if (h.vane < h.wall) field.around(faces.vanes, {h.vane, h.core, 0, growth_distance});
  if (h.nose < h.edge) field.around(faces.noses, {h.nose, h.core, 0, growth_distance});
  field.around(edges, {h.edge, h.core, 0, growth_distance});
  field.around(joined_lists(of.at(interface_rotor), of.at(interface_stator)), {h.interface, h.core, 0, growth_distance});
  field.around(faces.pipes, {0.625 * h.pipe, h.pipe, 0, 2.5 * h.pipe}, suction == "pipe");
  if (suction == "tank") {
    const double reach = tank.width / 2;
    field.around(faces.pipes, {0.625 * h.pipe, h.tank, 0, reach});
    field.around(of.at(plate), {1.5 * h.core, h.tank, 0, reach});
    field.formula(fmt::format("{}", h.tank));
  }
  field.apply();
}

const bool registered = geometries().add<Pump>();

}  // namespace
}  // namespace snag::generate
