#pragma once
// Short forms of what every geometry asks of the CAD kernel (OpenCASCADE inside gmsh). Lengths in metres.
#include <string>
#include <utility>
#include <vector>

#include "base/vec3.hpp"

namespace snag::generate {

using DimTags = std::vector<std::pair<int, int>>;  // (dimension, tag) pairs, as gmsh has them

/// Tags of a list of one dimension.
std::vector<int> tags(const DimTags& entities);
DimTags with_dimension(int dimension, const std::vector<int>& entity_tags);

/// What classifies a face of a solid.
struct Face {
  int tag = 0;
  std::string type;                                    // of gmsh: "Plane", "Cylinder", ...
  double area = 0;                                     // m2
  Vec3 lower, upper;                                   // bounding box, m; wider than the face by a rounding
  bool lies_at(int axis, double position) const;       // the whole face within 1e-5 m of this plane
  bool spans(int axis, double from, double to) const;  // its box has these ends within 1e-5 m
};

/// Faces of volumes, in order of their tags; a synchronised model is asked.
std::vector<Face> faces_of(const std::vector<int>& volumes);
double volume_of(const std::vector<int>& volumes);

/// Remove every face, curve and point that bounds no volume (helper points, wires of lofts), and synchronise.
void remove_helpers();
/// The same for the points of gmsh's own kernel (centres of arcs); to be called after synchronising.
void remove_helper_points();

/// A physical group with tag and name. Throws Error(mesh) if no entity is in it: a surface was not recognised.
void name_group(int dimension, int tag, const std::string& name, const std::vector<int>& entities);

/// A cylinder about a line parallel to `axis`.
int cylinder(Vec3 base, Vec3 axis, double radius);

/// The solid that results from a boolean operation on volumes.
std::vector<int> fused(const std::vector<int>& volumes);
std::vector<int> cut(const std::vector<int>& volumes, const std::vector<int>& tools);

}  // namespace snag::generate
