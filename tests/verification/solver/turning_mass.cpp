// ranks: 1 2
// long ranks: 3
#include <gtest/gtest.h>

#include "tests/verification/solver/turning_rings.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double flow_rate = 1e-3;  // m3/s
constexpr const char* boundary = R"(
[[boundary]]
patch = "lid_top"
kind = "flow_rate_inlet"
flow_rate_m3_s = 1e-3
[[boundary]]
patch = "stator_bottom"
kind = "pressure_outlet"
[[boundary]]
patches = ["rotor_inner", "rotor_bottom", "lid_inner", "lid_outer", "stator_outer", "stator_top"]
kind = "wall"
)";

/// Net flux through the facets of the disc or of the cylinder, out of the rotor.
double out_of_rotor(const Flow& flow, const Shells& shells, bool of_disc) {
  const Mesh& mesh = flow.mesh;
  double total = 0;
  for (int f = mesh.first_facet; f < mesh.n_interior; ++f) {
    const bool on_disc = std::abs(mesh.face_centre[f].z - shells.height) < 1e-9;
    if (on_disc != of_disc || mesh.owner[f] >= mesh.n_cells) continue;
    total += mesh.cell_zone[mesh.owner[f]] == flow.rotating_zone->zone() ? flow.flux[f] : -flow.flux[f];
  }
  return sum(mesh.comm, total);
}

void expect_mass_kept(const std::string& motion, bool tetrahedra) {
  const Shells shells{.tetrahedra = tetrahedra};
  Mesh mesh = ring_mesh(shells);
  auto zone = turning_rotor(mesh, shells, 50, motion);
  FlowSolver solver(mesh, FlowSettings{}, conditions(boundary), nullptr, std::move(zone));
  double domain = 0, disc = 0, cylinder = 0;
  for (int i = 0; i < 40; ++i) {
    const StepReport report = solver.advance(2e-3);
    domain = std::max(domain, std::abs(report.continuity_global) / flow_rate);
    disc = std::max(disc, std::abs(out_of_rotor(solver.flow, shells, true) / flow_rate + 1));
    cylinder = std::max(cylinder, std::abs(out_of_rotor(solver.flow, shells, false) / flow_rate - 1));
  }
  if (rank_of(MPI_COMM_WORLD) == 0)
    std::printf("%s: lost of the flow through the domain %.1e, through the disc %.1e, through the cylinder %.1e\n", motion.c_str(), domain,
                disc, cylinder);
  EXPECT_LT(domain, 1e-6);
  EXPECT_LT(disc, 1e-6);
  EXPECT_LT(cylinder, 1e-6);
}

}  // namespace

// At the default tolerances the flow that enters through the lid passes the disc and the cylinder of the interface and leaves, at every
// step.
TEST(TurningMass, sliding) {
  for (const bool tetrahedra : {false, true}) expect_mass_kept("sliding", tetrahedra);
}

TEST(TurningMass, frame) { expect_mass_kept("frame", false); }

// A closed drum needs no patch that fixes the pressure: its walls let nothing pass but round-off. The water nowhere becomes faster than the
// wall that drives it, with steps of half a cell of the interface too.
TEST(TurningMass, closed) {
  for (const bool tetrahedra : {false, true}) {
    const Shells shells{.tetrahedra = tetrahedra};
    Mesh mesh = ring_mesh(shells);
    auto zone = turning_rotor(mesh, shells, 125);
    std::string walls;
    for (const Patch& patch : mesh.patches) walls += (walls.empty() ? "\"" : ", \"") + patch.name + "\"";
    FlowSolver solver(mesh, FlowSettings{}, conditions("[[boundary]]\npatches = [" + walls + "]\nkind = \"wall\"\n"), nullptr,
                      std::move(zone));
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      solver.advance(2e-3);
      for (int c = 0; c < mesh.n_cells; ++c) fastest = std::max(fastest, norm(solver.flow.velocity[c]));
    }
    EXPECT_LT(maximum(mesh.comm, fastest), 125 * shells.radius);
    EXPECT_GT(maximum(mesh.comm, fastest), 0.2 * 125 * shells.inner);
  }
}
