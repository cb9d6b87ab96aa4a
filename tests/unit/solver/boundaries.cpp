// What conditions compute by themselves: time courses, turning walls, the level of an outlet, and what they refuse.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mesh/import/import.hpp"
#include "solver/boundaries/flow_target.hpp"
#include "solver/boundaries/time_course.hpp"
#include "solver/boundaries/wall_pressure.hpp"
#include "solver/flow_solver.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

namespace {

std::vector<PatchBoundary> conditions(const std::string& toml) { return read_boundaries(CaseFile::parse(toml).root()); }

const char* const walls = "[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\", \"z0\"]\nkind = \"wall\"\n";

std::string condition(const std::string& patch, const std::string& kind, const std::string& keys = "") {
  return "[[boundary]]\npatch = \"" + patch + "\"\nkind = \"" + kind + "\"\n" + keys + "\n";
}

Mesh box() { return structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {3, 3, 3}); }

/// The message of the Error(usage) with which a case is refused before its first step or in it.
std::string refusal(const std::string& toml) {
  const Mesh mesh = box();
  try {
    FlowSolver solver(mesh, {}, conditions(toml));
    solver.advance(0.1);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  ADD_FAILURE() << "not refused:\n" << toml;
  return "";
}

void expect_refusal(const std::string& toml, const std::vector<std::string>& words) {
  const std::string message = refusal(toml);
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message << "\n does not mention " << word;
}

/// Values at the first face of patch z1 after a step that ends at `time`.
struct FirstFace {
  Vec3 velocity, acceleration, centre;
  double flux = 0, pressure = 0;
};
FirstFace first_face(const std::string& z1, double time, double dt) {
  const Mesh mesh = box();
  FlowSolver solver(mesh, {}, conditions(walls + z1));
  solver.flow.time = time - dt;
  solver.advance(dt);
  const int f = mesh.patches[mesh.patch_index("z1")].first;
  const int b = f - mesh.n_interior;
  const BoundaryValues& values = solver.boundary().values();
  return {values.velocity[b], values.acceleration[b], mesh.face_centre[f], values.flux[b], values.pressure[b]};
}

}  // namespace

// A ramp rises from zero to one; a table is linear between its times and constant outside; without keys all is constant.
TEST(TimeCourse, values) {
  EXPECT_EQ(TimeCourse().at(0), 1);
  const TimeCourse ramp{.ramp = 4, .times = {}, .factors = {}};
  EXPECT_EQ(ramp.at(0), 0);
  EXPECT_EQ(ramp.at(1), 0.25);
  EXPECT_EQ(ramp.at(9), 1);
  const TimeCourse table{.ramp = 0, .times = {1, 2, 4}, .factors = {0.5, -1, 3}};
  EXPECT_EQ(table.at(0), 0.5);
  EXPECT_EQ(table.at(1), 0.5);
  EXPECT_EQ(table.at(1.5), -0.25);
  EXPECT_EQ(table.at(3), 1);
  EXPECT_EQ(table.at(4), 3);
  EXPECT_EQ(table.at(5), 3);
}

// Keys that contradict each other are refused with the patch and the remedy.
TEST(TimeCourse, refused) {
  const auto outlet = [](const std::string& keys) { return walls + condition("z1", "pressure_outlet", keys); };
  expect_refusal(outlet("times_s = [0, 1]\nfactors = [1]"), {"\"z1\"", "2 values", "a factor for each"});
  expect_refusal(outlet("ramp_s = 1\ntimes_s = [0]\nfactors = [1]"), {"\"z1\"", "keep one"});
  expect_refusal(outlet("times_s = [0, 2, 2]\nfactors = [1, 1, 0]"), {"\"z1\"", "increase"});
}

// Each kind with a value that may rise has risen to a half in the middle of its ramp.
TEST(TimeCourse, of_each_kind) {
  EXPECT_NEAR(first_face(condition("z1", "pressure_outlet", "pressure_Pa = 8\nramp_s = 2"), 1, 0.1).pressure, 4, 1e-12);
  EXPECT_NEAR(first_face(condition("z1", "pressure_inlet", "pressure_Pa = 8\ntotal = false\nramp_s = 2"), 1, 0.1).pressure, 4, 1e-12);
  const std::string open =
      "[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\"]\nkind = \"wall\"\n" + condition("z0", "pressure_outlet");
  const Mesh mesh = box();
  for (const auto& [kind, keys] : {std::pair{"flow_rate_inlet", "flow_rate_m3_s = 0.2\nramp_s = 2"},
                                   std::pair{"velocity_inlet", "normal_speed_m_s = 0.2\nramp_s = 2"}}) {
    FlowSolver solver(mesh, {}, conditions(open + condition("z1", kind, keys)));
    for (int i = 0; i < 10; ++i) solver.advance(0.1);
    double flux = 0;
    const Patch& patch = mesh.patches[mesh.patch_index("z1")];
    for (int f = patch.first; f < patch.end(); ++f) flux += solver.flow.flux[f];
    EXPECT_NEAR(flux, -0.1, 1e-12) << kind;
  }
}

// A wall that turns: velocity omega x r, acceleration omega x (omega x r), and while its speed rises domega/dt x r; nothing passes.
TEST(MovingWall, turning) {
  const std::string keys = "rotation_speed_rad_s = 3\naxis = [0, 0, 2]\norigin_m = [0.5, 0.5, 0]\n";
  const FirstFace steady = first_face(condition("z1", "moving_wall", keys), 1, 0.1);
  const Vec3 r{steady.centre.x - 0.5, steady.centre.y - 0.5, 0}, across = cross({0, 0, 1}, r);
  EXPECT_GT(norm(r), 0.1);
  EXPECT_LT(norm(steady.velocity - 3.0 * across), 1e-12);
  EXPECT_LT(norm(steady.acceleration + 9.0 * r), 1e-12);
  EXPECT_EQ(steady.flux, 0);
  const FirstFace rising = first_face(condition("z1", "moving_wall", keys + "ramp_s = 4"), 2, 0.1);
  EXPECT_LT(norm(rising.velocity - 1.5 * across), 1e-12);
  EXPECT_LT(norm(rising.acceleration - (0.75 * across - 2.25 * r)), 1e-12);
}

// The controller on a column without losses, I dQ/dt = H - p, advanced exactly: it reaches the target whatever the level at the start, and
// does not go beyond where the inertance it was told is the true one or four times that; by less than a fifth where it is half of it.
TEST(FlowTarget, column) {
  for (const double told : {0.5, 1.0, 4.0}) {
    constexpr double density = 1000, conductance = 0.01, inertance = density / conductance, driving = 5e4, dt = 1e-3, target = 0.05;
    FlowTarget control(conductance / told, -2e4);
    double flow = 0, before = 0, highest = 0;
    for (int i = 0; i < 400; ++i) {
      control.advance({.flow = flow, .flow_before = before, .dt = dt, .dt_before = i > 0 ? dt : 0}, target, density, 0.02);
      before = flow;
      flow += dt / inertance * (driving - control.level());
      highest = std::max(highest, flow);
    }
    EXPECT_LT(highest, (told < 1 ? 1.2 : 1.001) * target) << told;
    EXPECT_NEAR(flow, target, 1e-4 * target) << told;
    EXPECT_NEAR(control.level(), driving, 1e-3 * driving) << told;
  }
}

// Parts of a mesh that no face joins, here a pump without its sliding interface: a part that water passes through needs a pressure, or a
// balance.
TEST(Boundaries, regions) {
  const Mesh mesh = import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD);
  const auto message_of = [&mesh](const std::string& at_inlet, const std::string& keys) {
    std::string text;
    for (const Patch& patch : mesh.patches)
      text += condition(patch.name,
                        patch.name == "outlet"  ? "pressure_outlet"
                        : patch.name == "inlet" ? at_inlet
                                                : "wall",
                        patch.name == "inlet" ? keys : "");
    try {
      BoundarySet set(mesh, conditions(text));
      set.update(Flow(mesh), 0);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string message = message_of("velocity_inlet", "normal_speed_m_s = 1");
  for (const char* word : {"\"inlet\"", "not joined", "pressure_outlet"}) EXPECT_NE(message.find(word), std::string::npos) << message;
  EXPECT_EQ(message_of("velocity_inlet", "normal_speed_m_s = 0"), "");
  EXPECT_EQ(message_of("pressure_inlet", ""), "");
  EXPECT_EQ(message_of("wall", ""), "");
}

// A target of the flow is refused where nothing else gives the pressure, and where the level would have to answer faster than the steps
// allow.
TEST(FlowTarget, refused) {
  const std::string target = "target_flow_rate_m3_s = 0.1\n";
  expect_refusal(walls + condition("z1", "pressure_outlet", target), {"\"z1\"", "pressure_inlet"});
  const std::string between = "[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\"]\nkind = \"wall\"\n";
  expect_refusal(between + condition("z0", "pressure_outlet", target) + condition("z1", "pressure_outlet", target), {"pressure_inlet"});
  expect_refusal(between + condition("z0", "pressure_inlet") + condition("z1", "pressure_outlet", target + "response_time_s = 0.3"),
                 {"\"z1\"", "response_time (0.3 s)", "4 time steps"});
  expect_refusal(walls + condition("z1", "pressure_outlet", "response_time_s = 3"), {"\"z1\"", "target_flow_rate"});
}

// Between two plates and two planes of symmetry the laminar profile is that between the plates, whatever the distance to the planes, and
// whether a face has its centre in the middle of the plates or not: the mean over each face.
class InletProfile : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(rows, InletProfile, testing::Values(4, 5));
TEST_P(InletProfile, between_plates) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 4, GetParam()});
  FlowSolver solver(mesh, {},
                    conditions("[[boundary]]\npatches = [\"z0\", \"z1\"]\nkind = \"wall\"\n"
                               "[[boundary]]\npatches = [\"y0\", \"y1\"]\nkind = \"symmetry\"\n" +
                               condition("x0", "velocity_inlet", "velocity_m_s = [1, 0, 0]\nprofile = \"laminar\"") +
                               condition("x1", "pressure_outlet")));
  solver.advance(0.1);
  const Patch& inlet = mesh.patches[mesh.patch_index("x0")];
  const double height = 1.0 / GetParam();
  for (int f = inlet.first; f < inlet.end(); ++f) {
    const double z = mesh.face_centre[f].z, mean = 6 * (z * (1 - z) - height * height / 12);  // of 6 z (1 - z)
    EXPECT_NEAR(solver.boundary().values().velocity[f - mesh.n_interior].x, mean, 2e-3);
  }
}

// Without a wall at its rim an inlet has no profile of a developed flow.
TEST(InletProfiles, without_walls) {
  expect_refusal("[[boundary]]\npatches = [\"x0\", \"x1\", \"y0\", \"y1\"]\nkind = \"symmetry\"\n" +
                     condition("z0", "velocity_inlet", "normal_speed_m_s = 1\nprofile = \"turbulent\"") +
                     condition("z1", "pressure_outlet"),
                 {"\"z0\"", "no edge", "profile = \"uniform\""});
}

// A wall that moves across itself is a piston, which a mesh that stands cannot follow: refused. One that moves along itself is not.
TEST(MovingWall, acrossItself) {
  const auto wall = [](const std::string& keys) { return walls + condition("z1", "moving_wall", keys); };
  expect_refusal(wall("velocity_m_s = [0, 0, 1]"), {"\"z1\"", "100 %", "across the wall"});
  expect_refusal(wall("velocity_m_s = [1, 0, 0.5]"), {"45 %"});
  expect_refusal(wall("rotation_speed_rpm = 60\naxis = [1, 0, 0]"), {"across the wall", "rotation_speed"});
  for (const char* along : {"velocity_m_s = [1, 2, 0]", "rotation_speed_rpm = 60\norigin_m = [0.5, 0.5, 0]"})
    EXPECT_NO_THROW(FlowSolver(box(), {}, conditions(wall(along)))) << along;
}

// What is beyond an outlet has left, and so has what is beyond an inlet that draws water out.
TEST(Boundaries, leadOut) {
  const Mesh mesh = box();
  const auto leads_out = [&](const std::string& z1) {
    const FlowSolver solver(mesh, {}, conditions(walls + z1));
    return solver.boundary().leads_out(mesh.patch_index("z1"));
  };
  EXPECT_TRUE(leads_out(condition("z1", "pressure_outlet")));
  EXPECT_TRUE(leads_out(condition("z1", "flow_rate_inlet", "flow_rate_m3_s = -1")));
  EXPECT_TRUE(leads_out(condition("z1", "velocity_inlet", "velocity_m_s = [5, 0, 1]")));
  EXPECT_TRUE(leads_out(condition("z1", "velocity_inlet", "normal_speed_m_s = -1")));
  EXPECT_FALSE(leads_out(condition("z1", "flow_rate_inlet", "flow_rate_m3_s = 1")));
  EXPECT_FALSE(leads_out(condition("z1", "velocity_inlet", "velocity_m_s = [5, 0, -1]")));
  EXPECT_FALSE(leads_out(condition("z1", "pressure_inlet")));
  EXPECT_FALSE(leads_out(condition("z1", "wall")));
}

// Requirement: a box of 5 x 5 x 5 cells has walls on five sides. Cells with one wall face lie at a wall, cells with two or three lie at an
// edge. The number of ranks does not change this.
TEST(WallPressure, CellsAtEdges) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {5, 5, 5});
  const FlowSolver solver(mesh, {}, conditions(walls + condition("z1", "pressure_outlet")));
  const std::vector<WallCell> where = wall_cells(mesh, solver.boundary());
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    const Vec3& x = mesh.cell_centre[c];
    const int n_walls = (x.x < 0.2) + (x.x > 0.8) + (x.y < 0.2) + (x.y > 0.8) + (x.z < 0.2);
    EXPECT_EQ(where[c], n_walls == 0   ? WallCell::inner
                        : n_walls == 1 ? WallCell::at_wall
                                       : WallCell::at_edge)
        << x.x << ' ' << x.y << ' ' << x.z;
  }
}

// Requirement: in a linear pressure, 2 Pa/m along z, the slope at the wall z = 0 is exact. With gradients ten times as large around, it is
// twice that which the pressures show; with gradients of the other sign it is zero.
TEST(WallPressure, GradientsThatPressuresDoNotShow) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {5, 5, 5});
  FlowSolver solver(mesh, {}, conditions(walls + condition("z1", "pressure_outlet")));
  const std::vector<WallCell> where = wall_cells(mesh, solver.boundary());
  Flow& flow = solver.flow;
  for (const auto& [gradient, slope] : {std::pair{2.0, -2.0}, std::pair{20.0, -4.0}, std::pair{-20.0, 0.0}}) {
    for (int c = 0; c < mesh.n_all_cells(); ++c) flow.pressure[c] = 2 * mesh.cell_centre[c].z, flow.pressure_gradient[c] = {0, 0, gradient};
    const Patch& patch = mesh.patches[mesh.patch_index("z0")];
    for (int f = patch.first; f < patch.end(); ++f) {
      const std::optional<double> found = slope_at_wall_function(mesh, where, flow, {}, f);
      EXPECT_EQ(found.has_value(), where[mesh.owner[f]] == WallCell::at_wall);
      EXPECT_NEAR(found.value_or(slope), slope, 1e-12);
    }
  }
}
