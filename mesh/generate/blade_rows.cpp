// Impeller and vaned diffuser between parallel walls: a radial machine whose blades and vanes are given by coordinates, as a plane slice of
// the mid-span or in three dimensions.
//
//   rotor   ring from inlet_radius to sliding_radius, less the blades; with the axial inlet
//   stator  ring from sliding_radius to outlet_radius, less the vanes
//
// The plane is meshed once (blade_plan.hpp: quadrangles in layers around the blades, quadrangles and some triangles elsewhere) and swept
// along z. One cell across is a plane flow between planes of symmetry. More are graded to both walls; the blades then end before the front
// casing at z = 0 by the tip gap, over which the inside of their outlines is filled.
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "mesh/generate/axial_inlet.hpp"
#include "mesh/generate/blade_plan.hpp"
#include "mesh/generate/block.hpp"
#include "mesh/generate/geometry.hpp"
#include "mesh/generate/swept.hpp"

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double far_over_size = 10;  // distance from the blades over wall_size at which the cells have core_size

struct BladeRows final : Geometry {
  static constexpr const char* name = "blade_rows";
  int blades = 7, vanes = 12, layers = 4, cells_across = 1, tip_gap_cells = 2;
  std::vector<double> blade_radius, blade_angle, vane_radius, vane_angle;
  double inlet_radius = 0.1, sliding_radius = 0.217, outlet_radius = 0.365, thickness = 0.004;
  double size = 1, wall_size = 0.003, edge_size = 0.001, interface_size = 0.002, core_size = 0.005, first_layer = 0.0005,
         layer_growth = 1.3;
  double across_ratio = 12, tip_gap = 0, casing_fillet = 0, hub_fillet = 0.1, hub_radius = 0.109, inlet_length = 0.1;

  std::string meaning() const override {
    return "Impeller and vaned diffuser by coordinates, with a sliding interface: a plane slice of one layer of cells (patches inlet, "
           "outlet, impeller_walls, vane_walls, planes) or the machine between hub and front casing, with gaps at the blades' tips and an "
           "axial inlet (hub, casing, diffuser_walls instead of planes, and rod).";
  }

  std::vector<Parameter> parameters() override {
    using enum Basis;
    return {
        {"blades", &blades, "1", 1, 100, measured, "Number of blades of the impeller."},
        {"blade_radius", &blade_radius, "m", 1e-4, 100, measured, "Radii of the points of one blade's closed outline, in order around it."},
        {"blade_angle", &blade_angle, "rad", -7, 7, measured, "Angles of these points about the axis, +z."},
        {"vanes", &vanes, "1", 1, 100, measured, "Number of vanes of the diffuser."},
        {"vane_radius", &vane_radius, "m", 1e-4, 100, measured, "Radii of the points of one vane's closed outline."},
        {"vane_angle", &vane_angle, "rad", -7, 7, measured, "Angles of these points."},
        {"inlet_radius", &inlet_radius, "m", 1e-4, 100, assumed,
         "Radius of the inlet, a cylinder; with an axial inlet, where that begins."},
        {"sliding_radius", &sliding_radius, "m", 1e-4, 100, assumed, "Radius of the sliding interface, between blades and vanes."},
        {"outlet_radius", &outlet_radius, "m", 1e-4, 100, assumed, "Radius of the outlet, a cylinder."},
        {"thickness", &thickness, "m", 1e-5, 10, assumed, "Thickness of the slice; distance of the hub from the front casing."},
        {"cells_across", &cells_across, "1", 1, 1000, assumed,
         "Cells between hub and front casing, without those in the tip gap; 1: plane flow between planes of symmetry."},
        {"across_ratio", &across_ratio, "1", 1, 1000, assumed, "Largest over least height of these cells, which are graded to both sides."},
        {"tip_gap", &tip_gap, "m", 0, 1, measured, "Distance of the blades from the front casing."},
        {"tip_gap_cells", &tip_gap_cells, "1", 1, 100, assumed, "Cells across the tip gap."},
        {"casing_fillet", &casing_fillet, "m", 0, 10, measured,
         "Axial inlet: radius of the quarter circle of the front casing from inlet_radius to the pipe; 0: radial inlet."},
        {"hub_fillet", &hub_fillet, "m", 1e-4, 10, measured, "Axial inlet: radius of the quarter circle of the hub to a rod on the axis."},
        {"hub_radius", &hub_radius, "m", 1e-4, 10, measured, "Axial inlet: radius where the quarter circle of the hub begins."},
        {"inlet_length", &inlet_length, "m", 1e-4, 10, assumed, "Axial inlet: distance of the inlet from the plane of the front casing."},
        {"size_factor", &size, "1", 0.01, 100, assumed,
         "Factor on all sizes and layers below, for meshes that are finer or coarser everywhere."},
        {"wall_size", &wall_size, "m", 1e-5, 10, assumed, "Edge length along blades and vanes."},
        {"edge_size", &edge_size, "m", 1e-5, 10, assumed, "Edge length at their corners."},
        {"interface_size", &interface_size, "m", 1e-5, 10, assumed, "Edge length on both sides of the sliding interface."},
        {"core_size", &core_size, "m", 1e-5, 10, assumed, "Edge length away from the walls."},
        {"layers", &layers, "1", 1, 100, assumed, "Number of layers at the walls."},
        {"first_layer", &first_layer, "m", 1e-7, 1, assumed, "Thickness of the layer at the wall."},
        {"layer_growth", &layer_growth, "1", 1, 3, assumed, "Ratio of neighbouring layers."}};
  }

  Expectation build(double attempt_factor) override;

 private:
  bool is_plane() const { return cells_across == 1; }
  bool has_axial_inlet() const { return casing_fillet > 0; }
  void check() const;
  AxialInlet axial_inlet() const { return {inlet_radius, thickness, casing_fillet, hub_fillet, hub_radius, inlet_length}; }
  std::vector<double> levels() const;  // m, z of the nodes
  void sweep(const std::array<Ring, 2>& rings, const std::vector<int>& insides, double factor) const;
  std::vector<Plane> outline(const std::vector<double>& radius, const std::vector<double>& angle, double lowest, double highest,
                             const std::string& part) const;
  double depth(double factor) const {  // m, of all layers
    return factor * first_layer * (layer_growth == 1 ? layers : (std::pow(layer_growth, layers) - 1) / (layer_growth - 1));
  }
  void size_mesh(const std::array<Ring, 2>& rings, double factor) const;
};

// The polygon of one blade about the axis. Throws Error(usage) where it is none, or not within its ring.
std::vector<Plane> BladeRows::outline(const std::vector<double>& radius, const std::vector<double>& angle, double lowest, double highest,
                                      const std::string& part) const {
  const auto require = [&](bool rule, const std::string& message) {
    if (!rule) throw Error(ExitCode::usage, "[blade_rows]: " + part + message);
  };
  require(radius.size() == angle.size() && radius.size() > 3,
          fmt::format("_radius and {}_angle ({} and {} numbers), must be the points of one outline, four or more; complete them", part,
                      radius.size(), angle.size()));
  std::vector<Plane> points;
  for (std::size_t i = 0; i < radius.size(); ++i) points.push_back({radius[i] * std::cos(angle[i]), radius[i] * std::sin(angle[i])});
  const auto rooms = rooms_of(points, depth(size));
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double room = rooms[i];
    require(radius[i] - room > lowest && radius[i] + room < highest,
            fmt::format("_radius ({:g} m), must lie between the radii of its ring ({:g} and {:g} m) with room for the layers ({:.2g} m); "
                        "change the rings or take thinner layers",
                        radius[i], lowest, highest, room));
  }
  return points;
}

void BladeRows::size_mesh(const std::array<Ring, 2>& rings, double factor) const {
  namespace field = gmsh::model::mesh::field;
  std::vector<double> curves, corners, circles, minimum;
  for (const Ring& ring : rings) {
    for (const int curve : ring.row.frames) curves.push_back(curve);
    for (const int corner : ring.row.corners) corners.push_back(corner);
  }
  for (const int arc : rings[1].inner) circles.push_back(arc);
  const auto growth = [&](const char* list, const std::vector<double>& tags, double near, double far, double to) {
    const int distance = field::add("Distance");
    field::setNumbers(distance, list, tags);
    field::setNumber(distance, "NumPointsPerCurve", 200);
    const int threshold = field::add("Threshold");
    field::setNumber(threshold, "InField", distance);
    field::setNumber(threshold, "SizeMin", near);
    field::setNumber(threshold, "SizeMax", far);
    field::setNumber(threshold, "DistMin", 0);
    field::setNumber(threshold, "DistMax", to);
    minimum.push_back(threshold);
  };
  const double far = factor * core_size, reach = far_over_size * wall_size;
  growth("CurvesList", curves, factor * wall_size, far, reach);
  growth("PointsList", corners, factor * edge_size, far, reach * (core_size - edge_size) / std::max(core_size - wall_size, edge_size) / 2);
  growth("CurvesList", circles, factor * interface_size, far, reach);
  const int least = field::add("Min");
  field::setNumbers(least, "FieldsList", minimum);
  field::setAsBackgroundMesh(least);
  for (const char* source : {"Mesh.MeshSizeFromPoints", "Mesh.MeshSizeFromCurvature", "Mesh.MeshSizeExtendFromBoundary"})
    gmsh::option::setNumber(source, 0);
  gmsh::option::setNumber("Mesh.RecombinationAlgorithm", 0);
}

void BladeRows::check() const {
  const auto require = [](bool rule, const std::string& message) {
    if (!rule) throw Error(ExitCode::usage, "[blade_rows]: " + message);
  };
  require(!is_plane() || (tip_gap == 0 && !has_axial_inlet()),
          "cells_across (1, a plane flow), must be 2 or more with tip_gap or casing_fillet; raise it");
  require(tip_gap < thickness / 2,
          fmt::format("tip_gap ({:g} m), must be below half of thickness ({:g} m); reduce it", tip_gap, thickness));
  if (!has_axial_inlet()) return;
  const AxialInlet inlet = axial_inlet();
  require(inlet.rod_radius() > 0 && hub_radius <= inlet_radius,
          fmt::format("hub_radius ({:g} m), must lie between hub_fillet ({:g} m) and inlet_radius ({:g} m); change it", hub_radius,
                      hub_fillet, inlet_radius));
  require(inlet.pipe_radius() > inlet.rod_radius() && inlet.hub_end() < -casing_fillet,
          fmt::format("casing_fillet ({:g} m), must end in a pipe wider than the rod ({:g} m) and before the hub's circle ends (z {:g} m); "
                      "reduce it",
                      casing_fillet, inlet.rod_radius(), inlet.hub_end()));
  require(inlet_length > -inlet.hub_end(),
          fmt::format("inlet_length ({:g} m), must exceed {:g} m, where the hub's circle ends; raise it", inlet_length, -inlet.hub_end()));
}

std::vector<double> BladeRows::levels() const {
  std::vector<double> levels{0};
  if (tip_gap > 0)
    for (int k = 1; k <= tip_gap_cells; ++k) levels.push_back(tip_gap * k / tip_gap_cells);
  for (const double part : graded(cells_across, across_ratio, true)) levels.push_back(tip_gap + part * (thickness - tip_gap));
  return levels;
}

void BladeRows::sweep(const std::array<Ring, 2>& rings, const std::vector<int>& insides, double factor) const {
  const auto z = levels();
  const int n = static_cast<int>(z.size()) - 1, tip = n - cells_across;
  SweptMesh mesh(z);
  const auto sweep_ring = [&](const std::string& volume, const Ring& ring, const char* walls, int walls_from, const char* low,
                              const char* high) {
    auto surfaces = ring.row.layers;
    surfaces.push_back(ring.surface);
    const auto faces = plane_faces(surfaces);
    mesh.sweep(volume, faces, {0, n});
    mesh.add_sides(walls, plane_edges(ring.row.walls), {walls_from, n});
    mesh.add_plane(is_plane() ? "planes" : low, faces, 0);
    mesh.add_plane(is_plane() ? "planes" : high, faces, n);
  };
  sweep_ring("rotor", rings[0], "impeller_walls", tip, "casing", "hub");
  sweep_ring("stator", rings[1], "vane_walls", 0, "diffuser_walls", "diffuser_walls");
  mesh.add_sides("interface_rotor", plane_edges(rings[0].outer), {0, n});
  mesh.add_sides("interface_stator", plane_edges(rings[1].inner), {0, n});
  mesh.add_sides("outlet", plane_edges(rings[1].outer), {0, n});
  const auto over_tips = plane_faces(insides);
  mesh.sweep("rotor", over_tips, {0, tip});
  mesh.add_plane("casing", over_tips, 0);
  mesh.add_plane("impeller_walls", over_tips, tip);
  const auto inner = plane_edges(rings[0].inner);
  if (has_axial_inlet())
    axial_inlet().add_to(mesh, "rotor", inner, z, factor * core_size);
  else
    mesh.add_sides("inlet", inner, {0, n});
  mesh.replace_current_model();
}

Expectation BladeRows::build(double attempt_factor) {
  check();
  const double size_factor = attempt_factor * size;
  const auto blade = outline(blade_radius, blade_angle, inlet_radius, sliding_radius, "blade"),
             vane = outline(vane_radius, vane_angle, sliding_radius, outlet_radius, "vane");
  const Layers frame{layers, layer_growth, depth(size_factor)};
  const auto row = [&](const std::vector<Plane>& points, int count) {
    return row_of(points, count, size_factor * edge_size, size_factor * wall_size, frame);
  };
  // The circle of the rotor starts elsewhere: the two sides of the interface do not have their nodes at the same places by chance.
  const std::array<Ring, 2> rings{ring_of(circle(inlet_radius, 0), circle(sliding_radius, 0.3), row(blade, blades)),
                                  ring_of(circle(sliding_radius, 0), circle(outlet_radius, 0), row(vane, vanes))};
  std::vector<int> insides;
  if (tip_gap > 0)
    for (const int loop : rings[0].row.wall_loops) insides.push_back(gmsh::model::geo::addPlaneSurface({loop}));
  gmsh::model::geo::synchronize();
  size_mesh(rings, size_factor);
  gmsh::model::mesh::generate(2);
  sweep(rings, insides, size_factor);

  const auto volume = [&](double from, double to, int count, const Ring& ring, double span) {
    return thickness * pi * (to * to - from * from) - span * count * ring.row.area;
  };
  Expectation expectation;
  expectation.volumes = {
      {"rotor", 1,
       volume(inlet_radius, sliding_radius, blades, rings[0], thickness - tip_gap) + (has_axial_inlet() ? axial_inlet().volume() : 0)},
      {"stator", 1, volume(sliding_radius, outlet_radius, vanes, rings[1], thickness)}};
  expectation.equal_areas = {{"interface_rotor", "interface_stator"}};
  return expectation;
}

const bool registered = geometries().add<BladeRows>();

}  // namespace
}  // namespace snag::generate
