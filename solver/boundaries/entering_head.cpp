#include "solver/boundaries/entering_head.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "parallel/sum.hpp"

namespace snag {

namespace {

/// 1/2 rho u_n^2 where this flux enters, Pa.
double dynamic_head(const Flow& flow, const std::vector<double>& flux, int face) {
  const double speed = flux[face] / norm(flow.mesh.face_vector[face]);
  return speed < 0 ? 0.5 * flow.density * speed * speed : 0;
}

}  // namespace

void EnteringHead::begin_step(const Flow& flow, const Patch& patch, double time, double total_before) {
  dt_ = time - flow.time, total_before_ = total_before;
  if (!(dt_ > 0)) return;
  std::vector<double> area, last, older, former;
  for (int f = patch.first; f < patch.end(); ++f) {
    area.push_back(norm(flow.mesh.face_vector[f]));
    last.push_back(area.back() * dynamic_head(flow, flow.flux_old, f));
    older.push_back(area.back() * dynamic_head(flow, flow.flux, f));
    former.push_back(area.back() * before(flow, f));
  }
  const auto total = [&](const std::vector<double>& of_faces) { return sum(flow.mesh.comm, std::span<const double>(of_faces)); };
  const double whole = total(area);
  mean_of_last_ = mean_ = total(last) / whole;
  mean_before_ = total(former) / whole;
  if (!conductance_ || flow.time_step == 0) return;
  const double older_mean = total(older) / whole, change = (mean_of_last_ - older_mean) * dt_ / flow.time_step_size;
  const double c = dt_ * std::sqrt(2 * std::max(mean_of_last_, older_mean) / flow.density) * *conductance_ / whole;
  mean_ = std::max(0.0, mean_before_ + (mean_of_last_ + change - mean_before_) / (1 + c));
}

double EnteringHead::at(const Flow& flow, int face) const {
  if (!(dt_ > 0)) return 0;
  const double beyond = dynamic_head(flow, flow.flux_old, face) - mean_of_last_, beyond_before = before(flow, face) - mean_before_;
  const double courant = dt_ * std::abs(flow.flux_old[face]) / dot(flow.mesh.delta[face], flow.mesh.face_vector[face]);
  return mean_ + beyond_before + (beyond - beyond_before) / (1 + courant);
}

/// M + q' of the step before, which its pressure at the face tells.
double EnteringHead::before(const Flow& flow, int face) const {
  return total_before_ - flow.boundary_pressure[face - flow.mesh.n_interior];
}

}  // namespace snag
