#include "mesh/generate/block.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/words.hpp"
#include "mesh/generate/cad.hpp"
#include "mesh/generate/sizes.hpp"

namespace snag::generate {

namespace {

constexpr int volume_tag = 1, first_surface_tag = 11;

// The volume and its six faces by where they lie; the same for both kernels of gmsh.
Expectation named(const Block& block, int volume) {
  const Vec3 size = block.upper - block.lower;
  name_group(3, volume_tag, "fluid", {volume});
  std::map<std::string, std::vector<int>> faces;
  std::vector<std::string> order;
  DimTags boundary;
  gmsh::model::getBoundary({{3, volume}}, boundary, false, false, false);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const double place = side ? block.upper[axis] : block.lower[axis];
      const auto& name = block.patches[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
      for (const auto& [dimension, tag] : boundary) {
        Vec3 low, high;
        gmsh::model::getBoundingBox(2, tag, low.x, low.y, low.z, high.x, high.y, high.z);
        const double tolerance = 1e-3 * size[axis];
        if (std::abs(low[axis] - place) > tolerance || std::abs(high[axis] - place) > tolerance) continue;
        if (faces[name].empty()) order.push_back(name);
        faces[name].push_back(tag);
      }
    }
  }
  int tag = first_surface_tag;
  for (const auto& name : order) name_group(2, tag++, name, faces[name]);

  Expectation expectation;
  expectation.volumes = {{"fluid", 1, size.x * size.y * size.z}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto& [low, high] = block.patches[static_cast<std::size_t>(axis)];
    Vec3 translation;
    translation[axis] = size[axis];
    if (block.periodic[static_cast<std::size_t>(axis)]) expectation.periodic.push_back({low, high, translation});
  }
  return expectation;
}

int face_at(int volume, int axis, double place) {
  for (const Face& face : faces_of({volume}))
    if (face.lies_at(axis, place)) return face.tag;
  throw Error(ExitCode::mesh, "snag-mesh: a block has no face at " + number_text(place) + " m; make the block longer than 0.1 mm");
}

}  // namespace

std::vector<double> graded(int n, double ratio, bool both_ends) {
  std::vector<double> size(static_cast<std::size_t>(n));
  const int span = both_ends ? (n + 1) / 2 : n;  // cells from the smallest to the largest
  for (int k = 0; k < n; ++k) {
    const int from_end = both_ends ? std::min(k, n - 1 - k) : k;
    size[static_cast<std::size_t>(k)] = span > 1 ? std::pow(ratio, static_cast<double>(from_end) / (span - 1)) : 1;
  }
  std::vector<double> positions;
  double sum = 0, reached = 0;
  for (const double s : size) sum += s;
  for (const double s : size) positions.push_back((reached += s) / sum);
  positions.back() = 1;
  return positions;
}

Expectation hexahedra(const Block& block) {
  namespace geo = gmsh::model::geo;
  DimTags base = {{0, geo::addPoint(block.lower.x, block.lower.y, block.lower.z)}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto& positions = block.positions[static_cast<std::size_t>(axis)];
    Vec3 way;
    way[axis] = block.upper[axis] - block.lower[axis];
    DimTags swept;
    geo::extrude(base, way.x, way.y, way.z, swept, std::vector<int>(positions.size(), 1), positions, true);
    base.clear();
    for (const auto& entity : swept)
      if (entity.first == axis + 1) base.push_back(entity);
  }
  geo::synchronize();
  return named(block, base.at(0).second);
}

Expectation tetrahedra(const Block& block, const std::string& size) {
  const Vec3 d = block.upper - block.lower;
  const int volume = gmsh::model::occ::addBox(block.lower.x, block.lower.y, block.lower.z, d.x, d.y, d.z);
  gmsh::model::occ::synchronize();
  for (int axis = 0; axis < 3; ++axis) {
    if (!block.periodic[static_cast<std::size_t>(axis)]) continue;
    Vec3 way;
    way[axis] = d[axis];
    const std::vector<double> shift = {1, 0, 0, way.x, 0, 1, 0, way.y, 0, 0, 1, way.z, 0, 0, 0, 1};
    gmsh::model::mesh::setPeriodic(2, {face_at(volume, axis, block.upper[axis])}, {face_at(volume, axis, block.lower[axis])}, shift);
  }
  SizeField field;
  field.formula(size);
  field.apply();
  return named(block, volume);
}

}  // namespace snag::generate
