// ranks: 1 3
// long ranks: 2
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/momentum_balance.hpp"
#include "tests/verification/solver/channel.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const std::string driven = channel("kind = \"velocity_inlet\"\nnormal_speed = \"1 m/s\"");

Mesh tetrahedra() { return channel_mesh(5); }

/// A body in the middle that pushes the water.
void put_rag(Flow& flow, double force) {
  flow.reaction.resize(static_cast<std::size_t>(flow.mesh.n_cells));
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    flow.reaction[c] = norm(flow.mesh.cell_centre[c] - Vec3{1, 0.5, 0.5}) < 0.3 ? force * Vec3{-0.8, 0, 0.1} : Vec3{};
}

/// A pressure outlet whose pressure rises with time.
struct RisingPressure final : Boundary {
  double rate = 0;  // Pa/s
  Section section() override { return {}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::pressure; }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) values.pressure[f - flow.mesh.n_interior] = rate * time;
  }
};

/// Suction through a porous plane: a given speed through the faces, along which the water slips.
struct Suction final : Boundary {
  double speed = 0.3;  // m/s, out
  Section section() override { return {}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::normal_velocity; }
  Side velocity_side() const override { return Side::slope; }
  FaceFlux flux() const override { return FaceFlux::given; }
  void update(const Flow& flow, const Patch& patch, double, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) values.flux[f - flow.mesh.n_interior] = speed * norm(flow.mesh.face_vector[f]);
  }
};

}  // namespace

// Requirement: a condition that answers the operators with a combination of its own (flux given, velocity by slope) is one struct: uniform
// oblique flow that it sucks off stays uniform, and its flux is as given in flow that begins as `factor` of it.
void expect_suction(double factor) {
  const Mesh mesh = tetrahedra();
  const Vec3 uniform{1, 0, 0.3};
  auto boundary = conditions(R"(
[[boundary]]
patches = ["x0", "z0", "z1"]
kind = "velocity_inlet"
velocity_m_s = [1, 0, 0.3]
[[boundary]]
patches = ["y0", "y1"]
kind = "symmetry"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)");
  for (PatchBoundary& condition : boundary)
    if (condition.patch == "z1") condition.boundary = std::make_unique<Suction>();
  FlowSolver solver(mesh, channel_settings(0.01), std::move(boundary));
  for (int c = 0; c < mesh.n_cells; ++c) solver.flow.velocity[c] = factor * uniform;
  for (int i = 0; i < 3; ++i) solver.advance(0.02);
  for (const Patch& patch : mesh.patches) {
    if (factor != 1 && patch.name != "z1") continue;
    for (int f = patch.first; f < patch.end(); ++f)
      EXPECT_NEAR(solver.flow.flux[f], dot(uniform, mesh.face_vector[f]), 1e-10) << patch.name;
  }
  for (int c = 0; c < mesh.n_cells && factor == 1; ++c) EXPECT_LT(norm(solver.flow.velocity[c] - uniform), 1e-9);
}

TEST(Balance, BoundaryQuestions) {
  expect_suction(1);
  expect_suction(0.5);  // the cells at the plane have another velocity: the flux is as given, not as they carry it
}

// A pressure that rises at the outlet lifts the pressure everywhere and changes nothing else.
TEST(Balance, rising_outlet_pressure) {
  const Mesh mesh = tetrahedra();
  const auto pressure_and_velocity = [&](double rate) {
    auto boundary = conditions(driven);
    auto rising = std::make_unique<RisingPressure>();
    rising->rate = rate;
    boundary.back().boundary = std::move(rising);
    FlowSolver solver(mesh, channel_settings(0.01), std::move(boundary));
    for (int i = 0; i < 5; ++i) solver.advance(0.02);
    return std::pair(solver.flow.pressure, solver.flow.velocity);
  };
  const auto level = pressure_and_velocity(0), lifted = pressure_and_velocity(500);
  for (int c = 0; c < mesh.n_cells; ++c) {
    EXPECT_NEAR(lifted.first[c], level.first[c] + 500 * 0.1, 1e-6);
    EXPECT_LT(norm(lifted.second[c] - level.second[c]), 1e-7);
  }
}

// A pressure that alternates from cell to cell in water at rest is gone after three steps on tetrahedra: fluxes see it though cell
// gradients hardly do.
TEST(Balance, checkerboard) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, channel_settings(0.01),
                    conditions("[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"wall\"\n"));
  for (int c = 0; c < mesh.n_cells; ++c) solver.flow.pressure[c] = mesh.cell_id[c] % 2 == 0 ? 1 : -1;
  for (int i = 0; i < 3; ++i) solver.advance(0.02);
  EXPECT_LT(pressure_error(solver.flow, [](const Vec3&, double) { return 0; }), 0.05);
}

/// Root mean square of the speed after a second step over dt F/rho, in a closed box of `mesh` under f = F(x).
double stirred(const Mesh& mesh, double largest, const std::function<Vec3(int cell)>& force) {
  FlowSettings settings = channel_settings(1e-6);
  settings.n_non_orthogonal_correctors = 4;
  FlowSolver solver(mesh, settings,
                    conditions("[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"symmetry\"\n"));
  solver.flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
  const double dt = 0.01;
  for (int i = 0; i < 2; ++i) {
    for (int c = 0; c < mesh.n_cells; ++c) solver.flow.reaction[c] = force(c);
    solver.advance(dt);
  }
  const double speed = distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c]); });
  return speed * solver.flow.density / (dt * largest);
}

// Requirement: a force that pressure can hold leaves water at rest: exactly where it changes from layer to layer of hexahedra, as that of a
// sheet does, and with second order where it is a gradient on tetrahedra.
TEST(Balance, force_that_pressure_holds) {
  const Mesh hexahedra = structured_box(MPI_COMM_WORLD, {}, {1, 2, 1}, {20, 6, 6});
  const double layer[] = {0, 100, -40, 7};
  EXPECT_LT(stirred(hexahedra, 100, [&](int c) { return Vec3{layer[static_cast<int>(hexahedra.cell_centre[c].x * 20) % 4], 0, 0}; }), 1e-6);

  const auto on_tetrahedra = [](int n) {
    const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {n, n, n});
    return stirred(mesh, 25 * pi, [&](int c) {
      const Vec3 x = pi / 2 * mesh.cell_centre[c];
      return 25 * pi * Vec3{std::cos(x.x) * std::cos(x.y), -std::sin(x.x) * std::sin(x.y), 0};
    });
  };
  const double coarse = on_tetrahedra(6), fine = on_tetrahedra(12);
  std::printf("    speed that a gradient leaves on tetrahedra, over dt F/rho: %.2e and %.2e with half the size\n", coarse, fine);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.35 * coarse);
}

// The momentum of the whole domain changes by what crosses its boundary, by the body force and by what the rags give, to 1e-8; mass is kept
// in each cell.
TEST(Balance, momentum_and_mass) {
  const Mesh mesh = tetrahedra();
  FlowSettings settings = channel_settings(0.01);
  settings.body_force = {0.3, -0.2, 0.1};
  FlowSolver solver(mesh, settings, conditions(driven));
  for (int i = 0; i < 10; ++i) {
    put_rag(solver.flow, 50);
    const StepReport report = solver.advance(0.02);
    const MomentumBalance balance = momentum_balance(solver);
    const double size =
        norm(balance.pressure) + norm(balance.friction) + norm(balance.convection) + norm(balance.given) + norm(balance.body);
    EXPECT_LT(norm(balance.residual()), 1e-8 * size);
    EXPECT_GT(norm(balance.given), 1e-3 * size);
    EXPECT_LT(report.continuity_local, 1e-9);
    EXPECT_NEAR(flow_rate(solver.flow, mesh.patch_index("x1")), 1, 1e-9);
  }
}

// The forces that the patches report are those of the momentum balance.
TEST(Balance, forces_of_patches) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, channel_settings(0.01), conditions(driven));
  for (int i = 0; i < 3; ++i) solver.advance(0.02);
  Vec3 pressure, friction;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p) {
    const PatchForce force = patch_force(solver.flow, p, {});
    pressure += force.pressure, friction += force.friction;
  }
  const MomentumBalance balance = momentum_balance(solver);
  EXPECT_LT(norm(pressure - balance.pressure), 1e-10 * norm(balance.pressure));
  EXPECT_LT(norm(friction - balance.friction), 1e-10 * norm(balance.friction));
}

// Water at rest in a closed box under its weight stays at rest on tetrahedra: the pressure balances the force exactly.
TEST(Balance, hydrostatic) {
  const Mesh mesh = tetrahedra();
  FlowSettings settings = channel_settings(1e-3);
  settings.body_force = {1, 2, -9.81 * 1.2};
  FlowSolver solver(mesh, settings,
                    conditions("[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"wall\"\n"));
  for (int i = 0; i < 10; ++i) solver.advance(0.02);
  EXPECT_LT(distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c]); }), 1e-6);
  EXPECT_LT(distance(mesh, [&](int c) { return norm_squared(solver.flow.pressure_gradient[c] - settings.body_force); }), 1e-4);
}

// The same with a turbulence model, whose walls take the slope of the pressure from the cells around; also in a layer of one cell.
TEST(Balance, hydrostatic_with_wall_functions) {
  for (const Mesh& mesh : {tetrahedra(), structured_box(MPI_COMM_WORLD, {}, {2, 1, 0.2}, {10, 5, 1})}) {
    FlowSettings settings = channel_settings(1e-3);
    settings.body_force = {1, 2, -9.81 * 1.2};
    FlowSolver solver(
        mesh, settings, conditions("[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"wall\"\n"),
        read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"k_epsilon\"\ninitial_k_m2_s2 = 10\ninitial_epsilon_m2_s3 = 10\n").root()));
    for (int i = 0; i < 10; ++i) solver.advance(0.02);
    EXPECT_LT(distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c]); }), 1e-6);
    EXPECT_LT(distance(mesh, [&](int c) { return norm_squared(solver.flow.pressure_gradient[c] - settings.body_force); }), 1e-4);
  }
}
