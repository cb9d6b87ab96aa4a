#include "coupling/exchange.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "base/error.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {
constexpr double momentum_tolerance = 1e-10;  // of what was exchanged
}

double Exchange::give_volumes(std::span<const double> volumes) {
  flow_.solid_fraction.assign(flow_.mesh.n_cells, 0.0);
  kernel_.spread(volumes, 1, flow_.solid_fraction);
  double largest = 0;
  for (const double fraction : flow_.solid_fraction) largest = std::max(largest, fraction);
  return maximum(flow_.mesh.comm, largest);
}

void Exchange::give(std::span<const Vec3> impulse, std::span<const double> sensitivity, double dt) {
  const int n_cells = flow_.mesh.n_cells;
  dt_ = dt;
  impulse_.assign(impulse.begin(), impulse.end());
  sensitivity_.assign(sensitivity.begin(), sensitivity.end());
  velocity_before_.assign(flow_.velocity.begin(), flow_.velocity.begin() + n_cells);

  std::vector<double> amounts(4 * impulse.size());
  for (std::size_t b = 0; b < impulse.size(); ++b) {
    for (int i = 0; i < 3; ++i) amounts[4 * b + i] = -impulse[b][i] / dt;
    amounts[4 * b + 3] = sensitivity[b] / dt;
  }
  std::vector<double> given(4 * static_cast<std::size_t>(n_cells), 0.0);
  kernel_.spread(amounts, 4, given);
  flow_.reaction.resize(n_cells);
  flow_.drag.resize(n_cells);
  for (int c = 0; c < n_cells; ++c) {
    const double* value = &given[4 * static_cast<std::size_t>(c)];
    flow_.drag[c] = value[3];
    flow_.reaction[c] = Vec3{value[0], value[1], value[2]} + value[3] * flow_.velocity[c];
  }
}

std::vector<Vec3> Exchange::settle() {
  std::vector<Vec3> change(velocity_before_.size());
  for (std::size_t c = 0; c < change.size(); ++c) change[c] = flow_.velocity[c] - velocity_before_[c];
  std::vector<Vec3> settled = kernel_.average(change);
  for (std::size_t b = 0; b < settled.size(); ++b) {
    settled[b] *= sensitivity_[b];
    impulse_[b] += settled[b];
  }
  return settled;
}

ExchangeBalance Exchange::balance() const {
  const MPI_Comm comm = flow_.mesh.comm;
  std::vector<Vec3> applied;
  std::vector<double> exchanged(impulse_.size()), implicit;
  for (int c = 0; c < flow_.mesh.n_cells; ++c) {
    const Vec3 drag = flow_.drag[c] * flow_.velocity[c], force = flow_.reaction[c] - drag;
    if (flow_.drag[c] == 0 && force == Vec3{}) continue;  // far from all rags
    const double factor = dt_ * flow_.mesh.cell_volume[c];
    applied.push_back(factor * force);
    implicit.push_back(factor * norm(drag));
  }
  for (std::size_t b = 0; b < impulse_.size(); ++b) exchanged[b] = norm(impulse_[b]);
  ExchangeBalance balance;
  balance.on_rags = sum(comm, impulse_);
  balance.on_water = sum(comm, applied);
  balance.exchanged = sum(comm, exchanged);
  // beta u^n and beta u^(n+1) nearly cancel where rags drift with the water: the difference carries their last digits.
  balance.round_off = 16 * std::numeric_limits<double>::epsilon() * sum(comm, implicit);
  return balance;
}

double Exchange::max_drag_number() const {
  double largest = 0;
  for (const double beta : flow_.drag) largest = std::max(largest, beta * dt_ / flow_.density);
  return maximum(flow_.mesh.comm, largest);
}

void check_momentum(const ExchangeBalance& balance) {
  const double lost = norm(balance.on_rags + balance.on_water);
  if (lost <= momentum_tolerance * balance.exchanged + balance.round_off) return;
  std::ostringstream message;
  message << "coupling lost momentum: " << lost << " N s of " << balance.exchanged << " N s exchanged in this step, limit "
          << momentum_tolerance << " of it; do the kernel weights sum to 1, and is the velocity the one that the force was applied with?";
  throw Error(ExitCode::invariant, message.str());
}

}  // namespace snag
