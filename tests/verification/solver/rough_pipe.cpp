// ranks: 1
// Requirement: with the models that have wall functions a rough wall takes as much velocity as Colebrook's formula says; models without a
// law for it refuse it.
#include <gtest/gtest.h>

#include "tests/verification/solver/developed_turbulence.hpp"
#include "tests/verification/solver/developing_flow.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double radius = 0.1;  // m

constexpr double G = 168;  // pressure gradient, Pa/m

struct DevelopedPipe {
  double over_colebrook;        // friction over Colebrook's at the Reynolds number found
  double over_one_dimensional;  // mean velocity over that of the one-dimensional solution with as many cells
  double in_wall_units;         // mean velocity over the friction velocity
};

/// Mean velocity over the friction velocity by Colebrook's formula, which is explicit in them.
double by_colebrook(double friction_velocity, double roughness) {
  const DevelopedFlow water;
  const double Re_root_f = std::sqrt(8) * 2 * radius * friction_velocity * water.rho / water.mu;
  return -2 * std::sqrt(8) * std::log10(roughness / (2 * radius) / 3.7 + 2.51 / Re_root_f);
}

const double friction_velocity = std::sqrt(G * radius / 2 / DevelopedFlow().rho);

/// A pipe of n uniform cells over its radius, of roughness k_s, m, from the velocity `speed` on.
DevelopedPipe pipe(const std::string& model, int n, double roughness, double speed) {
  std::string boundary = sector_boundary;
  const std::string wall = "kind = \"wall\"";
  boundary.replace(boundary.find(wall), wall.size(), wall + "\nroughness_height_m = " + std::to_string(roughness));
  const double U = develop(pipe_sector(rings(n, 0.5 * radius / n, radius)), boundary, G, 0.5, model, speed).mean_velocity;
  const DevelopedFlow reference{.radius = radius, .n = n, .realizable = model != "k_epsilon", .roughness = roughness};
  const double Re = 2 * radius * U * reference.rho / reference.mu;
  const DevelopedPipe found{G * 2 * radius / (0.5 * reference.rho * U * U) / colebrook(Re, roughness / (2 * radius)),
                            U / reference.mean_velocity(G), U / friction_velocity};
  std::printf("%s, %d cells: Re %.0f, k_s/D %.5f, k_s+ %.1f: friction over Colebrook's - 1: %.4f, U over the one-dimensional - 1: %.4f\n",
              model.c_str(), n, Re, roughness / (2 * radius), friction_velocity * roughness * reference.rho / reference.mu,
              found.over_colebrook - 1, found.over_one_dimensional - 1);
  return found;
}

}  // namespace

// Smooth: the mean velocity of the realizable model at Re 4.5e5 is that of its one-dimensional solution within 1.5 %, y+ 110 to 440 at the
// wall. Its friction is 4 to 7 % below Colebrook's formula.
TEST(RoughPipe, smooth_realizable) {
  for (const int n : {10, 20, 40}) {
    const DevelopedPipe found = pipe("realizable_k_epsilon", n, 0, 2.3);
    EXPECT_NEAR(found.over_one_dimensional, 1, 0.015);
    EXPECT_LT(found.over_colebrook, 0.96);
    EXPECT_GT(found.over_colebrook, 0.93);
  }
}

// Rough, from k_s+ 5 to fully rough, k_s/D up to 0.01: what the wall takes of the mean velocity in wall units is that of Colebrook's
// formula within 5 %, with either model.
TEST(RoughPipe, velocity_that_roughness_takes) {
  for (const char* model : {"k_epsilon", "realizable_k_epsilon"}) {
    const double smooth = pipe(model, 20, 0, 2.3).in_wall_units;
    for (const double roughness : {5e-5, 2e-4, 5e-4, 2e-3}) {
      const DevelopedPipe found = pipe(model, 20, roughness, 2);
      const double taken = smooth - found.in_wall_units,
                   expected = by_colebrook(friction_velocity, 0) - by_colebrook(friction_velocity, roughness);
      std::printf("  taken by roughness: %.3f, by Colebrook's formula %.3f\n", taken, expected);
      EXPECT_NEAR(taken / expected, 1, 0.05) << roughness;
      EXPECT_NEAR(found.over_one_dimensional, 1, 0.015) << roughness;
    }
  }
}

// A model without a law for rough walls refuses them, and names those that have one.
TEST(RoughPipe, refused) {
  const Mesh mesh = pipe_sector(rings(5, 0.1 * radius, radius));
  for (const char* model : {"laminar", "k_omega_sst"}) {
    try {
      FlowSolver(mesh, {}, conditions(R"(
[[boundary]]
patch = "wall"
kind = "wall"
roughness_height = "0.2 mm"
[[boundary]]
patches = ["low", "high"]
kind = "symmetry"
)"),
                 read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"" + std::string(model) + "\"\n").root()));
      FAIL() << model;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find("realizable_k_epsilon"), std::string::npos);
    }
  }
}
