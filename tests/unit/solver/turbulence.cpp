// ranks: 1 2
#include <gtest/gtest.h>

#include "case_texts.hpp"
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"
#include "solver/monitors.hpp"
#include "solver/turbulence/automatic_walls.hpp"
#include "solver/turbulence/wall_functions.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const char* const model = "[turbulence]\nmodel = \"k_epsilon\"\ninitial_k = \"0.04 m2/s2\"\ninitial_epsilon = \"0.1 m2/s3\"\n";
const char* const all_walls = "[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"wall\"\n";

std::unique_ptr<Turbulence> turbulence(const std::string& toml) { return read_turbulence(CaseFile::parse(toml).root()); }

}  // namespace

// The wall law is the logarithm above y*_lam, the laminar profile below, and continuous between.
TEST(WallLaw, profile) {
  WallLaw law;
  law.set_y_laminar();
  EXPECT_NEAR(law.y_laminar, 11.53, 0.005);
  EXPECT_NEAR(law.y_laminar, std::log(law.E * law.y_laminar) / law.kappa, 1e-12);
  EXPECT_DOUBLE_EQ(law.viscosity_ratio(5), 5 / law.y_laminar);  // rho u* u/y_lam is the shear of a cell at the edge of the log layer
  EXPECT_DOUBLE_EQ(law.distance(1e-5, 0.1, 1e-6), law.y_laminar * 1e-5);
  EXPECT_EQ(law.distance(1e-3, 0.1, 1e-6), 1e-3);
  EXPECT_NEAR(law.viscosity_ratio(law.y_laminar * (1 + 1e-12)), 1, 1e-11);
  EXPECT_DOUBLE_EQ(law.viscosity_ratio(100), 0.41 * 100 / std::log(9.8 * 100));
}

// Rough: the logarithm falls by ln(1 + a k_s*)/kappa, none for a smooth wall and u+ = ln(y/k_s)/kappa + 8.5 for a very rough one, and the
// distance is half the roughness at least.
TEST(WallLaw, roughness) {
  WallLaw law;
  law.set_y_laminar();
  EXPECT_EQ(law.viscosity_ratio(100, 0), law.viscosity_ratio(100));
  EXPECT_NEAR(1e6 / law.viscosity_ratio(1e6, 1e5), std::log(10) / 0.41 + 8.5, 1e-4);  // u+ = y*/(mu_w/mu)
  EXPECT_NEAR(100 / law.viscosity_ratio(100, 10), std::log(9.8 * 100 / (1 + 9.8 * std::exp(-8.5 * 0.41) * 10)) / 0.41, 1e-12);
  EXPECT_DOUBLE_EQ(law.viscosity_ratio(10, 1000) / 10, law.viscosity_ratio(500, 1000) / 500);
  EXPECT_EQ(law.distance(1e-4, 0.1, 1e-6, 1e-3), 5e-4);
  for (int i = 0; i < 34; ++i) {  // a cell anywhere has some friction, more than on a smooth wall
    const double roughness = 0.1 * std::pow(1.5, i);
    for (const double y : {1.0, 10.0, 100.0, 1000.0}) EXPECT_GT(law.viscosity_ratio(y, roughness), law.viscosity_ratio(y, 0));
  }
}

// Spalding's law is u+ = y+ at the wall and the logarithm far from it, grows, and each of its inverses gives back what it was made of.
TEST(SpaldingLaw, profile) {
  const SpaldingLaw law;
  EXPECT_NEAR(law.u_plus(0.1) / 0.1, 1, 1e-6);
  EXPECT_NEAR(law.u_plus(1000), std::log(9.8 * 1000) / 0.41, 0.01);
  double before = 0;
  for (int i = 0; i < 105; ++i) {
    const double y = 1e-6 * std::pow(1.3, i), u = law.u_plus(y);
    EXPECT_GT(u, before);
    EXPECT_NEAR(law.y_plus(u) / y, 1, 1e-10);
    EXPECT_NEAR(law.u_plus_of_product(u * y) / u, 1, 1e-10);
    EXPECT_NEAR((law.y_plus(u * (1 + 1e-6)) - law.y_plus(u * (1 - 1e-6))) / (2e-6 * u) / law.slope(u), 1, 1e-5);
    before = u;
  }
}

// Automatic walls: the shear on a wall is that of Spalding's law, viscous for a thin cell, and omega is the blend of both layers.
TEST(AutomaticWalls, shear_and_omega) {
  for (const double speed : {1e-4, 0.01, 5.0}) {
    const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 0.1}, {2, 2, 10}, {true, true, false});
    const FlowSolver solver(mesh, {}, conditions("[[boundary]]\npatches = [\"z0\", \"z1\"]\nkind = \"wall\"\n"), turbulence(model));
    Flow flow(mesh);
    flow.y_plus.resize(static_cast<std::size_t>(mesh.n_faces - mesh.n_interior));
    flow.face_viscosity.assign(static_cast<std::size_t>(mesh.n_faces), 0);
    std::fill(flow.velocity.begin(), flow.velocity.end(), Vec3{0, speed, 0.3});  // what runs against the wall does not count
    const SpaldingLaw law;
    const AutomaticWalls walls(mesh, solver.boundary(), law);
    std::vector<double> friction_velocity(static_cast<std::size_t>(mesh.n_all_cells()));
    walls.find(flow, solver.boundary(), friction_velocity);
    walls.set_viscosity(flow, friction_velocity);
    constexpr double y = 0.005;
    const double nu = flow.dynamic_viscosity / flow.density;
    const std::vector<double> omega = walls.omega(flow, friction_velocity, 0.09, 0.075);
    for (std::size_t i = 0; i < walls.cells().size(); ++i) {
      const double u_tau = friction_velocity[walls.cells()[i]];
      EXPECT_NEAR(law.y_plus(speed / u_tau) / (u_tau * y / nu), 1, 1e-9);
      EXPECT_NEAR(omega[i] / std::hypot(6 * nu / (0.075 * y * y), u_tau / (0.3 * 0.41 * y)), 1, 1e-12);
      if (speed < 1e-3) {
        EXPECT_NEAR(u_tau * u_tau / (nu * speed / y), 1, 1e-3);
      }
    }
    for (int f = mesh.patches[0].first; f < mesh.n_faces; ++f) {
      const double u_tau = friction_velocity[mesh.owner[f]];
      EXPECT_NEAR(flow.face_viscosity[f] * speed / y / (flow.density * u_tau * u_tau), 1, 1e-9);
      EXPECT_NEAR(flow.y_plus[f - mesh.n_interior] / (u_tau * y / nu), 1, 1e-12);
    }
  }
}

// Requirement: every source file in solver/turbulence/models/ registers a model (the linker drops none); and the manual shows the choice
// and each model.
TEST(Turbulence, registry) {
  EXPECT_EQ(turbulence_models().names().size(), n_sources("solver/turbulence/models"));
  EXPECT_EQ(turbulence_sections().size(), turbulence_models().names().size() + 1);
}

// A misspelt model is an error that names the nearest.
TEST(Turbulence, unknown_model) {
  EXPECT_TRUE(mentions(usage_error([] { turbulence("[turbulence]\nmodel = \"k_epsilom\"\n"); }), "k_epsilon"));
}

// What enters has k = 3/2 (I U)^2 and epsilon = C_mu^(3/4) k^(3/2)/l, or what is given.
TEST(InletTurbulence, values) {
  InletTurbulence inlet;
  inlet.diameter = 0.2;
  const TurbulenceValues values = inlet.at(2, 0.09);
  EXPECT_DOUBLE_EQ(values.k, 0.015);
  EXPECT_NEAR(values.epsilon, std::pow(0.09, 0.75) * std::pow(0.015, 1.5) / 0.014, 1e-14);
  inlet.k = 0.3, inlet.epsilon = 0.7;
  EXPECT_EQ(inlet.at(2, 0.09).k, 0.3);
  EXPECT_EQ(inlet.at(2, 0.09).epsilon, 0.7);
}

// Keys of entering turbulence that contradict each other, or stand at a wall, are errors.
TEST(InletTurbulence, contradictions) {
  EXPECT_TRUE(mentions(usage_error([] { conditions("[[boundary]]\npatch = \"x0\"\nkind = \"wall\"\nturbulence_intensity = 0.1\n"); }),
                       "turbulence_"));
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {3, 3, 3});
  const std::string sides = "[[boundary]]\npatches = [\"x1\", \"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"pressure_outlet\"\n";
  const std::string inlet = "[[boundary]]\npatch = \"x0\"\nkind = \"velocity_inlet\"\nnormal_speed = \"1 m/s\"\n";
  EXPECT_TRUE(
      mentions(usage_error([&] { FlowSolver(mesh, {}, conditions(sides + inlet + "turbulence_k = \"1 m2/s2\"\n"), turbulence(model)); }),
               "turbulence_epsilon"));
}

// Where nothing enters and no initial state is given, the error asks for it.
TEST(KEpsilon, no_initial_state) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {3, 3, 3});
  FlowSolver solver(mesh, {}, conditions(all_walls), turbulence("[turbulence]\nmodel = \"k_epsilon\"\n"));
  EXPECT_TRUE(mentions(usage_error([&] { solver.advance(0.1); }), "initial_k"));
}

// Without a model the flow has no fields of turbulence, a constant viscosity, and no y+.
TEST(Laminar, leaves_the_flow_alone) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {3, 3, 3});
  FlowSolver solver(mesh, {}, conditions(all_walls));
  solver.advance(0.1);
  EXPECT_TRUE(solver.flow.eddy_viscosity.empty());
  EXPECT_FALSE(solver.flow.variable_viscosity);
  for (const double mu : solver.flow.face_viscosity) EXPECT_EQ(mu, solver.flow.dynamic_viscosity);
  EXPECT_EQ(y_plus_of(solver.flow, 0).highest, 0);
}

// A cell with several wall faces at different distances takes the mean of production and epsilon, weighted with their areas.
TEST(WallFunctions, several_faces) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {0.3, 0.6, 0.9}, {3, 3, 3});
  const FlowSolver solver(mesh, {}, conditions(all_walls), turbulence(model));
  Flow flow(mesh);
  flow.y_plus.resize(static_cast<std::size_t>(mesh.n_faces - mesh.n_interior));
  std::fill(flow.velocity.begin(), flow.velocity.end(), Vec3{1, 2, 2});
  WallLaw law;
  law.set_y_laminar();
  WallFunctions walls(mesh, solver.boundary(), law);
  constexpr double k = 0.04;
  walls.equilibrium(flow, solver.boundary(), std::vector<double>(static_cast<std::size_t>(mesh.n_all_cells()), k));
  const double u_star = std::pow(0.09, 0.25) * std::sqrt(k), nu = flow.dynamic_viscosity / flow.density;
  // At a corner: areas 0.2 x 0.3, 0.1 x 0.3, 0.1 x 0.2, distances 0.05, 0.1, 0.15, speeds along the walls of sqrt(8), sqrt(5), sqrt(5).
  const std::array<double, 3> area{0.06, 0.03, 0.02}, y{0.05, 0.1, 0.15}, speed{std::sqrt(8), std::sqrt(5), std::sqrt(5)};
  double epsilon = 0, production = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double shear = nu * law.viscosity_ratio(u_star * y[i] / nu) * speed[i] / y[i];
    epsilon += area[i] / 0.11 * std::pow(u_star, 3) / (0.41 * y[i]);
    production += area[i] / 0.11 * shear * u_star / (0.41 * y[i]);
  }
  std::int64_t corners = 0;
  for (std::size_t i = 0; i < walls.cells().size(); ++i) {
    const Vec3& x = mesh.cell_centre[walls.cells()[i]];
    if (x.x > 0.1 || x.y > 0.2 || x.z > 0.3) continue;
    ++corners;
    EXPECT_NEAR(walls.dissipation()[i] / epsilon, 1, 1e-12);
    EXPECT_NEAR(walls.production()[i] / production, 1, 1e-12);
  }
  EXPECT_EQ(sum(MPI_COMM_WORLD, corners), 1);
}

// Walls are found again when the number of facets of a turning mesh, which lie before the boundary faces, has changed.
TEST(WallFunctions, facets_come_and_go) {
  Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {0.3, 0.6, 0.9}, {3, 3, 3});
  const FlowSolver solver(mesh, {}, conditions(all_walls), turbulence(model));
  Flow flow(mesh);
  flow.y_plus.resize(static_cast<std::size_t>(mesh.n_faces - mesh.n_interior));
  flow.eddy_viscosity.assign(static_cast<std::size_t>(mesh.n_all_cells()), 1e-4);
  std::fill(flow.velocity.begin(), flow.velocity.end(), Vec3{1, 2, 2});
  std::fill(flow.face_viscosity.begin(), flow.face_viscosity.end(), flow.dynamic_viscosity);
  const std::vector<double> k(static_cast<std::size_t>(mesh.n_all_cells()), 0.04);
  WallFunctions walls(mesh, solver.boundary(), WallLaw{});
  struct Result {
    std::vector<double> y_plus, viscosity, production, dissipation;
    std::vector<Vec3> slip;
    bool operator==(const Result& other) const {
      return y_plus == other.y_plus && viscosity == other.viscosity && production == other.production && dissipation == other.dissipation &&
             slip == other.slip;
    }
  };
  const auto result = [&] {
    walls.set_viscosity(flow, k);
    walls.equilibrium(flow, solver.boundary(), k);
    std::vector<Vec3> slip = solver.boundary().values().velocity;
    walls.slip(flow, solver.boundary(), slip);
    return Result{flow.y_plus,
                  {flow.face_viscosity.begin() + mesh.n_interior, flow.face_viscosity.end()},
                  walls.production(),
                  walls.dissipation(),
                  slip};
  };
  const Result before = result();
  constexpr int n_more = 5;
  const auto add_facets = [&](auto& field) { field.insert(field.begin() + mesh.n_interior, n_more, {}); };
  add_facets(mesh.owner), add_facets(mesh.neighbour), add_facets(mesh.face_vector), add_facets(mesh.face_centre), add_facets(mesh.delta);
  add_facets(flow.face_viscosity);
  for (Patch& patch : mesh.patches) patch.first += n_more;
  mesh.n_interior += n_more, mesh.n_faces += n_more;
  EXPECT_EQ(before, result());
}

// The shear on a wall is that of the wall function at the speed relative to the wall: none where both move together.
TEST(WallFunctions, relative_to_the_wall) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 6}, {true, true, false});
  FlowSettings settings;
  settings.initial_velocity = {2, 0, 0};
  FlowSolver solver(mesh, settings,
                    conditions("[[boundary]]\npatch = \"z0\"\nkind = \"moving_wall\"\nvelocity = [\"2 m/s\", \"0 m/s\", \"0 m/s\"]\n"
                               "[[boundary]]\npatch = \"z1\"\nkind = \"wall\"\n"),
                    turbulence(model));
  solver.advance(1e-4);
  EXPECT_NEAR(patch_force(solver.flow, mesh.patch_index("z0"), {}).friction.x, 0, 1e-9);
  const double u_star = std::pow(0.09, 0.25) * 0.2, y_star = u_star / 12 / (1.003e-3 / 998.2);
  EXPECT_NEAR(patch_force(solver.flow, mesh.patch_index("z1"), {}).friction.x, 998.2 * u_star * 0.41 / std::log(9.8 * y_star) * 2, 0.01);
}
