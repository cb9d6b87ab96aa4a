// Impeller and vaned diffuser between parallel walls, a slice of the mid-span: the plane flow through a radial machine whose blades and
// vanes are given by coordinates.
//
//   rotor   ring from inlet_radius to sliding_radius, less the blades
//   stator  ring from sliding_radius to outlet_radius, less the vanes
//
// One layer of cells across, between planes of symmetry. Each blade lies in a frame of layers of hexahedra, which are cut along the line
// that halves a corner; the rest is hexahedra and some prisms. An outline is a closed polygon with a smooth curve (spline) through its
// points between corners, which are points where it turns by more than corner_turn.
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "mesh/generate/cad.hpp"
#include "mesh/generate/geometry.hpp"

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi, corner_turn = pi / 6;
constexpr double far_over_size = 10;   // distance from the blades over wall_size at which the cells have core_size
constexpr double long_side = 10;       // lengths of wall_size from which on a side is finer towards its ends
constexpr double longest_spoke = 1.6;  // depth of the layers at a sharp corner over that along a side
enum Volume { rotor = 1, stator };
enum Surface { inlet = 11, outlet, impeller_walls, vane_walls, interface_rotor, interface_stator, planes };

using Plane = std::array<double, 2>;  // x, y

struct Layers {
  int count;
  double growth, depth;  // ratio of neighbours; m, all together
};

// Blades in the plane: surfaces of their layers, curves of the walls and around the layers, loops of the latter, points at corners of the
// latter.
struct Row {
  std::vector<int> layers, walls, frames, loops, corners;
  double area = 0;  // m2, of one blade
};

struct Ring {
  std::vector<int> inner, outer;
  Row row;
  int surface = 0;
};

struct BladeRows final : Geometry {
  static constexpr const char* name = "blade_rows";
  int blades = 7, vanes = 12, layers = 4;
  std::vector<double> blade_radius, blade_angle, vane_radius, vane_angle;
  double inlet_radius = 0.1, sliding_radius = 0.217, outlet_radius = 0.365, thickness = 0.004;
  double size = 1, wall_size = 0.003, edge_size = 0.001, interface_size = 0.002, core_size = 0.005, first_layer = 0.0005,
         layer_growth = 1.3;

  std::string meaning() const override {
    return "Impeller and vaned diffuser by coordinates, a plane slice of one layer of cells with a sliding interface; patches inlet, "
           "outlet, "
           "impeller_walls, vane_walls, planes.";
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
        {"inlet_radius", &inlet_radius, "m", 1e-4, 100, assumed, "Radius of the inlet, a cylinder."},
        {"sliding_radius", &sliding_radius, "m", 1e-4, 100, assumed, "Radius of the sliding interface, between blades and vanes."},
        {"outlet_radius", &outlet_radius, "m", 1e-4, 100, assumed, "Radius of the outlet, a cylinder."},
        {"thickness", &thickness, "m", 1e-5, 10, assumed, "Thickness of the slice."},
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
  std::vector<Plane> outline(const std::vector<double>& radius, const std::vector<double>& angle, double lowest, double highest,
                             const std::string& part) const;
  double depth(double factor) const {  // m, of all layers
    return factor * first_layer * (layer_growth == 1 ? layers : (std::pow(layer_growth, layers) - 1) / (layer_growth - 1));
  }
  void size_mesh(const std::array<Ring, 2>& rings, double factor) const;
};

double signed_area(const std::vector<Plane>& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

Plane difference(const Plane& a, const Plane& b) { return {a[0] - b[0], a[1] - b[1]}; }
double length(const Plane& a) { return std::hypot(a[0], a[1]); }

// At each point: the angle by which the outline turns, and the direction out of the blade that halves it.
struct Bend {
  double turn;
  Plane outwards;
};

std::vector<Bend> bends_of(const std::vector<Plane>& points) {
  const double side = signed_area(points) > 0 ? 1 : -1;
  const std::size_t n = points.size();
  std::vector<Bend> bends;
  for (std::size_t i = 0; i < n; ++i) {
    const Plane u = difference(points[i], points[(i + n - 1) % n]), v = difference(points[(i + 1) % n], points[i]);
    const double turn = std::atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]), direction = std::atan2(u[1], u[0]) + turn / 2;
    bends.push_back({std::abs(turn), {side * std::sin(direction), -side * std::cos(direction)}});
  }
  return bends;
}

// Depth of the layers at a point over that along a straight wall.
double spoke(const Bend& bend) { return std::min(1 / std::cos(bend.turn / 2), longest_spoke); }

// Cells along one piece of an outline of length L that grow from `first` at one end to `last` at the other.
struct Grading {
  int cells;
  double ratio;
};

Grading grading(double L, double first, double last) {
  if (L < first + last || first == last) return {std::max(1, static_cast<int>(std::lround(2 * L / (first + last)))), 1};
  const double ratio = (L - first) / (L - last);
  const int cells = std::max(1, static_cast<int>(std::lround(1 + std::log(last / first) / std::log(ratio))));
  return {cells, std::pow(last / first, 1.0 / std::max(1, cells - 1))};
}

// Pieces of an outline: it is cut at its corners, and long sides in their middle. [from, to] are indices of points; sizes at both ends, m.
struct Piece {
  std::size_t from, to;
  Grading grading;
};

std::vector<Piece> pieces_of(const std::vector<Plane>& points, const std::vector<Bend>& bends, double edge, double wall) {
  const std::size_t n = points.size();
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i)
    if (bends[i].turn > corner_turn) corners.push_back(i);
  if (corners.size() < 2) throw Error(ExitCode::usage, "[blade_rows]: an outline, must have two corners or more; end it with sharp edges");
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t from = corners[k], to = corners[(k + 1) % corners.size()];
    std::vector<double> reached{0};
    for (std::size_t j = from; j != to; j = (j + 1) % n)
      reached.push_back(reached.back() + length(difference(points[(j + 1) % n], points[j])));
    const double L = reached.back();
    if (L < long_side * wall) {
      pieces.push_back({from, to, grading(L, edge, edge)});
      continue;
    }
    const auto half = std::ranges::min_element(reached, {}, [L](double l) { return std::abs(l - L / 2); });
    const std::size_t middle = (from + static_cast<std::size_t>(half - reached.begin())) % n;
    pieces.push_back({from, middle, grading(*half, edge, wall)});
    const Grading back = grading(L - *half, edge, wall);
    pieces.push_back({middle, to, {back.cells, 1 / back.ratio}});
  }
  return pieces;
}

// `count` copies of the outline about the axis, each in a frame of layers of the thickness `depth`.
Row row_of(const std::vector<Plane>& outline, int count, const std::vector<Piece>& pieces, const Layers& layers) {
  namespace geo = gmsh::model::geo;
  Row row;
  row.area = std::abs(signed_area(outline));
  const auto bends = bends_of(outline);
  const std::size_t n = outline.size();
  for (int k = 0; k < count; ++k) {
    const double c = std::cos(2 * pi * k / count), s = std::sin(2 * pi * k / count);
    std::vector<int> wall_points, outer_points, frame;
    for (std::size_t i = 0; i < n; ++i) {
      const double depth = layers.depth * spoke(bends[i]);
      const auto& [x, y] = outline[i];
      const double X = x + depth * bends[i].outwards[0], Y = y + depth * bends[i].outwards[1];
      wall_points.push_back(geo::addPoint(c * x - s * y, s * x + c * y, 0));
      outer_points.push_back(geo::addPoint(c * X - s * Y, s * X + c * Y, 0));
    }
    const auto curve = [&](const std::vector<int>& points, const Piece& piece) {
      std::vector<int> part{points[piece.from]};
      for (std::size_t j = piece.from; j != piece.to;) {
        j = j + 1 < n ? j + 1 : 0;
        part.push_back(points[j]);
      }
      const int tag = part.size() > 2 ? geo::addSpline(part) : geo::addLine(part[0], part[1]);
      geo::mesh::setTransfiniteCurve(tag, piece.grading.cells + 1, "Progression", piece.grading.ratio);
      return tag;
    };
    std::map<std::size_t, int> spokes;
    for (const Piece& piece : pieces) {
      const int spoke = spokes[piece.from] = geo::addLine(wall_points[piece.from], outer_points[piece.from]);
      geo::mesh::setTransfiniteCurve(spoke, layers.count + 1, "Progression", layers.growth);
    }
    for (const Piece& piece : pieces) {
      const int wall = curve(wall_points, piece), outer = curve(outer_points, piece);
      const int layer = geo::addPlaneSurface({geo::addCurveLoop({wall, spokes[piece.to], -outer, -spokes[piece.from]})});
      geo::mesh::setTransfiniteSurface(layer);
      geo::mesh::setRecombine(2, layer);
      row.layers.push_back(layer);
      row.walls.push_back(wall);
      frame.push_back(outer);
      if (bends[piece.from].turn > corner_turn) row.corners.push_back(outer_points[piece.from]);
    }
    row.loops.push_back(geo::addCurveLoop(frame));
    row.frames.insert(row.frames.end(), frame.begin(), frame.end());
  }
  return row;
}

// A circle in four arcs, from `start` on: the two sides of the interface do not have their nodes at the same places by chance.
std::vector<int> circle(double radius, double start) {
  namespace geo = gmsh::model::geo;
  const int centre = geo::addPoint(0, 0, 0);
  std::vector<int> points, arcs;
  for (int k = 0; k < 4; ++k)
    points.push_back(geo::addPoint(radius * std::cos(start + k * pi / 2), radius * std::sin(start + k * pi / 2), 0));
  for (std::size_t k = 0; k < 4; ++k) arcs.push_back(geo::addCircleArc(points[k], centre, points[(k + 1) % 4]));
  return arcs;
}

Ring ring_of(std::vector<int> inner, std::vector<int> outer, Row row) {
  namespace geo = gmsh::model::geo;
  std::vector<int> loops{geo::addCurveLoop(outer), geo::addCurveLoop(inner)};
  loops.insert(loops.end(), row.loops.begin(), row.loops.end());
  const int surface = geo::addPlaneSurface(loops);
  geo::mesh::setRecombine(2, surface);
  return {std::move(inner), std::move(outer), std::move(row), surface};
}

// A ring and the layers in it swept through the slice: volumes, the planes on both sides, and all other faces.
struct Slice {
  std::vector<int> volumes, planes, sides;

  std::vector<int> over(const std::vector<int>& curves) const {
    std::vector<int> faces;
    for (const int side : sides) {
      DimTags boundary;
      gmsh::model::getBoundary({{2, side}}, boundary, false, false, false);
      if (std::ranges::any_of(boundary,
                              [&](const auto& curve) { return std::ranges::find(curves, std::abs(curve.second)) != curves.end(); }))
        faces.push_back(side);
    }
    return faces;
  }
};

Slice slice_of(const Ring& ring, double thickness) {
  Slice slice;
  slice.planes = ring.row.layers;
  slice.planes.push_back(ring.surface);
  DimTags swept;
  gmsh::model::geo::extrude(with_dimension(2, slice.planes), 0, 0, thickness, swept, {1}, {}, true);
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const bool is_top = i + 1 < swept.size() && swept[i + 1].first == 3;  // the volume follows the plane at its end
    (swept[i].first == 3 ? slice.volumes : is_top ? slice.planes : slice.sides).push_back(swept[i].second);
  }
  return slice;
}

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
  const auto bends = bends_of(points);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double room = depth(size) * spoke(bends[i]);
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

Expectation BladeRows::build(double attempt_factor) {
  const double size_factor = attempt_factor * size;
  const auto blade = outline(blade_radius, blade_angle, inlet_radius, sliding_radius, "blade"),
             vane = outline(vane_radius, vane_angle, sliding_radius, outlet_radius, "vane");
  const Layers frame{layers, layer_growth, depth(size_factor)};
  const auto row = [&](const std::vector<Plane>& points, int count) {
    return row_of(points, count, pieces_of(points, bends_of(points), size_factor * edge_size, size_factor * wall_size), frame);
  };
  const std::array<Ring, 2> rings{ring_of(circle(inlet_radius, 0), circle(sliding_radius, 0.3), row(blade, blades)),
                                  ring_of(circle(sliding_radius, 0), circle(outlet_radius, 0), row(vane, vanes))};
  const Slice turning = slice_of(rings[0], thickness), fixed = slice_of(rings[1], thickness);
  gmsh::model::geo::synchronize();
  remove_helper_points();
  name_group(3, rotor, "rotor", turning.volumes);
  name_group(3, stator, "stator", fixed.volumes);
  name_group(2, inlet, "inlet", turning.over(rings[0].inner));
  name_group(2, outlet, "outlet", fixed.over(rings[1].outer));
  name_group(2, impeller_walls, "impeller_walls", turning.over(rings[0].row.walls));
  name_group(2, vane_walls, "vane_walls", fixed.over(rings[1].row.walls));
  name_group(2, interface_rotor, "interface_rotor", turning.over(rings[0].outer));
  name_group(2, interface_stator, "interface_stator", fixed.over(rings[1].inner));
  auto both = turning.planes;
  both.insert(both.end(), fixed.planes.begin(), fixed.planes.end());
  name_group(2, planes, "planes", both);
  size_mesh(rings, size_factor);

  const auto volume = [&](double from, double to, int count, const Ring& ring) {
    return thickness * (pi * (to * to - from * from) - count * ring.row.area);
  };
  Expectation expectation;
  expectation.volumes = {{"rotor", 1, volume(inlet_radius, sliding_radius, blades, rings[0])},
                         {"stator", 1, volume(sliding_radius, outlet_radius, vanes, rings[1])}};
  expectation.equal_areas = {{"interface_rotor", "interface_stator"}};
  return expectation;
}

const bool registered = geometries().add<BladeRows>();

}  // namespace
}  // namespace snag::generate
