#include "mesh/generate/cad.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"

namespace snag::generate {

namespace {
constexpr double place_tolerance = 1e-5;  // m; boxes of OpenCASCADE are wider than the shape by about 1e-7
}

std::vector<int> tags(const DimTags& entities) {
  std::vector<int> result;
  for (const auto& [dimension, tag] : entities) result.push_back(tag);
  return result;
}

DimTags with_dimension(int dimension, const std::vector<int>& entity_tags) {
  DimTags result;
  for (const int tag : entity_tags) result.emplace_back(dimension, tag);
  return result;
}

bool Face::lies_at(int axis, double position) const { return spans(axis, position, position); }

bool Face::spans(int axis, double from, double to) const {
  return std::abs(lower[axis] - from) < place_tolerance && std::abs(upper[axis] - to) < place_tolerance;
}

std::vector<Face> faces_of(const std::vector<int>& volumes) {
  DimTags boundary;
  gmsh::model::getBoundary(with_dimension(3, volumes), boundary, false, false, false);
  std::set<int> unique;
  for (const auto& [dimension, tag] : boundary) unique.insert(std::abs(tag));
  std::vector<Face> faces;
  for (const int tag : unique) {
    Face face;
    face.tag = tag;
    gmsh::model::getType(2, tag, face.type);
    gmsh::model::occ::getMass(2, tag, face.area);
    gmsh::model::getBoundingBox(2, tag, face.lower.x, face.lower.y, face.lower.z, face.upper.x, face.upper.y, face.upper.z);
    faces.push_back(face);
  }
  return faces;
}

double volume_of(const std::vector<int>& volumes) {
  double sum = 0;
  for (const int tag : volumes) {
    double volume = 0;
    gmsh::model::occ::getMass(3, tag, volume);
    sum += volume;
  }
  return sum;
}

void remove_helpers() {
  gmsh::model::occ::synchronize();
  DimTags kept;
  gmsh::model::getEntities(kept, 3);
  for (int dimension = 2; dimension >= 0; --dimension) {
    DimTags boundary, all, helpers;
    gmsh::model::getBoundary(kept, boundary, false, false, false);
    const auto bounding = tags(boundary);
    const std::set<int> needed(bounding.begin(), bounding.end());
    gmsh::model::getEntities(all, dimension);
    kept.clear();
    for (const auto& entity : all) (needed.contains(entity.second) ? kept : helpers).push_back(entity);
    if (!helpers.empty()) gmsh::model::occ::remove(helpers);
    gmsh::model::occ::synchronize();
  }
}

void remove_helper_points() {
  DimTags volumes, boundary, points, helpers;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getBoundary(volumes, boundary, false, false, true);
  gmsh::model::getEntities(points, 0);
  const auto bounding = tags(boundary);
  const std::set<int> needed(bounding.begin(), bounding.end());
  for (const auto& point : points)
    if (!needed.contains(point.second)) helpers.push_back(point);
  gmsh::model::removeEntities(helpers);
}

void name_group(int dimension, int tag, const std::string& name, const std::vector<int>& entities) {
  if (entities.empty()) {
    throw Error(ExitCode::mesh, "snag-mesh: no face or volume was recognised as \"" + name +
                                    "\" (0 entities), every named part must exist; change the last parameter set, two parts may coincide");
  }
  gmsh::model::addPhysicalGroup(dimension, entities, tag);
  gmsh::model::setPhysicalName(dimension, tag, name);
}

int cylinder(Vec3 base, Vec3 axis, double radius) {
  return gmsh::model::occ::addCylinder(base.x, base.y, base.z, axis.x, axis.y, axis.z, radius);
}

std::vector<int> fused(const std::vector<int>& volumes) {
  if (volumes.size() < 2) return volumes;
  DimTags result;
  std::vector<DimTags> origin;
  gmsh::model::occ::fuse({{3, volumes.front()}}, with_dimension(3, {volumes.begin() + 1, volumes.end()}), result, origin);
  return tags(result);
}

std::vector<int> cut(const std::vector<int>& volumes, const std::vector<int>& tools) {
  DimTags result;
  std::vector<DimTags> origin;
  gmsh::model::occ::cut(with_dimension(3, volumes), with_dimension(3, tools), result, origin);
  return tags(result);
}

}  // namespace snag::generate
