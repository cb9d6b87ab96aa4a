#include "simulation/setup/case_reynolds.hpp"

#include <cmath>
#include <numbers>

#include "mesh/bounding_box.hpp"
#include "mesh/geometry.hpp"
#include "parallel/sum.hpp"
#include "solver/monitors.hpp"

namespace snag {

namespace {

constexpr double least_body = 1e-4;    // volume of a body over the power 3/2 of its surface; 0.09 for a sphere
constexpr double whole_extent = 0.99;  // of the mesh

struct Width {
  double length = 0;  // m
  std::string of;
};

/// The flow is around the walls, not between them: the walls enclose a volume without water,  1/3 sum (x_f - x_m).S < 0. Vanes of a rotor
/// do that too where the casing is farther from their middle than they are, but a ring of vanes is no body.
bool is_external(const Simulation& simulation) {
  if (simulation.water->flow.rotating_zone) return false;
  const Mesh& mesh = *simulation.mesh;
  const BoundarySet& boundary = simulation.water->boundary();
  Vec3 moment, vector;  // sum |S| x_f, m3; sum S, m2
  double area = 0, volume = 0;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end() && boundary.is_wall(p); ++f) {
      const double magnitude = norm(mesh.face_vector[f]);
      moment += magnitude * mesh.face_centre[f], vector += mesh.face_vector[f], area += magnitude;
      volume += dot(mesh.face_centre[f], mesh.face_vector[f]) / 3;
    }
  area = sum(mesh.comm, area);
  if (area == 0) return false;
  const Vec3 mean = sum(mesh.comm, std::span<const Vec3>(&moment, 1)) / area;
  volume = sum(mesh.comm, volume) - dot(mean, sum(mesh.comm, std::span<const Vec3>(&vector, 1))) / 3;
  return volume < -least_body * std::pow(area, 1.5);
}

/// Of the widest wall patch: its largest extent along an axis in which it does not reach through the whole mesh, as a cylinder between two
/// planes of symmetry does.
Width body_width(const Simulation& simulation) {
  const Mesh& mesh = *simulation.mesh;
  const Vec3 domain = bounding_box(mesh).size();
  Width widest;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p) {
    if (!simulation.water->boundary().is_wall(p)) continue;
    const Patch& patch = mesh.patches[p];
    std::vector<Vec3> nodes;
    for (int f = patch.first; f < patch.end(); ++f)
      for (const int node : row(mesh.face_node_start, mesh.face_node, f)) nodes.push_back(mesh.node[node]);
    const Vec3 size = bounding_box(mesh.comm, nodes).size();
    for (int axis = 0; axis < 3; ++axis)
      if (size[axis] < whole_extent * domain[axis] && size[axis] > widest.length) widest = {size[axis], "body " + patch.name};
  }
  return widest;
}

/// Of the widest patch that water passes.
Width opening_width(const Simulation& simulation) {
  const Mesh& mesh = *simulation.mesh;
  Width widest;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p) {
    if (!simulation.water->boundary().is_open(p)) continue;
    const double width = std::sqrt(4 * patch_area(simulation.water->flow, p) / std::numbers::pi);
    if (width > widest.length) widest = {width, "patch " + mesh.patches[p].name};
  }
  return widest;
}

}  // namespace

std::optional<CaseReynolds> case_reynolds(const Simulation& simulation) {
  const Width width = is_external(simulation) ? body_width(simulation) : opening_width(simulation);
  if (width.length == 0) return {};
  const Flow& flow = simulation.water->flow;
  return CaseReynolds{simulation.water->watch().speed() * width.length * flow.density / flow.dynamic_viscosity, width.length, width.of};
}

}  // namespace snag
