#include "solver/boundaries/entering_head.hpp"

#include <cmath>
#include <span>

#include "parallel/sum.hpp"

namespace snag {

namespace {
double dynamic_head(const Flow& flow, int face) {
  const double speed = flow.flux_old[face] / norm(flow.mesh.face_vector[face]);
  return speed < 0 ? 0.5 * flow.density * speed * speed : 0;
}
}  // namespace

void EnteringHead::begin_step(const Flow& flow, const Patch& patch, double time, double total_before) {
  dt_ = time - flow.time, total_before_ = total_before;
  if (!(dt_ > 0)) return;
  std::vector<double> area, head, former;
  for (int f = patch.first; f < patch.end(); ++f) {
    area.push_back(norm(flow.mesh.face_vector[f]));
    head.push_back(area.back() * dynamic_head(flow, f));
    former.push_back(area.back() * before(flow, f));
  }
  const double whole = sum(flow.mesh.comm, std::span<const double>(area));
  mean_ = sum(flow.mesh.comm, std::span<const double>(head)) / whole;
  mean_before_ = sum(flow.mesh.comm, std::span<const double>(former)) / whole;
}

double EnteringHead::at(const Flow& flow, int face) const {
  if (!(dt_ > 0)) return 0;
  const double beyond = dynamic_head(flow, face) - mean_, beyond_before = before(flow, face) - mean_before_;
  const double courant = dt_ * std::abs(flow.flux_old[face]) / dot(flow.mesh.delta[face], flow.mesh.face_vector[face]);
  return mean_ + beyond_before + (beyond - beyond_before) / (1 + courant);
}

/// m(q) + q' of the step before, which its pressure at the face tells.
double EnteringHead::before(const Flow& flow, int face) const {
  return total_before_ - flow.boundary_pressure[face - flow.mesh.n_interior];
}

}  // namespace snag
