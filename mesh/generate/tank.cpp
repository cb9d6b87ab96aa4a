// Tank with a pipe at its bottom or at the side x1 through which it empties; the water surface (+y) is the inlet.
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <numbers>

#include "mesh/generate/cad.hpp"
#include "mesh/generate/geometry.hpp"
#include "mesh/generate/sizes.hpp"

namespace snag::generate {

namespace {

enum Surface { inlet = 11, outlet, tank_walls, pipe_walls };

struct Tank final : Geometry {
  static constexpr const char* name = "tank";
  double length = 0.6, depth = 0.5, width = 0.4;
  double pipe_diameter = 0.1, pipe_length = 0.3, outlet_x = 0.3, outlet_y = 0.15, outlet_z = 0.2;
  double pipe_size = 0.012, tank_size = 0.05;
  std::string outlet_at = "bottom";

  std::string meaning() const override {
    return "Tank that empties through a pipe; patches inlet (surface), outlet, tank_walls, pipe_walls.";
  }

  std::vector<Parameter> parameters() override {
    using enum Basis;
    return {{"length", &length, "m", 0.01, 100, assumed, "Length along x, from x = 0."},
            {"depth", &depth, "m", 0.01, 100, assumed, "From the floor y = 0 to the water surface."},
            {"width", &width, "m", 0.01, 100, assumed, "Width along z, from z = 0."},
            setting("outlet_at", &outlet_at, "Wall with the pipe: the floor, or the side x = length.", {"bottom", "side"}),
            {"outlet_x", &outlet_x, "m", 0, 100, assumed, "Pipe's axis at the bottom: x."},
            {"outlet_y", &outlet_y, "m", 0, 100, assumed, "Pipe's axis at the side: y."},
            {"outlet_z", &outlet_z, "m", 0, 100, assumed, "Pipe's axis: z."},
            {"pipe_diameter", &pipe_diameter, "m", 0.005, 10, assumed, "Diameter of the pipe."},
            {"pipe_length", &pipe_length, "m", 0.005, 100, assumed, "Length of the pipe."},
            {"pipe_size", &pipe_size, "m", 1e-4, 10, assumed, "Edge length at the pipe."},
            {"tank_size", &tank_size, "m", 1e-4, 10, assumed, "Edge length in the tank."}};
  }

  Expectation build(double size_factor) override;
};

Expectation Tank::build(double size_factor) {
  const bool at_bottom = outlet_at == "bottom";
  const double r = pipe_diameter / 2, along = at_bottom ? outlet_x : outlet_y, extent = at_bottom ? length : depth;
  if (along - r <= 0 || along + r >= extent || outlet_z - r <= 0 || outlet_z + r >= width)
    throw Error(ExitCode::usage,
                fmt::format("[tank]: the pipe's opening (axis at {:g} m and {:g} m, radius {:g} m), must lie within its wall; "
                            "change outlet_x, outlet_y, outlet_z or pipe_diameter",
                            along, outlet_z, r));
  const Vec3 way = at_bottom ? Vec3{0, -pipe_length, 0} : Vec3{pipe_length, 0, 0};
  const Vec3 mouth = at_bottom ? Vec3{outlet_x, 0, outlet_z} : Vec3{length, outlet_y, outlet_z};
  const auto water = fused({gmsh::model::occ::addBox(0, 0, 0, length, depth, width), cylinder(mouth, way, r)});
  remove_helpers();

  std::map<Surface, std::vector<int>> faces;
  for (const Face& face : faces_of(water)) {
    const bool is_end = at_bottom ? face.lies_at(1, -pipe_length) : face.lies_at(0, length + pipe_length);
    const Surface surface = face.lies_at(1, depth) ? inlet : is_end ? outlet : face.type == "Cylinder" ? pipe_walls : tank_walls;
    faces[surface].push_back(face.tag);
  }
  name_group(3, 1, "fluid", water);
  name_group(2, inlet, "inlet", faces[inlet]);
  name_group(2, outlet, "outlet", faces[outlet]);
  name_group(2, tank_walls, "tank_walls", faces[tank_walls]);
  name_group(2, pipe_walls, "pipe_walls", faces[pipe_walls]);

  SizeField field;
  const double h = pipe_size * size_factor, far = tank_size * size_factor;
  field.around(faces[pipe_walls], {h, far, pipe_diameter / 2, pipe_diameter / 2 + 5 * far}, true);
  field.apply();
  Expectation expectation;
  expectation.volumes = {{"fluid", 1, volume_of(water)}};
  return expectation;
}

const bool registered = geometries().add<Tank>();

}  // namespace
}  // namespace snag::generate
