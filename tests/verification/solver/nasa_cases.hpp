#pragma once
// What the cases of NASA's Turbulence Modeling Resource (turbmodels.larc.nasa.gov) share: the k_omega_sst model as NASA sets it there, the
// march to a steady flow, friction and pressure along a wall.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/planar_grid.hpp"

namespace snag::test {

/// Density 1 kg/m3; `entering`: speed of the stream at the start, m/s; `text`: further keys of [turbulence], then the boundaries.
inline FlowSolver nasa_solver(const Mesh& mesh, double reynolds, double entering, double pressure_tolerance, const std::string& text) {
  FlowSettings settings;
  settings.density = 1, settings.kinematic_viscosity = 1 / reynolds, settings.initial_velocity = {entering, 0, 0};
  settings.n_outer_correctors = 3, settings.momentum_tolerance = 1e-6, settings.pressure_tolerance = pressure_tolerance;
  const CaseFile file = CaseFile::parse("[turbulence]\nmodel = \"k_omega_sst\"\ntolerance = 1e-6\n" + text);
  return {mesh, settings, read_boundaries(file.root()), read_turbulence(file.root())};
}

/// A place of a wall: along the stream; c_f, positive downstream, and c_p, with rho U^2/2; y+ of its cell.
struct WallPlace {
  double x, friction, pressure, y_plus;
};

/// The places of a patch, downstream.
inline std::vector<WallPlace> along_wall(const Flow& flow, const std::string& patch_name, double U = 1) {
  const Mesh& mesh = flow.mesh;
  const Patch& patch = mesh.patches[static_cast<std::size_t>(mesh.patch_index(patch_name))];
  const double dynamic_pressure = 0.5 * flow.density * U * U;
  std::vector<WallPlace> places;
  for (int f = patch.first; f < patch.end(); ++f) {
    const int b = f - mesh.n_interior;
    const Vec3 n = unit(mesh.face_vector[f]), downstream = n.y < 0 ? Vec3{-n.y, n.x, 0} : Vec3{n.y, -n.x, 0};
    const double shear = dot(flow.boundary_friction[b], downstream) / norm(mesh.face_vector[f]);
    places.push_back({mesh.face_centre[f].x, shear / dynamic_pressure, flow.boundary_pressure[b] / dynamic_pressure, flow.y_plus[b]});
  }
  std::sort(places.begin(), places.end(), [](const WallPlace& a, const WallPlace& b) { return a.x < b.x; });
  return places;
}

/// A quantity of the wall between its places, linear.
inline double at(const std::vector<WallPlace>& places, double WallPlace::*quantity, double x) {
  std::size_t i = 1;
  while (i + 1 < places.size() && places[i].x < x) ++i;
  const WallPlace &a = places[i - 1], &b = places[i];
  return a.*quantity + (x - a.x) / (b.x - a.x) * (b.*quantity - a.*quantity);
}

/// The farthest place at which friction turns downstream; 0 if nowhere.
inline double reattachment(const std::vector<WallPlace>& places) {
  for (std::size_t i = places.size() - 1; i > 0; --i) {
    const WallPlace &a = places[i - 1], &b = places[i];
    if (a.friction < 0 && b.friction >= 0) return a.x + (b.x - a.x) * a.friction / (a.friction - b.friction);
  }
  return 0;
}

/// Velocity along x at a place of the plane, on a grid whose lines along y are straight: linear between the centres of the cells.
inline double speed_at(const Flow& flow, double x, double y) {
  const Mesh& mesh = flow.mesh;
  std::map<long long, std::vector<std::pair<double, double>>> columns;  // by x in nm: y, u
  for (int c = 0; c < mesh.n_cells; ++c)
    columns[std::llround(1e9 * mesh.cell_centre[c].x)].emplace_back(mesh.cell_centre[c].y, flow.velocity[c].x);
  const auto in_column = [&](std::vector<std::pair<double, double>>& column) {
    std::sort(column.begin(), column.end());
    std::size_t j = 1;
    while (j + 1 < column.size() && column[j].first < y) ++j;
    const auto [y_0, u_0] = column[j - 1];
    const auto [y_1, u_1] = column[j];
    return u_0 + (y - y_0) / (y_1 - y_0) * (u_1 - u_0);
  };
  const auto after = columns.lower_bound(std::llround(1e9 * x)), before = std::prev(after);
  const double share = (1e9 * x - static_cast<double>(before->first)) / static_cast<double>(after->first - before->first);
  return (1 - share) * in_column(before->second) + share * in_column(after->second);
}

/// Advances n steps of dt. Returns false if an equation was not solved in the last quarter of them.
inline bool march(FlowSolver& solver, double dt, int n) {
  bool solved = true;
  for (int i = 0; i < n; ++i) {
    const StepReport report = solver.advance(dt);
    if (4 * i < 3 * n) continue;
    for (const OuterReport& outer : report.outer) {
      solved = solved && outer.momentum.converged;
      for (const auto& equation : outer.turbulence.equations) solved = solved && equation.sweeps.converged;
    }
  }
  return solved;
}

/// What values on three grids, coarse to fine with 1/h of `fineness`, tend to as f + C h^p with p from 1 to 2 as they show it, and the
/// uncertainty of the last, 1.25 times its distance from the limit; values that do not tend to one: 1.25 times their range. Procedure of
/// the Journal of Fluids Engineering: Celik and others (2008), 130, 078001.
struct GridLimit {
  double limit, uncertainty;
};
inline GridLimit grid_limit(const std::array<int, 3>& fineness, const std::array<double, 3>& value) {
  const double first = value[1] - value[0], second = value[2] - value[1];
  if (!(first * second > 0 && std::abs(second) < std::abs(first))) {
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    return {value[2], 1.25 * (*high - *low)};
  }
  const auto power = [&](int i, double p) { return std::pow(fineness[static_cast<std::size_t>(i)], -p); };
  double low = 1, high = 2;
  for (int i = 0; i < 50; ++i) {
    const double p = 0.5 * (low + high);
    ((power(0, p) - power(1, p)) / (power(1, p) - power(2, p)) < first / second ? low : high) = p;
  }
  const double rest = second * power(2, low) / (power(1, low) - power(2, low));
  return {value[2] + rest, 1.25 * std::abs(rest)};
}

/// A table row by row, for docs/pictures/nasa.py.
inline void print_row(const char* table, int m, const std::vector<double>& values) {
  std::printf("%s %d", table, m);
  for (const double value : values) std::printf(" %.6g", value);
  std::printf("\n");
}

/// Lines from `from` to `to` are added to those there are, at the shares `place` of the way.
inline void append(std::vector<double>& lines, double from, double to, const std::vector<double>& place) {
  for (std::size_t i = lines.empty() ? 0 : 1; i < place.size(); ++i) lines.push_back(from + (to - from) * place[i]);
}

/// Shares of n intervals, the finer the nearer to either end, those in the middle `ratio` times as wide as at the ends.
inline std::vector<double> graded_to_both(int n, double ratio) {
  std::vector<double> place;
  append(place, 0, 0.5, graded(n / 2, ratio)), append(place, 0.5, 1, graded(n - n / 2, 1 / ratio));
  return place;
}

}  // namespace snag::test
