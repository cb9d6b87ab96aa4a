#include "mesh/generate/sizes.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>

#include "mesh/generate/cad.hpp"

namespace snag::generate {

namespace {

// gmsh samples a face on a parametric grid of n x n points; half the outline stands for its longer side.
int samples(int face, double spacing) {
  DimTags curves;
  gmsh::model::getBoundary({{2, face}}, curves, false, false, false);
  double outline = 0;
  for (const auto& [dimension, tag] : curves) {
    double length = 0;
    gmsh::model::occ::getMass(1, std::abs(tag), length);
    outline += length;
  }
  return std::clamp(static_cast<int>(std::ceil(0.5 * outline / spacing)), 8, 400);
}

}  // namespace

void SizeField::around(const std::vector<int>& faces, const Growth& growth, bool background) {
  namespace field = gmsh::model::mesh::field;
  for (const int face : faces) {
    const int distance = field::add("Distance");
    field::setNumbers(distance, "SurfacesList", {static_cast<double>(face)});
    field::setNumber(distance, "NumPointsPerCurve", samples(face, growth.near));
    const int threshold = field::add("Threshold");
    field::setNumber(threshold, "InField", distance);
    field::setNumber(threshold, "SizeMin", growth.near);
    field::setNumber(threshold, "SizeMax", growth.far);
    field::setNumber(threshold, "DistMin", growth.from);
    field::setNumber(threshold, "DistMax", growth.to);
    field::setNumber(threshold, "StopAtDistMax", background ? 0 : 1);
    fields_.push_back(threshold);
  }
}

void SizeField::formula(const std::string& expression) {
  const int tag = gmsh::model::mesh::field::add("MathEval");
  gmsh::model::mesh::field::setString(tag, "F", expression);
  fields_.push_back(tag);
}

void SizeField::apply() const {
  const int minimum = gmsh::model::mesh::field::add("Min");
  gmsh::model::mesh::field::setNumbers(minimum, "FieldsList", fields_);
  gmsh::model::mesh::field::setAsBackgroundMesh(minimum);
  for (const char* source : {"Mesh.MeshSizeFromPoints", "Mesh.MeshSizeFromCurvature", "Mesh.MeshSizeExtendFromBoundary"})
    gmsh::option::setNumber(source, 0);
}

}  // namespace snag::generate
