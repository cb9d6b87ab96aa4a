#pragma once
// Round pipe, straight or with a bend upstream of its main leg, as tetrahedra or swept from a cross-section.
//   main leg       along +x from the origin; y up
//   bend           about the line x = 0, y = -bend_radius, through bend_angle, before the main leg
//   upstream leg   before the bend; with 90 degrees it rises along +y
#include "base/vec3.hpp"

namespace snag::generate {

struct PipeShape {
  double diameter = 0.2, length = 3;                // m
  double bend_angle = 0;                            // rad; 0: straight, no upstream leg
  double bend_radius = 0.3, upstream_length = 0.4;  // m

  double radius() const { return diameter / 2; }
  bool is_bent() const { return bend_angle > 0; }
  /// Direction of the flow in the upstream leg.
  Vec3 upstream_direction() const;
  double volume() const;  // m3
};

/// The cross-section of a swept pipe: a core of triangles within layers of quadrangles.
struct PipeSection {
  int n_around = 40;  // cells around the wall, a multiple of 4
  int n_layers = 10;
  double first_layer = 0.001;      // m, thickness at the wall
  double layer_growth = 1.3;       // ratio of neighbouring layers
  double axial_size = 0.04;        // m
  double layer_thickness() const;  // m, of all layers
};

}  // namespace snag::generate
