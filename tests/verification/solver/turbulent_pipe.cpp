// ranks: 1
#include <gtest/gtest.h>

#include "tests/verification/solver/developed_turbulence.hpp"
#include "tests/verification/solver/developing_flow.hpp"
#include "tests/verification/solver/pipe_sector.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double radius = 0.1;  // m

}  // namespace

// The pressure gradient of a developed pipe flow at Re 4.5e5 is that of the one-dimensional solution within 1.5 % and Colebrook's within
// 5 %, whether the cells at the wall have y+ 110 or 440.
TEST(TurbulentPipe, pressure_gradient) {
  for (const int n : {10, 20, 40}) {
    constexpr double G = 168;  // Pa/m
    const double U = develop(pipe_sector(rings(n, 0.5 * radius / n, radius)), sector_boundary, G, 0.5).mean_velocity;
    const DevelopedFlow reference{.radius = radius, .m = 1, .n = 100};
    const double Re = reference.rho * U * 2 * radius / reference.mu,
                 by_colebrook = colebrook(Re) * 0.5 * reference.rho * U * U / (2 * radius);
    std::printf("n %d: Re %.0f, one-dimensional %.2f Pa/m, Colebrook %.2f Pa/m, here %.2f Pa/m\n", n, Re, reference.pressure_gradient(U),
                by_colebrook, G);
    EXPECT_NEAR(G / reference.pressure_gradient(U), 1, 0.015);
    EXPECT_NEAR(G / by_colebrook, 1, 0.05);
    EXPECT_NEAR(Re, 4.5e5, 0.1e5);
  }
}

// Cells at the wall that are thinner than the viscous layer do not change friction: at y+ 1, 3 and 5 it is that at y+ 100 within 4 %.
TEST(TurbulentPipe, thin_cells_at_the_wall) {
  constexpr double G = 168, y_plus_one = 1.09e-5;  // Pa/m, m
  const auto velocity = [&](double y_plus, double dt) {
    return develop(pipe_sector(rings(20, y_plus * y_plus_one, radius)), sector_boundary, G, dt).mean_velocity;
  };
  const double thick = velocity(100, 0.5);
  for (const double y_plus : {1.0, 3.0, 5.0}) {
    const double U = velocity(y_plus, 5e-3);
    std::printf("y+ %g: friction over that at 100 - 1: %.4f\n", y_plus, thick * thick / (U * U) - 1);
    EXPECT_NEAR(thick * thick / (U * U), 1, 0.04);
  }
}

// The same of a plane channel on hexahedra within 1.5 %, and on tetrahedra, whose cells at the wall differ in distance, within 3 %.
TEST(TurbulentChannel, pressure_gradient) {
  constexpr double G = 80;
  const char* const half_channel = R"(
[[boundary]]
patch = "z0"
kind = "wall"
[[boundary]]
patch = "z1"
kind = "symmetry"
)";
  const DevelopedFlow reference{.radius = radius, .m = 0, .n = 100};
  const auto difference = [&](const Mesh& mesh, double dt) {
    return G / reference.pressure_gradient(develop(mesh, half_channel, G, dt).mean_velocity) - 1;
  };
  const double hexahedra = difference(structured_box(MPI_COMM_WORLD, {}, {0.4, 0.4, radius}, {2, 2, 20}, {true, true, false}), 0.5);
  const double tetrahedra = difference(
      tetrahedral_box(MPI_COMM_WORLD, {.upper = {0.03, 0.03, radius}, .distortion = 0.1}, {3, 3, 12}, {true, true, false}), 0.02);
  std::printf("channel: pressure gradient over the one-dimensional one - 1: hexahedra %.4f, tetrahedra %.4f\n", hexahedra, tetrahedra);
  EXPECT_NEAR(hexahedra, 0, 0.015);
  EXPECT_NEAR(tetrahedra, 0, 0.03);
}
