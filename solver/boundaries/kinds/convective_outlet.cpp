// Outlet through which the flow leaves as a pattern that moves on:
//
//   du/dt + U du/dn = 0        U: mean speed out through the patch, m/s
//   s = U dt up to 2 l, then 4 l - U dt, at least l      l = (x - x_P).n: within the cell; larger steps lag
//
// in hexahedra, along the characteristic of x from the fluid at t, second order in cells and steps:
//
//   u(x, t + dt) = u_P + grad u_P . (x - s n - x_P)
//
// In other cells a gradient that contains the last u at the face carries u nearly all of the way from x_P to x in a step that is short
// against l, and the flow across n grows without bound. There, first order, with grad u_P the mean over the cell and its neighbours:
//
//   u.n(x, t + dt) = u.n(x - s n, t)      s < l: linear between the face (its flux at t) and x - l n; s >= l: with grad u_P from x_P
//   u - (u.n) n    = that of u(x - l n) = u_P + grad u_P . (x - l n - x_P);      s >= l: that of u(x - s n)
//
// and the convected velocity is that of the cell (solver/momentum.cpp). In all cells, for the slope of the pressure, first order in cells:
//
//   Du/Dt = grad u_P . (u - U n)          grad u_P extrapolated to t + dt
//
// Steps in which the stream crosses more than three cells may diverge, and so may steps in which friction carries momentum over several.
//
// What the patches with a given velocity bring in leaves here (BoundarySet::update): a uniform speed along the normal closes the balance.
// Eddies leave with little reflection, where a pressure_outlet flattens the pressure across them. Source: I. Orlanski, A simple boundary
// condition for unbounded hyperbolic flows, J. Comput. Phys. 21 (1976) 251, with U the mean speed.
#include <algorithm>

#include "parallel/sum.hpp"
#include "solver/boundaries/boundary.hpp"

namespace snag {
namespace {

struct ConvectiveOutlet final : Boundary {
  static constexpr const char* name = "convective_outlet";
  double speed = 0;  // U
  double dt = 0;     // of the step; 0 at a start
  double ratio = 0;  // of the step to the last one; 0 without one

  Section section() override {
    return {
        .name = name,
        .meaning =
            "The flow leaves as it comes, carried on at the mean speed; eddies pass with little reflection. What flows in through "
            "the other patches leaves here, and no patch needs to give the pressure. A step in which the stream crosses more "
            "than three cells at the outlet may diverge: take pressure_outlet for such steps. So may a step in which friction reaches over "
            "several cells, in slow flow: take shorter steps, or three outer correctors.",
        .parameters = {}};
  }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::velocity; }
  bool is_outlet() const override { return true; }

  void respond(const Flow& flow, const Patch& patch, double time) override {
    dt = time - flow.time;
    ratio = dt > 0 && flow.time_step > 0 ? dt / flow.time_step_size : 0;
    std::vector<double> out, area;
    for (int f = patch.first; f < patch.end(); ++f) {
      // At a start no flux is known: that of the fluid at the patch.
      const Vec3& S = flow.mesh.face_vector[f];
      out.push_back(dt > 0 ? flow.flux_old[f] : dot(flow.velocity[flow.mesh.owner[f]], S));
      area.push_back(norm(S));
    }
    const double total = sum(flow.mesh.comm, std::span<const double>(area));
    speed = total > 0 ? std::max(0.0, sum(flow.mesh.comm, std::span<const double>(out)) / total) : 0;
  }

  void update(const Flow& flow, const Patch& patch, double, BoundaryValues& values) const override {
    const Mesh& mesh = flow.mesh;
    const auto& u = dt > 0 ? flow.velocity_old : flow.velocity;
    for (int f = patch.first; f < patch.end(); ++f) {
      const int P = mesh.owner[f], b = f - mesh.n_interior;
      const Vec3 n = unit(mesh.face_vector[f]);
      const bool is_hexahedron = mesh.cell_shape[P] == CellShape::hexahedron;
      const auto gradient = [&](const std::vector<Mat3>& of_cells) {
        return is_hexahedron ? of_cells[P] : mean_with_neighbours(mesh, P, of_cells);
      };
      const Mat3 G = gradient(flow.velocity_gradient), G_old = gradient(flow.velocity_gradient_old);
      const Vec3 d = mesh.face_centre[f] - mesh.cell_centre[P];
      const double l = dot(d, n), way = speed * dt, s = way <= 2 * l ? way : std::max(l, 4 * l - way);
      values.velocity[b] = u[P] + G * (d - s * n);
      if (!is_hexahedron && s < l) {
        const Vec3 inside = u[P] + G * (d - l * n);
        const double leaving = dt > 0 ? flow.flux_old[f] / norm(mesh.face_vector[f]) : dot(u[P] + G * d, n);
        values.velocity[b] = inside + (1 - s / l) * (leaving - dot(inside, n)) * n;
      }
      values.flux[b] = dot(values.velocity[b], mesh.face_vector[f]);
      const Vec3 passing = values.velocity[b] - speed * n;
      values.acceleration[b] = G * passing + ratio * (G * passing - G_old * passing);
    }
  }
};
const bool registered = boundaries().add<ConvectiveOutlet>();

}  // namespace
}  // namespace snag
