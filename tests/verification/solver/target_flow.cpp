// ranks: 1
// long ranks: 2 3
// timeout: 600
// A pressure inlet and an outlet whose pressure floats until the flow is the one that is asked for.
#include "tests/verification/solver/tank_and_outlet.hpp"

using namespace snag;
using namespace snag::test;
using namespace snag::test::tank_and_outlet;

// From rest, with a level at the start that is 10 dynamic heads off: the flow comes to its target within 1e-4, and not more than 3 % over
// it.
TEST(TargetFlow, from_rest) {
  const Mesh mesh = tetrahedra();
  for (const double level : {0.0, -4.0, 4.0}) {
    FlowSolver solver(mesh, settings(), conditions(from_tank("target_flow_rate_m3_s = 0.8\npressure_Pa = " + std::to_string(level))));
    const auto share = share_of_target(solver, 320);
    print("from rest", share, 1);
    EXPECT_LT(largest(share), 1.03) << level;
    EXPECT_NEAR(share.back(), 1, 1e-4) << level;
  }
}

// The target falls to a half: the flow follows, is not more than 3 % of the target off on the other side, and settles.
TEST(TargetFlow, step_change) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, settings(), conditions(from_tank("target_flow_rate_m3_s = 0.8\ntimes_s = [5, 5.001]\nfactors = [1, 0.5]")));
  EXPECT_NEAR(share_of_target(solver, 249).back(), 1, 1e-3);
  const auto share = share_of_target(solver, 320);
  print("step change", share, 0.5);
  EXPECT_GT(smallest(share), 0.47);
  EXPECT_NEAR(share.back(), 0.5, 1e-4);
}

// A flow that swings with the pressure of the inlet: an outlet that answers slowly lets it swing, one that answers fast does not.
TEST(TargetFlow, response_time) {
  const Mesh mesh = tetrahedra();
  const auto swing = [&](const std::string& response) {
    std::string times, factors;
    for (int i = 0; i < 12; ++i) times += std::to_string(i) + ", ", factors += i % 2 == 0 ? "1, " : "0.8, ";
    auto text = from_tank("target_flow_rate_m3_s = 0.8\nresponse_time_s = " + response);
    text.replace(text.find("pressure_Pa = 3"), 15, "pressure_Pa = 3\ntimes_s = [" + times + "]\nfactors = [" + factors + "]");
    FlowSolver solver(mesh, settings(), conditions(text));
    share_of_target(solver, 400);
    const auto share = share_of_target(solver, 100);
    print(("swing, T = " + response + " s").c_str(), share, 1);
    return largest(share) - smallest(share);
  };
  EXPECT_LT(swing("0.1"), 0.25 * swing("2"));
}

// Where the run ends before the flow is at its target, the outlet says by how much it is not; where it is there, nothing.
TEST(TargetFlow, unmet) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, settings(), conditions(from_tank("target_flow_rate_m3_s = 0.8")));
  const double share = share_of_target(solver, 10).back();
  EXPECT_LT(share, 0.9);
  const std::vector<std::string> unmet = solver.boundary().unmet(solver.flow);
  ASSERT_EQ(unmet.size(), 1u);
  for (const char* part : {"\"x1\"", "800 L/s", "response_time below 0.4 s"}) EXPECT_NE(unmet[0].find(part), std::string::npos) << unmet[0];
  share_of_target(solver, 300);
  EXPECT_TRUE(solver.boundary().unmet(solver.flow).empty());
}

// Two outlets share what one inlet gives, each with a target of its own.
TEST(TargetFlow, two_outlets) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, settings(), conditions(R"(
[[boundary]]
patches = ["z0", "y0", "y1"]
kind = "wall"
[[boundary]]
patch = "z1"
kind = "pressure_inlet"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
target_flow_rate_m3_s = 0.8
[[boundary]]
patch = "x0"
kind = "pressure_outlet"
target_flow_rate_m3_s = 0.3
)"));
  const auto share = share_of_target(solver, 320);
  print("two outlets", share, 1);
  EXPECT_LT(largest(share), 1.05);
  EXPECT_NEAR(share.back(), 1, 0.01);
  EXPECT_NEAR(flow_rate(solver.flow, mesh.patch_index("x0")), 0.3, 0.003);
}

// A run that starts with the water of one that has settled finds the level in its pressure, whatever the case says of it: the flow stays.
TEST(TargetFlow, from_settled_water) {
  const Mesh mesh = tetrahedra();
  const std::string text = from_tank("target_flow_rate_m3_s = 0.8\npressure_Pa = 40");
  FlowSolver settled(mesh, settings(), conditions(text));
  share_of_target(settled, 320);
  FlowSolver solver(mesh, settings(), conditions(text));
  std::copy_n(settled.flow.velocity.begin(), mesh.n_cells, solver.flow.velocity.begin());
  std::copy_n(settled.flow.pressure.begin(), mesh.n_cells, solver.flow.pressure.begin());
  const auto share = share_of_target(solver, 60);
  print("from settled water", share, 1);
  EXPECT_GT(smallest(share), 0.98);
  EXPECT_LT(largest(share), 1.02);
}
