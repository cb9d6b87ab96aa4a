// ranks: 1 3
// long ranks: 2
// Walls of a turning zone.
#include <gtest/gtest.h>

#include <functional>

#include "mesh/import/import.hpp"
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"
#include "tests/unit/mesh/sliding_shells.hpp"

using namespace snag;

namespace {

constexpr double full_speed = 20, ramp = 0.4;  // rad/s, s

/// Two rings, all of whose walls are one patch.
Mesh shells(const test::Shells& shape) {
  const test::TemporaryFile file(test::sample_of(shape), test::Format::ascii22);
  return import_mesh(file.path(), MPI_COMM_WORLD, {});
}

struct Expected {
  Vec3 velocity, acceleration;  // of a face that turns, at its centre
};

/// Two steps of 0.05 s, within the ramp, and all faces of the wall against what is expected where they turn; the others rest.
void check_walls(const std::string& motion, const std::string& keys,
                 const std::function<Expected(const Vec3& from_axis, double time)>& expected) {
  SCOPED_TRACE(motion + " " + keys);
  const test::Shells shape{.origin = {0.3, -0.2, 0.1}, .axis = {1, -2, 0.5}};
  Mesh mesh = shells(shape);
  RotatingZoneSettings settings;
  settings.zone = "rotor", settings.motion.choose(motion), settings.origin = shape.origin, settings.axis = shape.axis;
  settings.speed = full_speed, settings.ramp = ramp;
  auto zone = std::make_unique<RotatingZone>(mesh, settings);
  FlowSolver solver(mesh, {}, read_boundaries(CaseFile::parse("[[boundary]]\npatch = \"wall\"\nkind = \"wall\"\n" + keys).root()), nullptr,
                    std::move(zone));
  for (int i = 0; i < 2; ++i) solver.advance(0.05);
  const Patch& patch = mesh.patches[mesh.patch_index("wall")];
  std::int64_t n_turning = 0, n_resting = 0;
  for (int f = patch.first; f < patch.end(); ++f) {
    const int b = f - mesh.n_interior;
    const bool turns = mesh.zones[mesh.cell_zone[mesh.owner[f]]] == "rotor";
    const Expected wanted = turns ? expected(mesh.face_centre[f] - shape.origin, solver.flow.time) : Expected{};
    EXPECT_LT(norm(solver.boundary().values().velocity[b] - wanted.velocity), 1e-12);
    EXPECT_LT(norm(solver.boundary().values().acceleration[b] - wanted.acceleration), 1e-10);
    EXPECT_EQ(solver.boundary().values().flux[b], solver.flow.mesh_flux[f]);
    ++(turns ? n_turning : n_resting);
  }
  EXPECT_GT(sum(mesh.comm, n_turning), 0);
  EXPECT_GT(sum(mesh.comm, n_resting), 0);
}

}  // namespace

// Where its cells turn a wall turns with them, the mesh sliding or seen from the turning frame; the rest of the same patch is at rest.
TEST(TurningWall, turns_with_its_cells) {
  const Vec3 axis = unit({1, -2, 0.5});
  for (const char* motion : {"sliding", "frame"})
    check_walls(motion, "", [&](const Vec3& r, double time) {
      const Vec3 omega = full_speed * time / ramp * axis, change = full_speed / ramp * axis, u = cross(omega, r);
      return Expected{u, cross(omega, u) + cross(change, r)};
    });
}

// A wall that is told to stay is at rest, though the mesh slides along it.
TEST(TurningWall, may_be_fixed) {
  for (const char* motion : {"sliding", "frame"})
    check_walls(motion, "stationary = true\n", [](const Vec3&, double) { return Expected{}; });
}
