// ranks: 1
// long ranks: 2
#include <gtest/gtest.h>

#include "tests/verification/solver/manufactured.hpp"

using namespace snag;
using namespace snag::test;

namespace {

// The exact solution of manufactured.hpp with a viscosity that varies in space, in balance with the force
//   f = rho (du/dt + u.grad u) + grad p - mu lap u - (grad u + grad u^T) grad mu,   mu = mu_0 (1 + cos x' cos y' cos z' / 2)
// With p = 0 it also satisfies the conditions of symmetry planes on all sides of the box.
struct VaryingViscosity {
  Manufactured exact;
  bool symmetric = false;

  double viscosity(const Vec3& x) const { return exact.mu * (1 + 0.5 * std::cos(pi * x.x) * std::cos(pi * x.y) * std::cos(pi * x.z)); }
  Vec3 viscosity_gradient(const Vec3& x) const {
    const double sx = std::sin(pi * x.x), sy = std::sin(pi * x.y), sz = std::sin(pi * x.z);
    const double cx = std::cos(pi * x.x), cy = std::cos(pi * x.y), cz = std::cos(pi * x.z);
    return -0.5 * pi * exact.mu * Vec3{sx * cy * cz, cx * sy * cz, cx * cy * sz};
  }
  Vec3 force(const Vec3& x, double t) const {
    Manufactured inviscid = exact;
    inviscid.mu = 0;
    const Vec3 u = exact.velocity(x, t), slope = viscosity_gradient(x);
    const Mat3 G = Manufactured::shape_gradient(x);
    Vec3 f = inviscid.force(x, t) + 3 * pi * pi * viscosity(x) * u -
             exact.amplitude(t) * (G * slope + slope.x * G[0] + slope.y * G[1] + slope.z * G[2]);
    if (symmetric) f -= std::cos(x.x + 2 * x.y - x.z + t) * Vec3{1, 2, -1};
    return f;
  }
  std::unique_ptr<FlowSolver> solver(const Mesh& mesh) const {
    FlowSettings settings = sharp_settings();
    settings.density = exact.rho, settings.dynamic_viscosity = exact.mu;
    auto made = symmetric ? std::make_unique<FlowSolver>(mesh, settings, conditions(R"(
[[boundary]]
patches = ["x0", "x1", "y0", "y1", "z0", "z1"]
kind = "symmetry"
)"))
                          : exact.solver(mesh, settings);
    Flow& flow = made->flow;
    for (int c = 0; c < mesh.n_cells; ++c) {
      flow.velocity[c] = exact.velocity(mesh.cell_centre[c], 0);
      flow.pressure[c] = symmetric ? 0 : exact.pressure(mesh.cell_centre[c], 0);
    }
    flow.variable_viscosity = true;
    for (int f = 0; f < mesh.n_faces; ++f) flow.face_viscosity[f] = viscosity(mesh.face_centre[f]);
    return made;
  }
  double error(const Mesh& mesh, int steps) const {
    const auto made = solver(mesh);
    Flow& flow = made->flow;
    flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
    for (int i = 0; i < steps; ++i) {
      const double dt = 0.4 / steps;
      for (int c = 0; c < mesh.n_cells; ++c) flow.reaction[c] = force(mesh.cell_centre[c], flow.time + dt);
      made->advance(dt);
    }
    return velocity_error(flow, exact.velocity_field());
  }
};

double order(const char* name, const std::function<Mesh(int)>& mesh_of, const std::vector<int>& sizes, bool symmetric) {
  const VaryingViscosity solution{.exact = {.mu = 0.2}, .symmetric = symmetric};
  std::vector<double> h, error;
  for (const int n : sizes) h.push_back(1.0 / n), error.push_back(solution.error(mesh_of(n), 2 * n));
  return observed_order(name, h, error);
}

Mesh hexahedra(int n) { return structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {n, n, n}); }
Mesh tetrahedra(int n) { return tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {n, n, n}); }

}  // namespace

// With a viscosity that varies in space velocity is second order between walls, on hexahedra and tetrahedra.
TEST(VariableViscosity, walls) {
  EXPECT_GT(order("variable viscosity, hexahedra", hexahedra, {8, 12, 16}, false), 1.8);
  EXPECT_GT(order("variable viscosity, tetrahedra", tetrahedra, {6, 8, 12}, false), 1.8);
}

// The same between planes of symmetry, whose normal stress is twice mu du_n/dn; on tetrahedra with the order that the condition
// has there for a constant viscosity, 1.65.
TEST(VariableViscosity, symmetry) {
  EXPECT_GT(order("variable viscosity, symmetry, hexahedra", hexahedra, {8, 12, 16}, true), 1.8);
  EXPECT_GT(order("variable viscosity, symmetry, tetrahedra", tetrahedra, {6, 8, 12}, true), 1.55);
}
