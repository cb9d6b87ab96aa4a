// ranks: 1 3
// long ranks: 2 5
#include <gtest/gtest.h>

#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const Vec3 stream{1, -0.4, 0.3};        // m/s
constexpr double speed = 50;            // of the zone, rad/s: 2.5 m/s at the interface
constexpr int steps = 130, turns = 10;  // no step falls on the same angle as another

struct Deviation {
  double velocity = 0, pressure = 0, flux = 0;  // over |U|, rho |U|^2, |U| |S|
};

/// Largest of all cells, faces and steps.
Deviation deviation(const Shells& shells, bool has_outlet) {
  Mesh mesh = ring_mesh(shells);
  auto zone = turning_rotor(mesh, shells, speed);
  std::vector<PatchBoundary> boundary;
  for (const Patch& patch : mesh.patches)
    if (!has_outlet || patch.name != "lid_top")
      add_exact(
          boundary, patch.name, [](const Vec3&, double) { return stream; }, true);
  if (has_outlet)
    for (PatchBoundary& outlet : conditions("[[boundary]]\npatch = \"lid_top\"\nkind = \"pressure_outlet\"\n"))
      boundary.push_back(std::move(outlet));
  FlowSettings settings = sharp_settings();
  settings.initial_velocity = stream;
  settings.momentum_tolerance = settings.pressure_tolerance = settings.pressure_tolerance_intermediate = 1e-13;
  FlowSolver solver(mesh, settings, std::move(boundary), nullptr, std::move(zone));
  const Flow& flow = solver.flow;
  Deviation worst;
  for (int i = 0; i < steps; ++i) {
    solver.advance(2 * pi * turns / (speed * steps));
    for (int c = 0; c < mesh.n_cells; ++c) {
      worst.velocity = std::max(worst.velocity, norm(flow.velocity[c] - stream) / norm(stream));
      worst.pressure = std::max(worst.pressure, std::abs(flow.pressure[c]) / (flow.density * norm_squared(stream)));
    }
    for (int f = 0; f < mesh.n_faces; ++f) {
      const Vec3& S = mesh.face_vector[f];
      worst.flux = std::max(worst.flux,
                            std::abs(flow.flux[f] - dot(stream, S)) / (norm(stream) * std::pow(mesh.cell_volume[mesh.owner[f]], 2.0 / 3)));
    }
  }
  return {maximum(mesh.comm, worst.velocity), maximum(mesh.comm, worst.pressure), maximum(mesh.comm, worst.flux)};
}

void expect_undisturbed(const Shells& shells, bool has_outlet) {
  const Deviation d = deviation(shells, has_outlet);
  if (rank_of(MPI_COMM_WORLD) == 0) std::printf("velocity %.1e, pressure %.1e, flux %.1e\n", d.velocity, d.pressure, d.flux);
  EXPECT_LT(d.velocity, 1e-11);
  EXPECT_LT(d.pressure, 1e-10);
  EXPECT_LT(d.flux, 1e-11);
}

}  // namespace

// A uniform stream through a turning drum with a lid stays uniform to round-off through ten turns, whatever the meshes of both sides.
TEST(SlidingFreeStream, meshes_that_do_not_match) { expect_undisturbed({.tetrahedra = false}, false); }

TEST(SlidingFreeStream, tetrahedra_about_an_oblique_axis_and_an_outlet) {
  expect_undisturbed({.rotor = {10, 2, 3}, .stator = {12, 2, 3}, .origin = {0.3, -0.2, 0.1}, .axis = {0.2, -0.1, 0.5}}, true);
}

TEST(SlidingFreeStream, meshes_that_coincide) {
  expect_undisturbed({.rotor = {13, 2, 3}, .stator = {13, 2, 3}, .stator_start = 0, .tetrahedra = false}, true);
}
