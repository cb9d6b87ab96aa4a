// Rectangular channel: x along the flow, y from bottom to top, z across; walls at y, and at z unless the channel is periodic there.
//   hexahedra    cell heights follow geometric series from the walls, the largest cell wall_ratio times the smallest
//   tetrahedra   edge length size at the walls y, growing to wall_ratio times that in the middle
// Periodic sides are patches periodic_x0, periodic_x1, periodic_z0, periodic_z1 whose nodes match.
#include <spdlog/fmt/fmt.h>

#include "mesh/generate/block.hpp"

namespace snag::generate {

namespace {

struct Channel final : Geometry {
  static constexpr const char* name = "channel";
  double length = 0.6, height = 0.1, width = 0.1;
  int cells_x = 60, cells_y = 20, cells_z = 20;
  double size = 0.01, wall_ratio = 2;
  bool periodic_x = false, periodic_z = false, grade_sides = false;
  std::string cells = "hexahedra";

  std::string meaning() const override { return "Rectangular channel; patches inlet, outlet, bottom, top, side_z0, side_z1."; }

  std::vector<Parameter> parameters() override {
    using enum Basis;
    return {{"length", &length, "m", 1e-4, 1e3, assumed, "Length along x, from x = 0."},
            {"height", &height, "m", 1e-4, 1e3, assumed, "Height along y, from y = 0."},
            {"width", &width, "m", 1e-4, 1e3, assumed, "Width along z, from z = 0."},
            setting("cells", &cells, "Kind of cells.", {"hexahedra", "tetrahedra"}),
            {"cells_x", &cells_x, "1", 1, 1e5, assumed, "Hexahedra along x."},
            {"cells_y", &cells_y, "1", 1, 1e5, assumed, "Hexahedra along y."},
            {"cells_z", &cells_z, "1", 1, 1e5, assumed, "Hexahedra along z."},
            {"size", &size, "m", 1e-5, 1e2, assumed, "Tetrahedra: edge length at bottom and top."},
            {"wall_ratio", &wall_ratio, "1", 1, 1000, assumed, "Size in the middle over size at bottom and top; 1: uniform."},
            setting("grade_sides", &grade_sides, "Hexahedra: the same grading from the side walls."),
            setting("periodic_x", &periodic_x, "Patches periodic_x0 and periodic_x1 instead of inlet and outlet."),
            setting("periodic_z", &periodic_z, "Patches periodic_z0 and periodic_z1 instead of side_z0 and side_z1.")};
  }

  Expectation build(double size_factor) override {
    Block block;
    block.upper = {length, height, width};
    block.patches[0] = {periodic_x ? "periodic_x0" : "inlet", periodic_x ? "periodic_x1" : "outlet"};
    block.patches[1] = {"bottom", "top"};
    block.patches[2] = {periodic_z ? "periodic_z0" : "side_z0", periodic_z ? "periodic_z1" : "side_z1"};
    block.periodic = {periodic_x, false, periodic_z};
    if (cells == "tetrahedra") {
      const double h = size * size_factor, slope = (wall_ratio - 1) * h / (height / 2);
      return tetrahedra(block, fmt::format("{} + {} * ({} - Fabs(y - {}))", h, slope, height / 2, height / 2));
    }
    block.positions = {graded(cells_x, 1, false), graded(cells_y, wall_ratio, true),
                       graded(cells_z, grade_sides && !periodic_z ? wall_ratio : 1, true)};
    return hexahedra(block);
  }
};

const bool registered = geometries().add<Channel>();

}  // namespace
}  // namespace snag::generate
