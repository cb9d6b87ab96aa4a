#include "mesh/generate/sizes.hpp"

#include <gmsh.h>

#include <cmath>
#include <map>

#include "mesh/generate/cad.hpp"

namespace snag::generate {

namespace {

// gmsh samples a face on a parametric grid of n x n points; half the outline stands for its longer side. Points may be 1.7 sizes
// apart: sizes grow slowly. Few different n, so that many faces can share one field: the search for the nearest point is what costs.
int samples(int face, double size) {
  DimTags curves;
  gmsh::model::getBoundary({{2, face}}, curves, false, false, false);
  double outline = 0;
  for (const auto& [dimension, tag] : curves) {
    double length = 0;
    gmsh::model::occ::getMass(1, std::abs(tag), length);
    outline += length;
  }
  const double wanted = 0.5 * outline / (1.7 * size);
  int n = 8;
  while (n < wanted && n < 512) n *= 2;
  return n;
}

}  // namespace

void SizeField::around(const std::vector<int>& faces, const Growth& growth, bool background) {
  namespace field = gmsh::model::mesh::field;
  std::map<int, std::vector<double>> by_samples;
  for (const int face : faces) by_samples[samples(face, growth.near)].push_back(face);
  for (const auto& [n, group] : by_samples) {
    const int distance = field::add("Distance");
    field::setNumbers(distance, "SurfacesList", group);
    field::setNumber(distance, "NumPointsPerCurve", n);
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
