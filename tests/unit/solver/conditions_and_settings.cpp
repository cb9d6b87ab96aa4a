#include <gtest/gtest.h>

#include "case_texts.hpp"
#include "solver/flow_solver.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const char* const walls = "[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\"]\nkind = \"wall\"\n";

Mesh box() { return structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {3, 3, 3}); }

}  // namespace

// Requirement: every source file in solver/boundaries/kinds/ registers a kind of condition, and the manual has a section of each.
TEST(Conditions, RegistryHoldsTheFolder) {
  EXPECT_EQ(boundaries().names().size(), n_sources("solver/boundaries/kinds"));
  EXPECT_EQ(boundary_sections().size(), boundaries().names().size() + 1);
}

// A patch without a condition is named, with the kinds that could be given.
TEST(Conditions, missing) {
  const Mesh mesh = box();
  const auto message = usage_error([&] { FlowSolver(mesh, {}, conditions(walls)); });
  EXPECT_TRUE(mentions(message, "z1")) << message;
  EXPECT_TRUE(mentions(message, "pressure_outlet")) << message;
}

// A condition for a patch that the mesh does not have is named with its table and the patches there are.
TEST(Conditions, unknown_patch) {
  const Mesh mesh = box();
  const auto message =
      usage_error([&] { FlowSolver(mesh, {}, conditions(std::string(walls) + "[[boundary]]\npatch = \"z2\"\nkind = \"wall\"\n")); });
  EXPECT_TRUE(mentions(message, "z2")) << message;
  EXPECT_TRUE(mentions(message, "z1")) << message;
}

// Two conditions for one patch are an error.
TEST(Conditions, twice) {
  const Mesh mesh = box();
  const auto message = usage_error([&] { FlowSolver(mesh, {}, conditions(std::string(walls) + walls)); });
  EXPECT_TRUE(mentions(message, "x0")) << message;
}

// A misspelt kind is an error that names the nearest.
TEST(Conditions, unknown_kind) {
  const auto message = usage_error([] { conditions("[[boundary]]\npatch = \"x0\"\nkind = \"presure_outlet\"\n"); });
  EXPECT_TRUE(mentions(message, "pressure_outlet")) << message;
}

// Fluid that flows in and cannot leave is an error, not a wrong pressure.
TEST(Conditions, net_flux) {
  const Mesh mesh = box();
  FlowSolver solver(mesh, {},
                    conditions(std::string(walls) + "[[boundary]]\npatch = \"z1\"\nkind = \"velocity_inlet\"\nnormal_speed = \"1 m/s\"\n"));
  const auto message = usage_error([&] { solver.advance(0.1); });
  EXPECT_TRUE(mentions(message, "pressure_outlet")) << message;
}

// Exactly one viscosity may be given; water's is the default.
TEST(FlowSettings, viscosity) {
  FlowSettings settings;
  EXPECT_DOUBLE_EQ(settings.viscosity(), 1.003e-3);
  settings.kinematic_viscosity = 2e-6;
  EXPECT_DOUBLE_EQ(settings.viscosity(), 2e-6 * 998.2);
  settings.dynamic_viscosity = 1e-3;
  usage_error([&] { settings.viscosity(); });
}

// A run that diverges says in which step, field and place.
TEST(Divergence, place) {
  const Mesh mesh = box();
  FlowSolver solver(mesh, {}, conditions(std::string(walls) + "[[boundary]]\npatch = \"z1\"\nkind = \"wall\"\n"));
  solver.advance(0.1);
  solver.flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
  solver.flow.reaction[0].x = std::nan("");
  try {
    solver.advance(0.1);
    ADD_FAILURE() << "no error was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::diverged);
    EXPECT_TRUE(mentions(error.what(), "step 2")) << error.what();
    EXPECT_TRUE(mentions(error.what(), "velocity")) << error.what();
  }
}
