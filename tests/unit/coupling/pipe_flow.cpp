// Modes of the water in a pipe: free of divergence, with the flow rate as it was, and exact where the flow is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "coupling/pipe_flow.hpp"
#include "coupling/prescribed_field.hpp"
#include "dem/rag_system.hpp"
#include "dem/templates/rag_settings.hpp"
#include "solver/fields/flow.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

constexpr double R = 0.1, U = 2;

PipeFlow bent() {
  PipeFlow pipe;
  pipe.point = {0.1, -0.2, 0.05}, pipe.axis = {2, 0, 0}, pipe.radius = R;
  pipe.bend_radius = 0.3, pipe.bend_angle = std::numbers::pi / 2, pipe.bend_inside = {0.5, -1, 0};
  pipe.prepare();
  return pipe;
}

/// Place at the way s along the axis (negative: before the point) and at a, b in the section, towards the inside and along t x c.
struct CrossSection {
  Vec3 centre, tangent, inside, binormal;
  CrossSection(const PipeFlow& pipe, double s) {
    const double around = std::clamp(-s / pipe.bend_radius, 0.0, pipe.bend_angle), c = std::cos(around), n = std::sin(around);
    const Vec3 middle = pipe.point + pipe.bend_radius * pipe.bend_inside;
    tangent = c * pipe.axis - n * pipe.bend_inside, inside = c * pipe.bend_inside + n * pipe.axis, binormal = cross(tangent, inside);
    centre = middle - pipe.bend_radius * inside + (s + around * pipe.bend_radius) * tangent;
  }
  Vec3 at(double r, double angle) const { return centre + r * std::cos(angle) * inside + r * std::sin(angle) * binormal; }
};

const std::array ways{-0.7, -0.4, -0.2, -0.05, 0.3};  // m: before the bend, in it, behind it

PipeFlow with(double PipeFlow::*mode, double strength) {
  PipeFlow pipe = bent();
  pipe.*mode = strength;
  return pipe;
}

const std::array modes{&PipeFlow::swirl, &PipeFlow::profile, &PipeFlow::profile_power_law, &PipeFlow::vortices};

// Requirement: no mode has a divergence, in the straight parts and in the bend.
TEST(PipeFlow, ModesAreFreeOfDivergence) {
  for (double PipeFlow::*mode : modes) {
    const PipeFlow pipe = with(mode, 0.3);
    for (const double s : ways)
      for (const double r : {0.02, 0.06, 0.09})
        for (const double angle : {0.3, 1.9, 4.0}) {
          const Mat3 G = pipe.gradient(CrossSection(pipe, s).at(r, angle), U);
          EXPECT_NEAR(G[0].x + G[1].y + G[2].z, 0, 1e-5 * U / R) << s << ", " << r << ", " << angle;
        }
  }
}

// Requirement: no mode changes the flow rate through a section, and none but the profiles, which slip, moves water along or through the
// wall.
TEST(PipeFlow, FlowRateAndWallStay) {
  for (double PipeFlow::*mode : modes) {
    const PipeFlow pipe = with(mode, 0.3);
    for (const double s : ways) {
      const CrossSection section(pipe, s);
      double rate = 0, moved = 0;
      constexpr int n_r = 1000, n_angle = 24;
      for (int i = 0; i < n_r; ++i)
        for (int j = 0; j < n_angle; ++j) {
          // By s, 1 - r/R = s^7, in which the power law of 1/7 is smooth.
          const double s7 = (i + 0.5) / n_r, r = R * (1 - std::pow(s7, 7)), angle = (j + 0.5) * 2 * std::numbers::pi / n_angle;
          const double area = 7 * std::pow(s7, 6) * r / (n_r * n_angle);
          const Vec3 u = pipe.velocity(section.at(r, angle), U);
          rate += dot(u, section.tangent) * area, moved += norm(u) * area;
        }
      if (moved > 0) {
        EXPECT_NEAR(rate / moved, 0, 2e-5) << s;
      }
      for (const double angle : {0.0, 1.0, 3.0}) {
        const Vec3 at_wall = section.at(R * (1 - 1e-9), angle), out = unit(at_wall - section.centre), u = pipe.velocity(at_wall, U);
        EXPECT_NEAR(dot(u, out), 0, 1e-6) << s;
        EXPECT_EQ(norm(pipe.velocity(section.at(1.01 * R, angle), U)), 0);
      }
    }
  }
}

// Requirement: the strengths are what the manual says: speed about the axis at the wall, Poiseuille's profile and the power law of 1/7 less
// the flat one, speed on the axis towards the outside of the bend, half of it in the middle of the bend and none before it.
TEST(PipeFlow, StrengthsAreSpeedsOverTheMean) {
  for (const double s : {-0.7, 0.3}) {
    const PipeFlow swirl = with(&PipeFlow::swirl, 0.2), profile = with(&PipeFlow::profile, 1);
    const CrossSection section(swirl, s);
    const Vec3 u = swirl.velocity(section.at(0.999999 * R, 0), U);
    EXPECT_NEAR(dot(u, section.binormal), 0.2 * U, 1e-5);  // right-handed: from c towards t x c
    const PipeFlow turbulent = with(&PipeFlow::profile_power_law, 11.0 / 49);
    for (const double r : {0.0, 0.03, 0.08}) {
      EXPECT_NEAR(U + dot(profile.velocity(section.at(r, 1), U), section.tangent), 2 * U * (1 - r * r / (R * R)), 1e-12);
      EXPECT_NEAR(U + dot(turbulent.velocity(section.at(r, 1), U), section.tangent), 60.0 / 49 * U * std::pow(1 - r / R, 1.0 / 7), 1e-12);
    }
    const Vec3 at_wall = turbulent.velocity(section.at(R * (1 - 1e-9), 1), U);
    EXPECT_NEAR(dot(at_wall, section.tangent), U * (60.0 / 49 * std::pow(1e-9, 1.0 / 7) - 1),
                1e-6 * U);  // of U nothing is left at the wall
  }
  const PipeFlow pair = with(&PipeFlow::vortices, 0.2);
  const double bend = pair.bend_radius * pair.bend_angle;
  for (const auto& [s, share] : {std::array{-1.5 * bend, 0.0}, std::array{-0.5 * bend, 0.5}, std::array{0.3, 1.0}}) {
    const CrossSection section(pair, s);
    EXPECT_NEAR(dot(pair.velocity(section.centre, U), section.inside), -0.2 * U * share, 1e-9) << s;
    EXPECT_GE(dot(pair.velocity(section.at(0.8 * R, std::numbers::pi / 2), U), section.inside), 0) << s;  // and back along the wall
  }
}

// Requirement: gradients are those of the velocities.
TEST(PipeFlow, GradientsFit) {
  PipeFlow pipe = bent();
  pipe.swirl = 0.1, pipe.profile = -0.3, pipe.profile_power_law = 0.1, pipe.vortices = 0.2;
  constexpr double step = 1e-5;
  for (const double s : {-0.7, -0.2, 0.3}) {
    const Vec3 x = CrossSection(pipe, s).at(0.05, 0.7);
    const Mat3 G = pipe.gradient(x, U);
    for (int j = 0; j < 3; ++j) {
      Vec3 after = x, before = x;
      after[j] += step, before[j] -= step;
      const Vec3 slope = (pipe.velocity(after, U) - pipe.velocity(before, U)) / (2 * step);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(G[i][j], slope[i], 1e-5 * U / R) << i << j;
    }
  }
}

// Requirement: a steady flow of cells with swirl is a solid rotation on top of it: velocity, gradient and fluxes, and the pressure that
// holds it on its circles, rho Omega^2 o; its mean speed is found from the cells of the pipe.
TEST(PipeFlow, SwirlOfCellsIsASolidRotation) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, -R, -R}, {0.4, R, R}, {8, 10, 10}, {false, false, false});
  Flow flow(mesh);
  for (Vec3& u : flow.velocity) u = {U, 0, 0};
  for (int f = 0; f < mesh.n_faces; ++f) flow.flux[f] = U * mesh.face_vector[f].x;
  PipeFlow pipe;
  pipe.radius = R, pipe.swirl = 0.3;
  pipe.prepare();
  add_pipe_flow(flow, pipe);
  const double omega = 0.3 * U / R;
  std::vector<double> out(static_cast<std::size_t>(mesh.n_all_cells()), 0.0);
  for (int f = 0; f < mesh.n_faces; ++f) {
    out[mesh.owner[f]] += flow.flux[f];
    if (f < mesh.n_interior) out[mesh.neighbour[f]] -= flow.flux[f];
  }
  int n = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 o{0, mesh.cell_centre[c].y, mesh.cell_centre[c].z};
    if (norm(o) > 0.7 * R) continue;
    ++n;
    EXPECT_NEAR(norm(flow.velocity[c] - Vec3{U, -omega * o.z, omega * o.y}), 0, 1e-12);
    EXPECT_NEAR(norm(flow.pressure_gradient[c] - flow.density * omega * omega * o), 0, 1e-6 * flow.density * omega * omega * R);
    EXPECT_NEAR(flow.velocity_gradient[c][2].y, omega, 1e-8 * omega);
    EXPECT_NEAR(out[c], 0, 1e-15);
  }
  EXPECT_GT(n, 100);
}

// Requirement: in a prescribed flow particles feel the modes with their gradient and acceleration: a profile of 1 is Poiseuille's flow, and
// with swirl Du/Dt points to the axis.
TEST(PipeFlow, PrescribedFlowHasTheModes) {
  RagSettings settings(RagSettings::Shape::particle);
  settings.position = {0.2, 0.03, -0.04};
  const RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  PrescribedFlow flow;
  flow.velocity = {U, 0, 0};
  flow.pipe.radius = R, flow.pipe.profile = 1, flow.pipe.swirl = 0.3;
  flow.pipe.prepare();
  PrescribedField field(flow);
  field.sample(rags.tiles(), {.velocity_gradient = true, .material_acceleration = true});
  const Tile& tile = rags.tiles()[0];
  const FluidSamples fluid = field.at(0, tile, 0, 0);
  const int p = tile.index(0, 0);
  const double omega = 0.3 * U / R, share = 1 - 0.05 * 0.05 / (R * R);
  EXPECT_NEAR(norm(fluid.velocity[p] - Vec3{2 * U * share, omega * 0.04, omega * 0.03}), 0, 1e-12);
  EXPECT_NEAR(norm(fluid.material_acceleration[p] - omega * omega * Vec3{0, -0.03, 0.04}), 0, 1e-6);
  EXPECT_NEAR(fluid.velocity_gradient[0][p].y, -4 * U * 0.03 / (R * R), 1e-6);
  EXPECT_NEAR(fluid.velocity_gradient[1][p].z, -omega, 1e-8);
}

// Requirement: a pipe that cannot be is refused.
TEST(PipeFlow, RefusesWhatIsNoPipe) {
  PipeFlow none, point, curled, straight, flat;
  point.radius = curled.radius = straight.radius = flat.radius = R;
  point.axis = {};
  curled.bend_radius = 0.9 * R, curled.bend_angle = 1;
  straight.vortices = 0.1;
  flat.bend_radius = 0.3, flat.bend_angle = 1, flat.bend_inside = {1, 0, 0};
  for (PipeFlow* pipe : {&none, &point, &curled, &straight, &flat}) EXPECT_THROW(pipe->prepare(), Error);
}

}  // namespace
}  // namespace snag
