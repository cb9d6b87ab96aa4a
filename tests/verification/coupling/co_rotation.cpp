// A neutral cloth in water that turns as a solid turns with it: what the exact motion is of everything that is as dense as water.
//
//   u = omega x r,   Du/Dt = - omega^2 r;   the cloth at radius r with v = u stays at r
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "dem/particles/tile_particles.hpp"
#include "sphere_motion.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

constexpr double speed = 20 * std::numbers::pi;  // 1/s: half the speed of the shipped pumps, a turn in 0.1 s
constexpr double radius = 0.06;                  // m

RagPiece cloth(double particle_radius, const Vec3& lengthwise, const Vec3& crosswise) {
  RagSettings settings(RagSettings::Shape::rag);
  settings.length = 0.04, settings.width = 0.03, settings.radius = particle_radius;
  settings.properties = RagSettings::Properties::custom;  // calibrated for 2 mm at most; here only limp and tight
  settings.along = published_bond(std::min(particle_radius, 2e-3), 0), settings.across = published_bond(std::min(particle_radius, 2e-3), 1);
  settings.mass_per_area = 998.2 * settings.thickness;
  settings.position = {radius, 0, 0}, settings.lengthwise = lengthwise, settings.crosswise = crosswise;
  settings.velocity = {0, speed * radius, 0}, settings.spin = {0, 0, speed};
  return make_piece(settings, "test");
}

/// Distance of the centroid from the axis after one turn, over that at the begin.
double after_a_turn(const RagPiece& piece, const std::string& forces) {
  PrescribedFlow flow;
  flow.gradient[0] = {0, -speed, 0}, flow.gradient[1] = {speed, 0, 0};
  PieceInFlow run(piece, "[coupling]\n" + forces, flow);
  const auto distance = [&] {
    Vec3 sum;
    int n = 0;
    for (const Tile& tile : run.rags.tiles()) for_particles(tile, [&](int k, int, int) { sum += tile.vector(Tile::x, k), ++n; });
    return std::hypot(sum.x, sum.y) / n;
  };
  const double before = distance();
  run.advance(2 * std::numbers::pi / speed, 100);
  return distance() / before;
}

// Requirement: with the forces that a case gets when it names none a neutral cloth stays within 2 % of its radius for a turn, for particles
// of 1 to 5 mm, along the radius and across it. With the published forces, without the inertia of the water, it is thrown out.
TEST(CoRotation, NeutralClothStays) {
  for (const double r : {1e-3, 2e-3, 5e-3})
    for (const Vec3& lengthwise : {Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
      const double left = after_a_turn(cloth(r, lengthwise, {0, 0, 1}), "");
      std::printf("  particles of %g mm, %s: %.4f of the radius\n", 1e3 * r, lengthwise.x == 0 ? "along the stream" : "across it", left);
      EXPECT_NEAR(left, 1, 0.02);
    }
  EXPECT_GT(after_a_turn(cloth(2e-3, {0, 1, 0}, {0, 0, 1}), "forces = [\"published\"]\n"), 1.5);
}

/// Distance of a neutral sphere from the axis after one turn in so many steps of one sub-step each, over that at the begin; `make` makes
/// the coupled run of its rags.
template <class Make>
double sphere_after_a_turn(int steps, const Make& make) {
  RagSystem rags(MPI_COMM_SELF, {}, {sphere_piece(2e-4, 998.2, {radius, 0, 0}, {0, speed * radius, 0})});
  CoupledSolver solver = make(rags);
  for (int n = 0; n < steps; ++n) solver.step(2 * std::numbers::pi / speed / steps);
  EXPECT_EQ(rags.n_sub_steps(), steps);
  const Tile& tile = rags.tiles()[0];
  const Vec3 x = tile.vector(Tile::x, tile.index(0, 0));
  return std::hypot(x.x, x.y) / radius;
}

/// Second order of the deviation from the radius in the length of the sub-steps.
template <class Make>
void expect_second_order(const char* name, const Make& make) {
  std::vector<double> errors;
  for (const int steps : {50, 100, 200}) errors.push_back(std::abs(sphere_after_a_turn(steps, make) - 1));
  const double order = std::log2(errors[0] / errors[2]) / 2;
  std::printf("  %s: error of the radius %.2e %.2e %.2e, order %.2f\n", name, errors[0], errors[1], errors[2], order);
  EXPECT_GT(order, 1.8);
  EXPECT_LT(errors[1], 2e-3);
}

Coupling sphere_forces() {
  return read_coupling(
      CaseFile::parse("[coupling]\nmode = \"one_way\"\nkernel = \"cell\"\nforces = [\"schiller_naumann\", \"pressure_gradient\", "
                      "\"added_mass\"]\n")
          .root(),
      false);
}

// Requirement: a small neutral sphere, which the drag ties to the water within a sub-step, leaves its radius by an error of second order in
// the sub-step, in a prescribed flow and in one of cells.
TEST(CoRotation, SphereStaysToSecondOrder) {
  PrescribedFlow prescribed;
  prescribed.gradient[0] = {0, -speed, 0}, prescribed.gradient[1] = {speed, 0, 0};
  expect_second_order("prescribed", [&](RagSystem& rags) { return CoupledSolver(sphere_forces(), rags, prescribed); });

  const Mesh mesh = structured_box(MPI_COMM_SELF, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, {10, 10, 10});
  Flow flow(mesh);
  const auto u = [](const Vec3& x) { return cross({0, 0, speed}, x); };
  for (int c = 0; c < mesh.n_all_cells(); ++c) flow.velocity[c] = u(mesh.cell_centre[c]), flow.velocity_gradient[c] = prescribed.gradient;
  flow.velocity_older = flow.velocity_old = flow.velocity;
  for (int f = 0; f < mesh.n_faces; ++f) flow.flux[f] = dot(u(mesh.face_centre[f]), mesh.face_vector[f]);
  expect_second_order("cells", [&](RagSystem& rags) { return CoupledSolver(sphere_forces(), rags, flow, [](double) {}); });
}

}  // namespace
}  // namespace snag
