// ranks: 1 2
// Bounds on the water: each is passed on purpose, and the message says where, why and what to do.
#include "solver/divergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "case_texts.hpp"
#include "solver/flow_solver.hpp"
#include "tests/structured_box.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const char* const channel =
    "[[boundary]]\npatch = \"x0\"\nkind = \"velocity_inlet\"\nvelocity_m_s = [1, 0, 0]\n"
    "[[boundary]]\npatch = \"x1\"\nkind = \"pressure_outlet\"\n"
    "[[boundary]]\npatches = [\"y0\", \"y1\", \"z0\", \"z1\"]\nkind = \"wall\"\n";

/// Water that flows with 1 m/s, and its watch.
struct Watched {
  Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {4, 1, 1}, {8, 4, 4});
  BoundarySet boundary{mesh, conditions(channel)};
  Flow flow{mesh};
  std::vector<double> net = std::vector<double>(mesh.n_all_cells()), through = net;
  CellFluxes fluxes{net, through};
  StepReport report;
  DivergenceWatch watch;

  explicit Watched(const FlowSettings& settings = {}) : watch(mesh, settings) {
    report.outer.resize(1);
    flow.velocity.assign(mesh.n_all_cells(), {1, 0, 0});
    flow.time_step = 7, flow.time = 0.07, flow.time_step_size = 0.01;
    watch.begin(flow);
  }
  /// The error of a check, empty if there is none; the same on every rank.
  std::string error() {
    std::string message;
    try {
      watch.check(flow, boundary, fluxes, report);
    } catch (const Error& failure) {
      EXPECT_EQ(failure.code, ExitCode::diverged);
      message = failure.what();
    }
    std::string first = message;
    int size = static_cast<int>(first.size());
    MPI_Bcast(&size, 1, MPI_INT, 0, MPI_COMM_WORLD);
    first.resize(static_cast<std::size_t>(size));
    MPI_Bcast(first.data(), size, MPI_CHAR, 0, MPI_COMM_WORLD);
    EXPECT_EQ(message, first);
    return message;
  }
  /// Calls set(cell) for the cell of a number of the mesh file, on its rank.
  template <class Set>
  void at_cell(std::int64_t id, const Set& set) {
    for (int c = 0; c < mesh.n_cells; ++c)
      if (mesh.cell_id[c] == id) set(c);
  }
};

}  // namespace

// Water at the speed of the case, ten times that, and impulsive pressures are no divergence.
TEST(DivergenceWatch, sound_water) {
  Watched w;
  EXPECT_EQ(w.error(), "");
  EXPECT_DOUBLE_EQ(w.watch.speed(), 1);
  w.at_cell(100, [&](int c) { w.flow.velocity[c] = {0, 10, 0}, w.flow.pressure[c] = 1e5; });
  EXPECT_EQ(w.error(), "");
  EXPECT_NEAR(w.watch.largest_speed_ratio(), 10, 1e-9);
}

// A cell whose water is faster than the case and much faster than all cells around it is named; one of two fast neighbours is not, nor one
// that is slower than the case.
TEST(DivergenceWatch, lone_cell) {
  Watched w;
  const auto found = [&](double speed, double other) {
    w.flow.velocity.assign(w.mesh.n_all_cells(), {0.9, 0, 0});
    w.at_cell(100, [&](int c) { w.flow.velocity[c] = {0, speed, 0}; });
    w.at_cell(101, [&](int c) { w.flow.velocity[c] = {0, 0, other}; });
    w.mesh.halo.exchange(w.flow.velocity);
    return w.watch.lone_cell(w.flow);
  };
  EXPECT_EQ(found(1.3, 0.9), "");
  const std::string message = found(2, 0.9);
  for (const char* part : {"cell 100 at (", "2 m/s", "0.9 m/s", "1 m/s", "n_outer_correctors"})
    EXPECT_TRUE(mentions(message, part)) << message;
  EXPECT_EQ(found(2, 1.5), "");
  w.flow.velocity.assign(w.mesh.n_all_cells(), {0.1, 0, 0});
  w.at_cell(100, [&](int c) { w.flow.velocity[c] = {0.8, 0, 0}; });
  EXPECT_EQ(w.watch.lone_cell(w.flow), "");
}

// Each bound: the message names quantity, cell, place, step, time, the speed of the case and its source.
TEST(DivergenceWatch, every_bound) {
  const std::vector<std::pair<std::string, void (*)(Watched&, int)>> ways{
      {"velocity",
       [](Watched& w, int c) {
         w.flow.velocity[c] = {0, 21, 0};
       }},
      {"k in m/s", [](Watched& w, int c) { w.flow.turbulent_kinetic_energy[c] = 441; }},
      {"pressure", [](Watched& w, int c) { w.flow.pressure[c] = 1e6; }},
      {"through the faces", [](Watched& w, int c) { w.fluxes.through[c] = 40; }},
      {"leaves in a step", [](Watched& w, int c) { w.fluxes.net[c] = 2; }},
      {"velocity", [](Watched& w, int c) { w.flow.velocity[c].z = std::nan(""); }},
      {"pressure", [](Watched& w, int c) { w.flow.pressure[c] = std::nan(""); }},
  };
  for (const auto& [name, spoil] : ways) {
    Watched w;
    w.flow.turbulent_kinetic_energy.assign(w.mesh.n_all_cells(), 0);
    const auto spoiled = spoil;
    w.at_cell(101, [&](int c) { spoiled(w, c); });
    const std::string message = w.error();
    for (const std::string& part :
         {name, std::string("cell 101 at ("), std::string("quality 1 "), std::string("step 7 (t = 0.07 s)"), std::string("speed of 1 m/s")})
      EXPECT_TRUE(mentions(message, part)) << name << ": " << message;
  }
}

// A peak of a table between the instants that divide the run evenly sets the speed of the case, before the end of the run only.
TEST(DivergenceWatch, foreseen_peak) {
  const std::string table = "velocity_m_s = [1, 0, 0]\ntimes_s = [0, 0.4, 0.401, 0.402, 2, 3]\nfactors = [1, 1, 7, 1, 1, 9]\n";
  std::string peak = channel;
  peak.replace(peak.find("velocity_m_s = [1, 0, 0]\n"), 25, table);
  Watched w;
  BoundarySet boundary(w.mesh, conditions(peak));
  w.flow.time = 0;
  w.watch.foresee(w.flow, boundary, 1);
  EXPECT_NEAR(w.watch.speed(), 7, 1e-9);
  EXPECT_TRUE(mentions(w.watch.source(), "given at a patch")) << w.watch.source();
}

// Equations that stay unsolved end the run after the steps that are allowed, not before; a solved step counts anew.
TEST(DivergenceWatch, unsolved_steps) {
  Watched w;
  OuterReport& last = w.report.outer.back();
  last.momentum.converged = false, last.momentum.final = 1e-2;
  for (int n = 0; n < DivergenceBounds::unsolved_steps; ++n) EXPECT_EQ(w.error(), "");
  last.momentum.final = 1e-5;  // not to the tolerance, but solved
  EXPECT_EQ(w.error(), "");
  last.momentum.final = 1e-2;
  for (int n = 0; n < DivergenceBounds::unsolved_steps; ++n) EXPECT_EQ(w.error(), "");
  const std::string message = w.error();
  EXPECT_TRUE(mentions(message, "equation of momentum")) << message;
  EXPECT_EQ(w.watch.unsolved_steps(), DivergenceBounds::unsolved_steps + 1);
}

// k and epsilon that stay unsolved, or fall to nothing, may recover: they count as long as they do at the end.
TEST(DivergenceWatch, unsolved_turbulence) {
  Watched w;
  OuterReport& last = w.report.outer.back();
  last.turbulence.equations = {{"k", {}}, {"epsilon", SweepReport{0, 1e3, 0, false}}};
  for (int n = 0; n < 30; ++n) EXPECT_EQ(w.error(), "");
  EXPECT_EQ(w.watch.unsolved_steps(), 30);
  last.turbulence.equations[1].sweeps.final = 1e-6;
  EXPECT_EQ(w.error(), "");
  EXPECT_EQ(w.watch.unsolved_steps(), 0);
  last.turbulence.raised_cells = 3;  // solved, but fallen without end
  for (int n = 0; n < 30; ++n) EXPECT_EQ(w.error(), "");
  EXPECT_EQ(w.watch.unsolved_steps(), 30);
}

// Advice follows the cause: an unbounded scheme, a Courant number at the speed of the case, water that enters by the outlet.
TEST(DivergenceWatch, advice) {
  const auto diverged = [](Watched& w, std::int64_t id) {
    w.at_cell(id, [&](int c) { w.flow.velocity[c] = {100, 0, 0}; });
    return w.error();
  };
  FlowSettings central;
  central.convection = "central";
  Watched unbounded(central), large(FlowSettings{}), outlet(FlowSettings{}), plain(FlowSettings{});
  std::string message = diverged(unbounded, 50);
  EXPECT_TRUE(mentions(message, "convection = \"central\"")) << message;
  large.flow.time_step_size = 20;
  message = diverged(large, 50);
  EXPECT_TRUE(mentions(message, "Courant number of 200: [time] step_ms = 1e+03")) << message;
  const Patch& way_out = outlet.mesh.patches[static_cast<std::size_t>(outlet.mesh.patch_index("x1"))];
  for (int f = way_out.first; f < way_out.end(); ++f) outlet.flow.flux[f] = -1;
  outlet.at_cell(7, [&](int c) { EXPECT_GT(outlet.mesh.cell_centre[c].x, 3.7); });
  message = diverged(outlet, 7);
  EXPECT_TRUE(mentions(message, "enters again through the outlet \"x1\" (100 %")) << message;
  message = diverged(plain, 50);
  EXPECT_TRUE(mentions(message, "n_outer_correctors = 2")) << message;
}

// A start at once with 10 m/s, at small and at large steps, is no divergence.
TEST(DivergenceWatch, impulsive_start) {
  for (const double dt : {1e-6, 1e-3, 1.0}) {
    const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {4, 1, 1}, {8, 4, 4});
    FlowSolver solver(mesh, {}, conditions(channel));
    for (int n = 0; n < 5; ++n) EXPECT_NO_THROW(solver.advance(dt)) << dt;
  }
}
