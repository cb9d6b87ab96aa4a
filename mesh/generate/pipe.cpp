#include "mesh/generate/pipe.hpp"

#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/generate/cad.hpp"
#include "mesh/generate/geometry.hpp"
#include "mesh/generate/sizes.hpp"

namespace snag::generate {

namespace {

constexpr double pi = std::numbers::pi;
enum Surface { inlet = 11, outlet, walls };

/// Faces at the pipe's ends and the volumes between; the walls are what else bounds the volumes.
struct Swept {
  std::vector<int> volumes, inlet, outlet;
};

struct Pipe final : Geometry {
  static constexpr const char* name = "pipe";
  PipeShape shape;
  PipeSection section;
  std::string cells = "tetrahedra";
  double wall_size = 0.016, core_size = 0.025;

  std::string meaning() const override { return "Round pipe, straight or with a bend before it; patches inlet, outlet, walls."; }

  std::vector<Parameter> parameters() override {
    using enum Basis;
    return {{"diameter", &shape.diameter, "m", 1e-3, 10, assumed, "Inner diameter."},
            {"length", &shape.length, "m", 1e-3, 1000, assumed, "Length of the main leg, along +x from x = 0."},
            {"bend_angle", &shape.bend_angle, "rad", 0, pi, assumed, "Angle of the bend before the main leg; 0: a straight pipe."},
            {"bend_radius", &shape.bend_radius, "m", 1e-3, 100, assumed, "Radius of the bend's centre line."},
            {"upstream_length", &shape.upstream_length, "m", 1e-3, 1000, assumed, "Straight leg before the bend."},
            setting("cells", &cells, "Tetrahedra, or hexahedra at the wall and prisms in the core.", {"tetrahedra", "swept"}),
            {"wall_size", &wall_size, "m", 1e-4, 10, assumed, "Tetrahedra: edge length at the wall."},
            {"core_size", &core_size, "m", 1e-4, 10, assumed, "Tetrahedra: edge length on the axis."},
            {"n_around", &section.n_around, "1", 8, 1000, assumed, "Swept: cells around the wall, a multiple of 4."},
            {"n_layers", &section.n_layers, "1", 1, 100, assumed, "Swept: layers of hexahedra at the wall."},
            {"first_layer", &section.first_layer, "m", 1e-6, 1, assumed, "Swept: thickness of the layer at the wall."},
            {"layer_growth", &section.layer_growth, "1", 1, 3, assumed, "Swept: ratio of neighbouring layers."},
            {"axial_size", &section.axial_size, "m", 1e-4, 10, assumed, "Swept: length of the cells."}};
  }

  Expectation build(double size_factor) override;

 private:
  void check() const;
  Swept solid() const;
  Swept layers() const;
  std::vector<int> cross_section() const;
};

void Pipe::check() const {
  const auto require = [](bool rule, const std::string& message) {
    if (!rule) throw Error(ExitCode::usage, "[pipe]: " + message);
  };
  require(!shape.is_bent() || shape.bend_radius > 1.02 * shape.radius(),
          fmt::format("bend_radius ({:g} m), must exceed the pipe's radius ({:g} m); enlarge it", shape.bend_radius, shape.radius()));
  if (cells != "swept") return;
  require(section.n_around % 4 == 0, fmt::format("n_around ({}), must be a multiple of 4; round it", section.n_around));
  require(
      section.layer_thickness() < 0.8 * shape.radius(),
      fmt::format("all layers together ({:g} m), must be below 0.8 of the radius ({:g} m); reduce n_layers, first_layer or layer_growth",
                  section.layer_thickness(), shape.radius()));
}

// A disc at the origin, swept both ways.
Swept Pipe::solid() const {
  namespace occ = gmsh::model::occ;
  const int disc = occ::addDisk(0, 0, 0, shape.radius(), shape.radius());
  occ::rotate({{2, disc}}, 0, 0, 0, 0, 1, 0, pi / 2);
  DimTags main;
  occ::extrude({{2, disc}}, shape.length, 0, 0, main);
  std::vector<int> parts{main.at(1).second};
  if (shape.is_bent()) {
    DimTags bend, upstream;
    occ::revolve({{2, disc}}, 0, -shape.bend_radius, 0, 0, 0, 1, shape.bend_angle, bend);
    const Vec3 way = -shape.upstream_length * shape.upstream_direction();
    occ::extrude({bend.at(0)}, way.x, way.y, way.z, upstream);
    parts.push_back(bend.at(1).second);
    parts.push_back(upstream.at(1).second);
  }
  Swept result{fused(parts), {}, {}};
  remove_helpers();
  for (const Face& face : faces_of(result.volumes)) {
    if (face.type != "Plane") continue;
    (face.lies_at(0, shape.length) ? result.outlet : result.inlet).push_back(face.tag);
  }
  return result;
}

// The cross-section at the origin in the plane x = 0: four sectors of layers about a core.
std::vector<int> Pipe::cross_section() const {
  namespace geo = gmsh::model::geo;
  const int n_quarter = section.n_around / 4, centre = geo::addPoint(0, 0, 0);
  const auto ring = [&](double radius) {
    std::vector<int> points;
    for (int k = 0; k < 4; ++k)
      points.push_back(geo::addPoint(0, radius * std::cos(pi / 4 + k * pi / 2), radius * std::sin(pi / 4 + k * pi / 2)));
    return points;
  };
  const auto arcs = [&](const std::vector<int>& points) {
    std::vector<int> curves;
    for (std::size_t k = 0; k < 4; ++k) {
      curves.push_back(geo::addCircleArc(points[k], centre, points[(k + 1) % 4]));
      geo::mesh::setTransfiniteCurve(curves.back(), n_quarter + 1);
    }
    return curves;
  };
  const auto inner = ring(shape.radius() - section.layer_thickness()), outer = ring(shape.radius());
  const auto inner_arc = arcs(inner), outer_arc = arcs(outer);
  std::vector<int> spokes;
  for (std::size_t k = 0; k < 4; ++k) {
    spokes.push_back(geo::addLine(outer[k], inner[k]));
    geo::mesh::setTransfiniteCurve(spokes.back(), section.n_layers + 1, "Progression", section.layer_growth);
  }
  std::vector<int> surfaces{geo::addPlaneSurface({geo::addCurveLoop(inner_arc)})};
  for (std::size_t k = 0; k < 4; ++k) {
    surfaces.push_back(geo::addPlaneSurface({geo::addCurveLoop({outer_arc[k], spokes[(k + 1) % 4], -inner_arc[k], -spokes[k]})}));
    geo::mesh::setTransfiniteSurface(surfaces.back());
    geo::mesh::setRecombine(2, surfaces.back());
  }
  return surfaces;
}

// What an extrusion leads to: each volume in its list follows the face at its far end.
std::vector<int> far_faces(const DimTags& swept, std::vector<int>& volumes) {
  std::vector<int> ends;
  for (std::size_t i = 1; i < swept.size(); ++i) {
    if (swept[i].first != 3) continue;
    volumes.push_back(swept[i].second);
    ends.push_back(swept[i - 1].second);
  }
  return ends;
}

Swept Pipe::layers() const {
  namespace geo = gmsh::model::geo;
  const auto count = [&](double length) {
    return std::vector<int>{std::max(1, static_cast<int>(std::lround(length / section.axial_size)))};
  };
  const auto base = cross_section();
  Swept result{{}, base, {}};
  DimTags main;
  geo::extrude(with_dimension(2, base), shape.length, 0, 0, main, count(shape.length), {}, true);
  result.outlet = far_faces(main, result.volumes);
  if (shape.is_bent()) {
    DimTags bend, upstream;
    geo::revolve(with_dimension(2, base), 0, -shape.bend_radius, 0, 0, 0, 1, shape.bend_angle, bend,
                 count(shape.bend_angle * shape.bend_radius), {}, true);
    const auto joint = far_faces(bend, result.volumes);
    const Vec3 way = -shape.upstream_length * shape.upstream_direction();
    geo::extrude(with_dimension(2, joint), way.x, way.y, way.z, upstream, count(shape.upstream_length), {}, true);
    result.inlet = far_faces(upstream, result.volumes);
  }
  geo::synchronize();
  remove_helper_points();
  return result;
}

Expectation Pipe::build(double size_factor) {
  check();
  const bool swept = cells == "swept";
  const Swept pipe = swept ? layers() : solid();
  DimTags boundary;
  gmsh::model::getBoundary(with_dimension(3, pipe.volumes), boundary, true, false, false);
  std::set<int> sides;
  for (const auto& [dimension, tag] : boundary) sides.insert(std::abs(tag));
  for (const int tag : pipe.inlet) sides.erase(tag);
  for (const int tag : pipe.outlet) sides.erase(tag);
  name_group(3, 1, "fluid", pipe.volumes);
  name_group(2, inlet, "inlet", pipe.inlet);
  name_group(2, outlet, "outlet", pipe.outlet);
  name_group(2, walls, "walls", {sides.begin(), sides.end()});

  SizeField field;
  if (swept) {
    const double core_radius = shape.radius() - section.layer_thickness();
    field.formula(fmt::format("{}", size_factor * 2 * pi * core_radius / section.n_around));
  } else {
    field.around({sides.begin(), sides.end()}, {size_factor * wall_size, size_factor * core_size, 0, shape.radius()}, true);
  }
  field.apply();
  Expectation expectation;
  expectation.volumes = {{"fluid", 1, shape.volume()}};
  return expectation;
}

const bool registered = geometries().add<Pipe>();

}  // namespace

Vec3 PipeShape::upstream_direction() const { return {std::cos(bend_angle), std::sin(bend_angle), 0}; }

double PipeShape::volume() const {
  return pi * radius() * radius() * (length + (is_bent() ? bend_angle * bend_radius + upstream_length : 0));
}

double PipeSection::layer_thickness() const {
  return layer_growth == 1 ? first_layer * n_layers : first_layer * (std::pow(layer_growth, n_layers) - 1) / (layer_growth - 1);
}

}  // namespace snag::generate
