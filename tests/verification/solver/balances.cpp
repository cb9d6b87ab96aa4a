// ranks: 1 2
// long ranks: 3
// Requirement: the balances of angular momentum and of energy close, and their terms are those of exact flows.
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double R1 = 0.5, R2 = 1, Omega = 1, rho = 1.2, mu = 0.012;  // m, rad/s, kg/m3, Pa s

double largest_term(const AngularMomentumBalance& row) {
  double largest = std::max({std::abs(row.stored), std::abs(row.openings), std::abs(row.interface), std::abs(row.given),
                             std::abs(row.lost_convection), std::abs(row.lost_pressure), std::abs(row.lost_friction)});
  for (std::size_t p = 0; p < row.wall_pressure.size(); ++p)
    largest = std::max({largest, std::abs(row.wall_pressure[p]), std::abs(row.wall_friction[p])});
  return largest;
}

/// Both rows close to 1e-6 of the shaft's, and so that a term left out would show, `terms` are each above 1e-4 of it.
void expect_closed(const Balances& balances, double torque, double power) {
  EXPECT_LT(std::abs(balances.turning().residual()), 1e-6 * torque);
  EXPECT_LT(std::abs(balances.at_rest().residual()), 1e-6 * torque);
  EXPECT_LT(std::abs(balances.energy().residual()), 1e-6 * power);
}

void expect_matters(const std::vector<double>& terms, double whole) {
  for (std::size_t i = 0; i < terms.size(); ++i) EXPECT_GT(std::abs(terms[i]), 1e-4 * whole) << "term " << i;
}

FlowSettings viscous_settings() {
  FlowSettings settings = sharp_settings();
  settings.density = rho, settings.dynamic_viscosity = mu;
  return settings;
}

/// Rings of cells between a cylinder that turns and one at rest.
struct Couette {
  Shells shells;
  Mesh mesh;
  FlowSolver solver;

  Couette(int around, const std::string& motion, const FlowSettings& settings = viscous_settings())
      : shells(rings_of(around)),
        mesh(ring_mesh(shells)),
        solver(mesh, settings, conditions("[[boundary]]\npatches = [\"rotor_inner\", \"stator_outer\"]\nkind = \"wall\"\n"), nullptr,
               turning_rotor(mesh, shells, Omega, motion, 0.3)) {
    solver.keep_balances({}, {0, 0, 1});
  }
  static Shells rings_of(int around) {
    Shells shells = plane_rings(R1, 0.75, R2, around);
    shells.rotor = {around, around / 8, 1}, shells.stator = {around + around / 8, around / 8, 1};
    return shells;
  }
};

// u = A r + B/r; torque 4 pi mu B L on each cylinder, and so through the interface; shaft power Omega times that, all of it dissipated.
constexpr double A = -Omega * R1 * R1 / (R2 * R2 - R1 * R1), B = Omega * R1 * R1 * R2 * R2 / (R2 * R2 - R1 * R1);

struct CouetteErrors {
  double torque, interface, dissipation, lost, numerical;  // over the exact torque or power
};

CouetteErrors couette_errors(int around, const std::string& motion) {
  Couette couette(around, motion);
  Flow& flow = couette.solver.flow;
  for (int c = 0; c < couette.mesh.n_cells; ++c) {
    const Vec3& x = couette.mesh.cell_centre[c];
    const double turning = A + B / (x.x * x.x + x.y * x.y);
    flow.velocity[c] = {-turning * x.y, turning * x.x, 0};
  }
  const int steps = 5 * around / 2;
  for (int i = 0; i < steps; ++i) couette.solver.advance(10.0 / steps);
  const Balances& now = *couette.solver.balances();
  const double torque = 4 * pi * mu * B * couette.shells.height, power = Omega * torque;
  expect_closed(now, torque, power);
  expect_matters({now.shaft_torque(), now.turning().interface, now.at_rest().walls()}, torque);
  expect_matters({now.energy().shaft, now.energy().dissipation()}, power);
  EXPECT_LT(std::abs(now.turning().interface + now.at_rest().interface), 1e-12 * torque);
  return {now.shaft_torque() / torque - 1, now.turning().interface / torque - 1, now.energy().dissipation() / power - 1,
          (now.turning().lost() + now.at_rest().lost()) / torque, now.energy().numerical() / power};
}

/// Numerical dissipation changes its sign from mesh to mesh: it is below a share that falls with h^2, `numerical_share` of the shaft's
/// power on 24 cells.
void check_couette(const std::string& motion, double numerical_share) {
  std::vector<double> h, torque, dissipation, lost, numerical;
  for (const int around : {24, 32, 48}) {
    const CouetteErrors errors = couette_errors(around, motion);
    h.push_back(1.0 / around), torque.push_back(std::abs(errors.torque)), dissipation.push_back(std::abs(errors.dissipation));
    lost.push_back(std::abs(errors.lost)), numerical.push_back(std::abs(errors.numerical));
    if (rank_of(MPI_COMM_WORLD) == 0)
      std::printf("%s, %d cells around: over the exact, less 1: shaft %.5f, interface %.5f, dissipation %.5f; lost %.5f, numerical %.5f\n",
                  motion.c_str(), around, errors.torque, errors.interface, errors.dissipation, errors.lost, errors.numerical);
    EXPECT_NEAR(errors.interface, 0, 0.05);
    EXPECT_LT(numerical.back(), numerical_share * std::pow(24.0 / around, 2));
  }
  EXPECT_LT(torque.back(), 0.02);
  EXPECT_LT(dissipation.back(), 0.02);
  EXPECT_LT(lost.back(), 0.01);
  EXPECT_GT(observed_order(("lost torque, " + motion).c_str(), h, lost), 1.6);
}

}  // namespace

// Between cylinders the torque through shaft, interface and outer wall and the dissipation are the exact ones, and what is lost vanishes
// with the second power of the cell size.
TEST(Balances, couette_sliding) { check_couette("sliding", 0.025); }
TEST(Balances, couette_frame) { check_couette("frame", 0.006); }

// A cylinder that starts in water at rest: the torque of the shaft is stored, and the growth of the angular momentum of the water over the
// run is the sum of what the rows say.
TEST(Balances, start_from_rest) {
  Couette couette(24, "sliding");
  const Mesh& mesh = couette.mesh;
  const auto angular_momentum = [&] {
    double total = 0;
    for (int c = 0; c < mesh.n_cells; ++c)
      total += rho * mesh.cell_volume[c] * cross(mesh.cell_centre[c], couette.solver.flow.velocity[c]).z;
    return sum(mesh.comm, total);
  };
  couette.solver.advance(0.01);
  const double torque = couette.solver.balances()->shaft_torque();
  double before = angular_momentum(), older = 0, largest = 0;
  for (int i = 0; i < 5; ++i) {
    couette.solver.advance(0.01);
    const Balances& now = *couette.solver.balances();
    const double after = angular_momentum(), stored = now.turning().stored + now.at_rest().stored;
    EXPECT_NEAR(stored, (1.5 * after - 2 * before + 0.5 * older) / 0.01, 1e-9 * torque);  // BDF2
    older = before, before = after, largest = std::max(largest, stored);
    expect_closed(now, torque, Omega * torque);
    expect_matters({stored, now.energy().stored, now.energy().numerical_time}, torque);
  }
  EXPECT_GT(largest, 0.5 * torque);
}

// Water that turns as a solid with its drum, and the mesh with both: what is lost of its angular momentum in the time of one radian, and of
// its energy, falls with the cell size, and is what the rows say it is: what the water loses.
TEST(Balances, solid_body) {
  std::vector<double> h, lost, numerical;
  for (const int around : {16, 24, 36}) {
    Shells shells = plane_rings(R1, 0.75, R2, around);
    Mesh mesh = ring_mesh(shells);
    FlowSolver solver(mesh, viscous_settings(),
                      conditions("[[boundary]]\npatch = \"rotor_inner\"\nkind = \"wall\"\n[[boundary]]\npatch = \"stator_outer\"\n"
                                 "kind = \"moving_wall\"\nrotation_speed = \"1 rad/s\"\n"),
                      nullptr, turning_rotor(mesh, shells, Omega));
    solver.keep_balances({}, {0, 0, 1});
    for (int c = 0; c < mesh.n_cells; ++c) {
      const Vec3& x = mesh.cell_centre[c];
      solver.flow.velocity[c] = {-Omega * x.y, Omega * x.x, 0};
      solver.flow.pressure[c] = 0.5 * rho * Omega * Omega * (x.x * x.x + x.y * x.y);
    }
    const double momentum = rho * Omega * pi / 2 * (std::pow(R2, 4) - std::pow(R1, 4)) * shells.height;
    const int steps = 2 * around;
    double total_lost = 0, total_numerical = 0;
    for (int i = 0; i < steps; ++i) {
      solver.advance(1.0 / steps);
      const Balances& now = *solver.balances();
      expect_closed(now, momentum * Omega, momentum * Omega * Omega);
      total_lost += (now.turning().lost() + now.at_rest().lost()) / momentum / steps;
      total_numerical += now.energy().numerical() / momentum / steps;
    }
    const Balances& now = *solver.balances();
    EXPECT_GT(largest_term(now.turning()), 0);
    EXPECT_LT(now.energy().dissipation(), 1e-3 * momentum);
    if (rank_of(MPI_COMM_WORLD) == 0)
      std::printf("solid body, %d cells around: lost in a radian %.5f, numerical dissipation %.5f, dissipation %.2e\n", around, total_lost,
                  total_numerical, now.energy().dissipation() / momentum);
    h.push_back(1.0 / around), lost.push_back(std::abs(total_lost)), numerical.push_back(std::abs(total_numerical));
  }
  EXPECT_GT(observed_order("solid body, lost", h, lost), 1.6);
  EXPECT_GT(observed_order("solid body, numerical", h, numerical), 1.6);
}

// A swirling stream through a box of distorted tetrahedra with the limiter, with a body in it that pushes the water: every term counts, and
// both rows close.
TEST(Balances, swirling_stream) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.upper = {2, 1, 1}, .distortion = 0.1}, {8, 4, 4});
  const Vec3 origin{0, 0.5, 0.5}, axis{1, 0, 0};
  auto boundary = conditions(
      "[[boundary]]\npatches = [\"y0\", \"y1\", \"z0\"]\nkind = \"wall\"\n[[boundary]]\npatch = \"z1\"\nkind = \"symmetry\"\n"
      "[[boundary]]\npatch = \"x1\"\nkind = \"pressure_outlet\"\n");
  add_exact(
      boundary, "x0",
      [&](const Vec3& x, double t) {
        return Vec3{1, 0, 0} + (1 + t) * cross(axis, x - origin);
      },
      true);
  FlowSettings settings = viscous_settings();
  settings.body_force = {0.1, 0.05, 0.2};
  FlowSolver solver(mesh, settings, std::move(boundary));
  solver.keep_balances(origin, axis);
  solver.flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
  std::vector<double> of_torque(10), of_power(6);  // the largest shares in all steps: a term may pass zero
  const auto take = [](std::vector<double>& largest, const std::vector<double>& terms, double whole) {
    for (std::size_t t = 0; t < terms.size(); ++t) largest[t] = std::max(largest[t], std::abs(terms[t]) / whole);
  };
  for (int i = 0; i < 5; ++i) {
    for (int c = 0; c < mesh.n_cells; ++c)
      solver.flow.reaction[c] = norm(mesh.cell_centre[c] - Vec3{1, 0.5, 0.3}) < 0.3 ? Vec3{0, 3, 0.5} : Vec3{};
    solver.advance(0.02);
    const Balances& now = *solver.balances();
    const AngularMomentumBalance& row = now.at_rest();
    const EnergyBalance& energy = now.energy();
    const double torque = std::abs(row.openings), power = std::abs(energy.hydraulic);
    expect_closed(now, torque, power);
    take(of_torque,
         {row.openings, row.stored, row.walls(), row.given, row.lost_convection, row.lost_pressure, row.lost_friction,
          row.wall_friction[mesh.patch_index("y0")], row.wall_pressure[mesh.patch_index("y0")], row.wall_pressure[mesh.patch_index("z1")]},
         torque);
    take(of_power,
         {energy.given, energy.stored, energy.dissipation_viscous, energy.dissipation_walls, energy.numerical_convection,
          energy.numerical_pressure},
         power);
  }
  expect_matters(of_torque, 1);
  expect_matters(of_power, 1);
}

// The same with turbulence, a sliding zone with a stream through it, tetrahedra, and two outer correctors.
TEST(Balances, stream_through_a_rotor) {
  const Shells shells{.tetrahedra = true};
  Mesh mesh = ring_mesh(shells);
  FlowSettings settings = sharp_settings();
  settings.n_outer_correctors = 2;
  FlowSolver solver(mesh, settings, conditions(R"(
[[boundary]]
patch = "lid_top"
kind = "flow_rate_inlet"
flow_rate_m3_s = 1e-2
[[boundary]]
patch = "stator_bottom"
kind = "pressure_outlet"
[[boundary]]
patches = ["rotor_inner", "rotor_bottom", "lid_inner", "lid_outer", "stator_outer", "stator_top"]
kind = "wall"
)"),
                    read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"k_epsilon\"\n").root()), turning_rotor(mesh, shells, 50));
  solver.keep_balances({}, {0, 0, 1});
  std::vector<double> shares(6);  // of the shaft's power, largest of all steps: some terms change sign
  for (int i = 0; i < 20; ++i) {
    solver.advance(2e-3);
    const Balances& now = *solver.balances();
    const double torque = now.shaft_torque(), power = now.energy().shaft;
    EXPECT_GT(torque, 0);
    expect_closed(now, torque, power);
    EXPECT_LT(std::abs(now.turning().interface + now.at_rest().interface), 1e-12 * torque + 1e-9 * std::abs(now.turning().interface));
    EXPECT_NEAR(power / (50 * torque), 1, 1e-9);
    const EnergyBalance& energy = now.energy();
    const std::array terms{energy.hydraulic,          energy.dissipation_turbulent, energy.dissipation_walls, energy.numerical_convection,
                           energy.numerical_pressure, energy.numerical_time};
    for (std::size_t k = 0; k < terms.size(); ++k) shares[k] = std::max(shares[k], std::abs(terms[k]) / power);
  }
  expect_matters(shares, 1);
}
