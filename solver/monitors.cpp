// Sums over boundary faces and cells, independent of the number of ranks.
#include "solver/monitors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel/sum.hpp"

namespace snag {

namespace {

/// Sum of a term over the faces of a patch on all ranks. Term: double or Vec3 of (face, boundary face).
template <class Term>
auto patch_sum(const Flow& flow, int patch, const Term& term) {
  const Patch& faces = flow.mesh.patches[static_cast<std::size_t>(patch)];
  std::vector<decltype(term(0, 0))> terms;
  terms.reserve(static_cast<std::size_t>(faces.count));
  for (int f = faces.first; f < faces.end(); ++f) terms.push_back(term(f, f - flow.mesh.n_interior));
  return sum(flow.mesh.comm, std::span<const decltype(term(0, 0))>(terms));
}

}  // namespace

double flow_rate(const Flow& flow, int patch) {
  return patch_sum(flow, patch, [&](int f, int) { return flow.flux[f]; });
}

double patch_area(const Flow& flow, int patch) {
  return patch_sum(flow, patch, [&](int f, int) { return norm(flow.mesh.face_vector[f]); });
}

double mean_pressure(const Flow& flow, int patch) {
  const double area = patch_area(flow, patch);
  const double total = patch_sum(flow, patch, [&](int f, int b) { return norm(flow.mesh.face_vector[f]) * flow.boundary_pressure[b]; });
  return area > 0 ? total / area : 0;
}

FluxMeans flux_means(const Flow& flow, int patch) {
  const double through = patch_sum(flow, patch, [&](int f, int) { return std::abs(flow.flux[f]); });
  if (through == 0) return {};
  const auto mean = [&](const auto& value) {
    return patch_sum(flow, patch, [&](int f, int b) { return std::abs(flow.flux[f]) * value(f, b); }) / through;
  };
  // At the face: along it the velocity of the cell, through it the flux, which is what an inlet gives.
  const auto velocity = [&](int f) {
    const Vec3& S = flow.mesh.face_vector[f];
    const Vec3& u = flow.velocity[flow.mesh.owner[f]];
    return u + (flow.flux[f] - dot(u, S)) / norm_squared(S) * S;
  };
  return {mean([&](int, int b) { return flow.boundary_pressure[b]; }),
          mean([&](int f, int b) { return flow.boundary_pressure[b] + 0.5 * flow.density * norm_squared(velocity(f)); })};
}

PatchForce patch_force(const Flow& flow, int patch, const Vec3& origin) {
  const auto push = [&](int f, int b) { return flow.boundary_pressure[b] * flow.mesh.face_vector[f]; };
  const auto rub = [&](int, int b) { return flow.boundary_friction[b] + flow.turning_friction[b]; };
  const auto arm = [&](int f) { return flow.mesh.face_centre[f] - origin; };
  return {.pressure = patch_sum(flow, patch, push),
          .friction = patch_sum(flow, patch, rub),
          .pressure_torque = patch_sum(flow, patch, [&](int f, int b) { return cross(arm(f), push(f, b)); }),
          .friction_torque = patch_sum(flow, patch, [&](int f, int b) { return cross(arm(f), rub(f, b)); })};
}

YPlus y_plus_of(const Flow& flow, int patch) {
  const Patch& faces = flow.mesh.patches[static_cast<std::size_t>(patch)];
  if (sum(flow.mesh.comm, static_cast<std::int64_t>(flow.y_plus.size())) == 0) return {};
  const double area = patch_area(flow, patch);
  const double total = patch_sum(flow, patch, [&](int f, int b) { return norm(flow.mesh.face_vector[f]) * flow.y_plus[b]; });
  if (!(area > 0)) return {};
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  for (int f = faces.first; f < faces.end(); ++f) {
    lowest = std::min(lowest, flow.y_plus[f - flow.mesh.n_interior]);
    highest = std::max(highest, flow.y_plus[f - flow.mesh.n_interior]);
  }
  return {minimum(flow.mesh.comm, lowest), total / area, maximum(flow.mesh.comm, highest)};
}

double kinetic_energy(const Flow& flow) {
  std::vector<double> energy(flow.mesh.n_cells);
  for (int c = 0; c < flow.mesh.n_cells; ++c) energy[c] = 0.5 * flow.density * flow.mesh.cell_volume[c] * norm_squared(flow.velocity[c]);
  return sum(flow.mesh.comm, std::span<const double>(energy));
}

}  // namespace snag
