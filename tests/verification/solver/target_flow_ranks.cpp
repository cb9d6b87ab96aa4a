// ranks: 1 2
// long ranks: 3
// What an outlet with a target of the flow must do on any number of ranks; target_flow.cpp has the rest.
#include "solver/boundaries/water_column.hpp"
#include "tests/verification/solver/take_over.hpp"
#include "tests/verification/solver/tank_and_outlet.hpp"

using namespace snag;
using namespace snag::test;
using namespace snag::test::tank_and_outlet;

// The conductance of a straight column is its section over its length: exactly on hexahedra, to some per cent on distorted tetrahedra.
TEST(TargetFlowRanks, water_column) {
  const auto conductance_of = [](const Mesh& mesh) {
    std::vector<PatchBoundary> ordered(mesh.patches.size());
    for (const PatchBoundary& condition : conditions(from_tank("")))
      ordered[mesh.patch_index(condition.patch)] = {condition.patch, "", boundaries().make("wall", "test")};
    for (const char* open : {"x0", "x1"}) ordered[mesh.patch_index(open)].boundary = boundaries().make("pressure_outlet", "test");
    return column_conductance(mesh, ordered, mesh.patches[mesh.patch_index("x1")], ControlledOutlets::closed);
  };
  EXPECT_NEAR(conductance_of(structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {10, 3, 6})), 0.5, 1e-9);
  EXPECT_NEAR(conductance_of(tetrahedra()), 0.5, 0.1);
}

// A column that ends at an outlet with a target of its flow is closed there or open, as asked.
TEST(TargetFlowRanks, water_column_to_a_controlled_outlet) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {10, 3, 6});
  std::vector<PatchBoundary> all(mesh.patches.size());
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = {mesh.patches[p].name, "", boundaries().make("wall", "test")};
  for (PatchBoundary& condition : conditions(from_tank("target_flow_rate_m3_s = 0.8")))
    if (condition.boundary->is_open()) all[mesh.patch_index(condition.patch)].boundary = std::move(condition.boundary);
  const Patch& inlet = mesh.patches[mesh.patch_index("x0")];
  EXPECT_NEAR(column_conductance(mesh, all, inlet, ControlledOutlets::open), 0.5, 1e-9);
  EXPECT_NEAR(column_conductance(mesh, all, inlet, ControlledOutlets::closed), 0, 1e-9);
}

// The conductance does not depend on which ranks hold faces of the patch: here the first one alone does, and the next patch begins where
// the patch, without faces, does on the last rank.
TEST(TargetFlowRanks, water_column_of_a_patch_on_one_rank) {
  const auto conductance_of = [](MPI_Comm comm) {
    const Mesh mesh = structured_box(comm, {}, {2, 1, 1}, {10, 3, 6});
    std::vector<PatchBoundary> all(mesh.patches.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
      const std::string& name = mesh.patches[p].name;
      all[p] = {name, "", boundaries().make(name == "x1" || name == "z0" ? "pressure_outlet" : "wall", "test")};
    }
    return column_conductance(mesh, all, mesh.patches[mesh.patch_index("z0")], ControlledOutlets::closed);
  };
  EXPECT_NEAR(conductance_of(MPI_COMM_WORLD) / conductance_of(MPI_COMM_SELF), 1, 1e-9);
}

// From rest the flow comes to its target within 1e-4, and not more than 3 % over it.
TEST(TargetFlowRanks, from_rest) {
  const Mesh mesh = tetrahedra();
  FlowSolver solver(mesh, settings(), conditions(from_tank("target_flow_rate_m3_s = 0.8\npressure_Pa = -4")));
  const auto share = share_of_target(solver, 320);
  EXPECT_LT(largest(share), 1.03);
  EXPECT_NEAR(share.back(), 1, 1e-4);
}

// A resumed run has the level and all that it comes from: the same pressures to the bit.
TEST(TargetFlowRanks, resume) {
  const Mesh mesh = tetrahedra();
  const std::string text = from_tank("target_flow_rate_m3_s = 0.8");
  FlowSolver whole(mesh, settings(), conditions(text));
  share_of_target(whole, 7);
  FlowSolver resumed(mesh, settings(), conditions(text));
  take_over(whole, resumed, "target_flow");
  share_of_target(whole, 5), share_of_target(resumed, 5);
  for (int c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(whole.flow.pressure[c], resumed.flow.pressure[c]);
  EXPECT_EQ(whole.boundary().state(), resumed.boundary().state());
}
