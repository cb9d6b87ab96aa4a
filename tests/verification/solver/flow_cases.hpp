#pragma once
// What the verification of the flow solver shares: exact fields, conditions that impose them, error norms, observed orders.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"
#include "tests/structured_box.hpp"

namespace snag::test {

constexpr double pi = std::numbers::pi;
using VectorField = std::function<Vec3(const Vec3&, double)>;  // of place and time

/// Velocity of an exact solution on a patch; through: false where the solution is tangential, so that the flux is exactly zero.
struct ExactVelocity final : Boundary {
  VectorField u;
  bool through = true;
  Section section() override { return {}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) {
      const int b = f - flow.mesh.n_interior;
      values.velocity[b] = u(flow.mesh.face_centre[f], time);
      values.flux[b] = through ? dot(values.velocity[b], flow.mesh.face_vector[f]) : flow.mesh_flux[f];
    }
  }
};

inline void add_exact(std::vector<PatchBoundary>& conditions, const std::string& patch, const VectorField& u, bool through) {
  auto exact = std::make_unique<ExactVelocity>();
  exact->u = u, exact->through = through;
  conditions.push_back({patch, "test", std::move(exact)});
}

/// Conditions as a case file gives them.
inline std::vector<PatchBoundary> conditions(const std::string& toml) { return read_boundaries(CaseFile::parse(toml).root()); }

/// Settings of a test: linear solves to round-off level.
inline FlowSettings sharp_settings() {
  FlowSettings settings;
  settings.density = 1.2;
  settings.momentum_tolerance = settings.pressure_tolerance = settings.pressure_tolerance_intermediate = 1e-11;
  return settings;
}

/// Root of the mean square over the volume, of the difference of two cell fields.
inline double distance(const Mesh& mesh, const std::function<double(int)>& squared_difference) {
  std::vector<double> error(mesh.n_cells), volume(mesh.cell_volume.begin(), mesh.cell_volume.begin() + mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) error[c] = mesh.cell_volume[c] * squared_difference(c);
  return std::sqrt(sum(mesh.comm, std::span<const double>(error)) / sum(mesh.comm, std::span<const double>(volume)));
}

inline double velocity_error(const Flow& flow, const VectorField& exact) {
  return distance(flow.mesh, [&](int c) { return norm_squared(flow.velocity[c] - exact(flow.mesh.cell_centre[c], flow.time)); });
}

/// The same of the pressure, up to a constant.
inline double pressure_error(const Flow& flow, const std::function<double(const Vec3&, double)>& exact) {
  const Mesh& mesh = flow.mesh;
  std::vector<double> moment(mesh.n_cells), volume(mesh.cell_volume.begin(), mesh.cell_volume.begin() + mesh.n_cells);
  const auto difference = [&](int c) { return flow.pressure[c] - exact(mesh.cell_centre[c], flow.time); };
  for (int c = 0; c < mesh.n_cells; ++c) moment[c] = volume[c] * difference(c);
  const double mean = sum(mesh.comm, std::span<const double>(moment)) / sum(mesh.comm, std::span<const double>(volume));
  return distance(mesh, [&](int c) { return std::pow(difference(c) - mean, 2); });
}

/// Errors on a sequence of steps h: prints the table and returns the least-squares slope of log(error) over log(h).
inline double observed_order(const char* name, const std::vector<double>& h, const std::vector<double>& error) {
  double mx = 0, my = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(h.size());
  for (std::size_t i = 0; i < h.size(); ++i) mx += std::log(h[i]) / n, my += std::log(error[i]) / n;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double x = std::log(h[i]) - mx;
    xx += x * x, xy += x * (std::log(error[i]) - my);
  }
  const double order = xy / xx;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    std::printf("%s: observed order %.2f\n", name, order);
    for (std::size_t i = 0; i < h.size(); ++i) std::printf("    h = %.5f   error = %.4e\n", h[i], error[i]);
  }
  return order;
}

}  // namespace snag::test
