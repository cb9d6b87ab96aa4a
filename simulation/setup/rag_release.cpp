#include "simulation/setup/rag_release.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "base/error.hpp"
#include "dem/templates/rag_copies.hpp"
#include "parallel/rows.hpp"

namespace snag {

namespace {

/// The faces of a patch on all ranks, in an order that does not depend on how they are spread.
struct PatchFaces {
  std::vector<Vec3> centre;
  std::vector<double> area_up_to;  // sum of the areas of this face and those before, m2
  Vec3 middle, inward;             // inward: unit
};

PatchFaces faces_of(const Mesh& mesh, const std::string& name) {
  const Patch& patch = mesh.patches[mesh.patch_index(name)];
  std::vector<std::array<double, 6>> mine;
  for (int f = patch.first; f < patch.end(); ++f) {
    const Vec3 &x = mesh.face_centre[f], &S = mesh.face_vector[f];
    mine.push_back({x.x, x.y, x.z, S.x, S.y, S.z});
  }
  std::vector<std::array<double, 6>> all = gathered(mesh.comm, mine);
  std::sort(all.begin(), all.end());
  PatchFaces faces;
  double area = 0;
  Vec3 out;
  for (const auto& [x, y, z, Sx, Sy, Sz] : all) {
    const double part = norm(Vec3{Sx, Sy, Sz});
    area += part;
    faces.centre.push_back({x, y, z}), faces.area_up_to.push_back(area);
    faces.middle += part * Vec3{x, y, z}, out += Vec3{Sx, Sy, Sz};
  }
  faces.middle = faces.middle / area;
  faces.inward = unit(-1.0 * out);
  return faces;
}

Vec3 place_of(const ReleasePlan& plan, const PatchFaces& faces) {
  const double area = release_share(plan.seed, plan.index) * faces.area_up_to.back();
  const auto face = std::upper_bound(faces.area_up_to.begin(), faces.area_up_to.end(), area) - faces.area_up_to.begin();
  const Vec3 there = faces.centre[std::min<std::size_t>(static_cast<std::size_t>(face), faces.centre.size() - 1)];
  // Faces are drawn by area, so that spread = 1 is uniform over the patch; a smaller one shrinks that towards the middle.
  return faces.middle + plan.spread * (there - faces.middle) + plan.depth * faces.inward;
}

}  // namespace

void place_at_patches(const Mesh* mesh, std::vector<RagPiece>& pieces) {
  std::map<std::string, PatchFaces> known;
  for (RagPiece& piece : pieces) {
    const ReleasePlan& plan = piece.release;
    if (plan.patch.empty()) continue;
    if (!mesh)
      throw Error(ExitCode::usage, piece.rag.name + ": release_patch = \"" + plan.patch + "\", but the case has no mesh; give centre");
    if (!known.contains(plan.patch)) known.emplace(plan.patch, faces_of(*mesh, plan.patch));
    piece.centre += place_of(plan, known.at(plan.patch));
  }
}

}  // namespace snag
