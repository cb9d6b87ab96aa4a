#pragma once
// The plane of blade rows in gmsh's own kernel: outlines of blades in frames of layers of quadrangles, and the rings between circles around
// them. An outline is a closed polygon with a smooth curve (spline) through its points between corners, which are points where it turns by
// more than corner_turn. The layers are cut along the line that halves a corner.
#include <array>
#include <vector>

namespace snag::generate {

using Plane = std::array<double, 2>;  // x, y

struct Layers {
  int count;
  double growth, depth;  // ratio of neighbours; m, all together
};

// Blades: surfaces of their layers, curves of the walls and around the layers, loops of both, points at corners of the latter.
struct Row {
  std::vector<int> layers, walls, frames, wall_loops, loops, corners;
  double area = 0;  // m2, of one blade
};

struct Ring {
  std::vector<int> inner, outer;  // arcs
  Row row;
  int surface = 0;
};

/// Room that the layers take at each point of an outline, m.
std::vector<double> rooms_of(const std::vector<Plane>& outline, double depth);
/// `count` copies of the outline about the axis, each in a frame of layers; edges of edge_size at corners to wall_size along the sides, m.
Row row_of(const std::vector<Plane>& outline, int count, double edge_size, double wall_size, const Layers& layers);
/// A circle in four arcs, from the angle `start` on.
std::vector<int> circle(double radius, double start);
Ring ring_of(std::vector<int> inner, std::vector<int> outer, Row row);

}  // namespace snag::generate
