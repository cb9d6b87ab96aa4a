// Rectangular box with its six sides named: for orders of accuracy, on hexahedra or on unstructured tetrahedra.
#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "mesh/generate/block.hpp"

namespace snag::generate {

namespace {

struct Box final : Geometry {
  static constexpr const char* name = "box";
  Vec3 lower{0, 0, 0}, upper{1, 1, 1};
  double size = 0.1;
  std::string cells = "tetrahedra";

  std::string meaning() const override { return "Box with patches x0, x1, y0, y1, z0, z1; tetrahedra or hexahedra of one size."; }

  std::vector<Parameter> parameters() override {
    using enum Basis;
    return {{"lower", &lower, "m", -1e3, 1e3, assumed, "Lower corner."},
            {"upper", &upper, "m", -1e3, 1e3, assumed, "Upper corner."},
            {"size", &size, "m", 1e-6, 1e3, assumed, "Edge length; hexahedra: rounded so that whole cells fit."},
            setting("cells", &cells, "Kind of cells.", {"tetrahedra", "hexahedra"})};
  }

  Expectation build(double size_factor) override {
    for (int axis = 0; axis < 3; ++axis)
      if (upper[axis] - lower[axis] < size)
        throw Error(ExitCode::usage,
                    fmt::format("[box]: the box is {:g} m wide along axis {}, must hold a cell of {:g} m; change lower, upper or size",
                                upper[axis] - lower[axis], "xyz"[axis], size));
    Block block{lower, upper, {}, {{{"x0", "x1"}, {"y0", "y1"}, {"z0", "z1"}}}, {}};
    if (cells == "tetrahedra") return tetrahedra(block, fmt::format("{}", size * size_factor));
    for (int axis = 0; axis < 3; ++axis)
      block.positions[static_cast<std::size_t>(axis)] = graded(static_cast<int>(std::lround((upper[axis] - lower[axis]) / size)), 1, false);
    return hexahedra(block);
  }
};

const bool registered = geometries().add<Box>();

}  // namespace
}  // namespace snag::generate
