// What a case says of its coupling: what is read, refused and warned of.
#include "coupling/coupling_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "base/error.hpp"
#include "coupling/coupled_solver.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/kernel_shape.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

// Requirement: a misspelt force is refused with the nearest name; the records of a chosen force are read; gravity acts where its table is
// given.
TEST(CouplingSettings, ReadsForcesAndRefusesUnknownOnes) {
  const auto read = [](const std::string& text) { return read_coupling(CaseFile::parse(text).root()); };
  const auto coupling = read(
      "[gravity]\nacceleration_m_s2 = [0, -9.81, 0]\n[coupling]\nforces = [\"free_stream_drag\"]\n[coupling.free_stream_drag]\ndrag_factor "
      "= 2\n");
  ASSERT_EQ(coupling.forces.size(), 2u);
  const auto state = drag_at(1e4, 0.88, 0, "");
  EXPECT_NEAR(load_on_sphere(*coupling.forces[0], state.state).force.x, state.force.x, 1e-12 * state.force.x);
  SphereState heavy;
  heavy.particle_density = heavy.fluid_density + 1000;
  const auto weight = load_on_sphere(*coupling.forces[1], heavy).force;
  EXPECT_EQ(weight.x, 0);
  EXPECT_NEAR(weight.y, -std::numbers::pi / 6 * 8e-9 * 1000 * 9.81, 1e-12);

  try {
    read("[coupling]\nforces = [\"free_stream_drug\"]\n");
    ADD_FAILURE() << "an unknown force must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("did you mean \"free_stream_drag\""), std::string::npos) << error.what();
  }
  EXPECT_THROW(read("[coupling]\nforces = [\"gravity\", \"gravity\"]\n"), Error);
  EXPECT_THROW(read("[coupling]\nforces = [\"recommended\", \"added_mass\"]\n"), Error);
  EXPECT_EQ(read("[coupling]\nforces = [\"published\", \"wall\"]\n").settings.forces,
            (std::vector<std::string>{"free_stream_drag", "wall"}));
  EXPECT_EQ(read("[coupling]\n").settings.forces, read("[coupling]\nforces = [\"recommended\"]\n").settings.forces);
  EXPECT_EQ(read("[coupling]\nmode = \"none\"\n").forces.size(), 0u);
  EXPECT_EQ(read("[coupling]\nmode = \"none\"\nforces = [\"torque\", \"pressure_gradient\"]\n").forces.size(), 0u);
  EXPECT_THROW(read_coupling(CaseFile::parse("[coupling]\nmode = \"two_way\"\n").root(), false), Error);
}

// Requirement: laws of the whole drag do not add up unsaid, and what changes a drag has one to change.
TEST(CouplingSettings, OneLawOfDragActs) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      read_coupling(CaseFile::parse("[coupling]\n" + text).root());
    } catch (const Error& error) {
      return error.code == ExitCode::usage ? error.what() : "";
    }
    return "";
  };
  EXPECT_NE(refusal(R"(forces = ["free_stream_drag", "wall", "schiller_naumann"])")
                .find("\"free_stream_drag\" and \"schiller_naumann\" are both laws of the whole drag"),
            std::string::npos);
  EXPECT_NE(refusal(R"(forces = ["pressure_gradient", "drag_magnitude"])").find("\"drag_magnitude\" changes the drag, but no force"),
            std::string::npos);
  for (const char* sound :
       {R"(["schiller_naumann", "drag_magnitude", "sheet_drag"])", R"(["drag_magnitude", "sheet_drag"])", R"(["pressure_gradient"])", "[]"})
    EXPECT_EQ(refusal(std::string("forces = ") + sound), "") << sound;
  EXPECT_EQ(refusal("mode = \"none\"\nforces = [\"drag_magnitude\"]"), "");
}

// Requirement: a cloth across the stream that says nothing of its resistance has that of a plate where the water does not feel it, and the
// loss coefficient of a cloth where it does; what a case says counts in both.
TEST(CouplingSettings, ResistanceOfASheetDependsOnTheMode) {
  auto state = drag_at(1e4, 1, 0, "").state;
  const double d = state.diameter;
  state.next_in_row = {0, d, 0}, state.next_row = {0, 0, d};
  const auto coefficient = [&](const std::string& text) {
    const auto coupling = read_coupling(CaseFile::parse("[coupling]\nforces = [\"sheet_drag\"]\n" + text).root());
    return load_on_sphere(*coupling.forces[0], state).force.x / (0.5 * state.fluid_density * d * d * norm_squared(state.velocity));
  };
  EXPECT_NEAR(coefficient("mode = \"one_way\"\n"), 1.17, 1e-12);
  EXPECT_NEAR(coefficient("mode = \"two_way\"\n"), 2, 1e-12);
  for (const char* mode : {"one_way", "two_way"})
    EXPECT_NEAR(coefficient(std::string("mode = \"") + mode + "\"\n[coupling.sheet_drag]\nnormal_coefficient = 3\n"), 3, 1e-12);
}

// Requirement: forces that need k and epsilon are refused by name in a flow that has none; forces that the case does not list are not
// named.
TEST(CouplingSettings, NamesTheForcesThatNeedTurbulence) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4});
  Flow flow(mesh);
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(RagSettings(RagSettings::Shape::rag), "test")});
  const auto message = [&](const std::string& forces) -> std::string {
    try {
      const CoupledSolver solver(read_coupling(CaseFile::parse("[coupling]\nforces = [" + forces + "]\n").root()), rags, flow,
                                 [](double) {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("\"recommended\""), "");
  EXPECT_TRUE(
      message("\"recommended\", \"turbulent_dispersion\"").starts_with("[coupling] forces: turbulent_dispersion needs k and epsilon"))
      << message("\"recommended\", \"turbulent_dispersion\"");
  flow.turbulent_kinetic_energy.assign(static_cast<std::size_t>(mesh.n_cells), 1e-4);
  EXPECT_EQ(message("\"recommended\", \"turbulent_dispersion\""), "");
}

// Requirement: kernels that do not fit particles or cells are named with numbers; one that fits is not.
TEST(CouplingSettings, WarnsOfUnsuitableKernels) {
  Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {0.1, 0.1, 0.1}, {20, 20, 20});  // cells of 5 mm
  const std::vector<Vec3> places{{0.051, 0.051, 0.051}};
  std::vector<Rag> rags(1);
  rags[0].hydrodynamic_diameter = 2e-3;
  const auto warnings = [&](const std::string& keys) {
    return kernel_warnings(read_coupling(CaseFile::parse("[coupling]\n" + keys).root()), rags, mesh, places);
  };
  EXPECT_TRUE(warnings("kernel_width_mm = 5").empty());
  EXPECT_TRUE(warnings("").empty());
  ASSERT_EQ(warnings("kernel_width_mm = 1").size(), 2u);
  EXPECT_NE(warnings("kernel_width_mm = 1")[0].find("0.5 of the particle diameter (2 mm)"), std::string::npos);
  EXPECT_NE(warnings("kernel_width_mm = 1")[1].find("0.2 of the cells where the particles are (mean 5 mm)"), std::string::npos);
  ASSERT_EQ(warnings("kernel_width_mm = 50").size(), 1u);
  EXPECT_NE(warnings("kernel_width_mm = 50")[0].find("reaches some 8000 of the cells (mean 5 mm) around a particle, advised at most 3000"),
            std::string::npos)
      << "there are no more cells";
  EXPECT_TRUE(warnings("mode = \"none\"\nkernel_width_mm = 1").empty()) << "nothing is averaged";
  EXPECT_TRUE(warnings("kernel = \"satellite\"\nkernel_width_mm = 12").empty());
  ASSERT_EQ(warnings("kernel = \"satellite\"\nkernel_width_mm = 15").size(), 1u);
  EXPECT_NE(warnings("kernel = \"satellite\"\nkernel_width_mm = 15")[0].find("cells between its points get nothing"), std::string::npos);
  EXPECT_TRUE(warnings("kernel = \"cell\"").empty());
  rags[0].n_columns = 30, rags[0].n_rows = 20, rags[0].radius = 1e-3, rags[0].name = "cloth";  // 40 mm wide
  EXPECT_TRUE(warnings("kernel_width_mm = 5").empty());
  rags[0].hydrodynamic_diameter = 8e-3;
  EXPECT_TRUE(warnings("kernel_width_mm = 4.5").empty()) << "half of the diameter does for cloth";
  ASSERT_EQ(warnings("kernel_width_mm = 3.5").size(), 1u);
  EXPECT_NE(warnings("kernel_width_mm = 3.5")[0].find("0.438 of the particle diameter (8 mm), advised at least 0.5"), std::string::npos);
  rags[0].hydrodynamic_diameter = 2e-3;
  ASSERT_EQ(warnings("kernel_width_mm = 10").size(), 1u);
  EXPECT_NE(warnings("kernel_width_mm = 10")[0].find("0.25 of the shorter side of cloth \"cloth\" (40 mm), advised at most 0.125"),
            std::string::npos);
  rags.resize(3, rags[0]);
  EXPECT_EQ(warnings("kernel_width_mm = 10").size(), 1u) << "copies are warned of once";
  rags.resize(1);
  EXPECT_TRUE(warnings("kernel_width_mm = 10\nforces = [\"published\"]").empty());
  EXPECT_TRUE(warnings("kernel_width_mm = 10\nmode = \"one_way\"").empty());
  rags[0].n_rows = 2;
  EXPECT_TRUE(warnings("kernel_width_mm = 10").empty());
  rags[0].hydrodynamic_diameter = 8e-3;
  EXPECT_EQ(warnings("kernel = \"cell\"").size(), 1u);
  rags[0].hydrodynamic_diameter = 2e-3;
  for (int c = 0; c < 4000; ++c) mesh.cell_volume[c] = c == 0 ? 1e-13 : 1e-3 * mesh.cell_volume[c];  // small cells, away from the particle
  EXPECT_TRUE(warnings("kernel_width_mm = 5").empty());
  EXPECT_TRUE(warnings("kernel = \"cell\"").empty());
}

// Requirement: a force that looks for the nearest wall is remarked on where there is none to find: the factor of drag at walls always, for
// it does nothing then; the own disturbance if the water has walls.
TEST(CouplingSettings, WarnsOfForcesThatFindNoWall) {
  const auto warnings = [](const std::string& forces, bool rags_know_walls, bool water_has_walls) {
    return wall_warnings(read_coupling(CaseFile::parse("[coupling]\nforces = [" + forces + "]\n").root()), rags_know_walls,
                         water_has_walls);
  };
  const std::string both = R"("free_stream_drag", "self_disturbance", "wall")";
  EXPECT_TRUE(warnings(both, true, true).empty());
  ASSERT_EQ(warnings(both, false, true).size(), 2u);
  ASSERT_EQ(warnings(both, false, false).size(), 1u);
  EXPECT_NE(warnings(both, false, false)[0].find("forces: wall looks for the nearest wall, but the case has no [[wall]]"),
            std::string::npos);
  EXPECT_TRUE(warnings(R"("free_stream_drag")", false, true).empty());
}

// Requirement: a piece that is no cloth is remarked on where the law of cloth is the only drag.
TEST(CouplingSettings, WarnsOfPiecesWithoutDrag) {
  std::vector<Rag> rags(2);
  rags[0].name = "cloth", rags[0].n_columns = 8, rags[0].n_rows = 6, rags[0].n_particles = 48;
  rags[1].name = "thread", rags[1].n_columns = 8, rags[1].n_rows = 1, rags[1].n_particles = 8;
  const auto warning = [](const std::string& forces, const std::vector<Rag>& pieces) {
    return undragged_warning(read_coupling(CaseFile::parse("[coupling]\nforces = [" + forces + "]\n").root()), pieces);
  };
  EXPECT_NE(warning(R"("sheet_drag")", rags).find("\"thread\" is neither dragged"), std::string::npos);
  EXPECT_NE(warning(R"("fibre_drag")", rags).find("\"cloth\" is neither dragged"), std::string::npos);
  EXPECT_EQ(warning(R"("sheet_drag", "fibre_drag")", rags), "");
  EXPECT_EQ(warning(R"("sheet_drag", "free_stream_drag")", rags), "");
  EXPECT_EQ(warning(R"("added_mass")", rags), "");
  EXPECT_EQ(warning(R"("sheet_drag")", {rags[0]}), "");
}

// Requirement: a two-way cloth in water so viscous that friction carries its impulse out of the kernel within a step is remarked on.
TEST(CouplingSettings, WarnsOfLongStepsInSlowFlow) {
  std::vector<Rag> rags(1);
  rags[0].n_columns = 60, rags[0].n_rows = 40, rags[0].radius = 1e-3;
  const auto warning = [&](const std::string& mode, double step) {
    const std::string text = "[coupling]\nmode = \"" + mode + "\"\nkernel_width_mm = 5\n";
    return viscous_step_warning(read_coupling(CaseFile::parse(text).root()), rags, step, 1e-3);
  };
  EXPECT_TRUE(warning("two_way", 0.025).empty());
  EXPECT_NE(warning("two_way", 0.05).find("step is 0.05 s, 2 times the square of kernel_width"), std::string::npos);
  EXPECT_TRUE(warning("one_way", 0.05).empty());
  rags[0].n_rows = 1;
  EXPECT_TRUE(warning("two_way", 0.05).empty()) << "a fibre";
}

// Requirement: the kernel width that a case does not give depends on the size of a cloth, not of its particles; on the diameter of spheres.
TEST(CouplingSettings, ChoosesAWidthForClothAndSpheres) {
  const auto width = [](const std::vector<Rag>& rags, const std::string& keys = "") {
    const auto coupling = read_coupling(CaseFile::parse("[coupling]\n" + keys).root());
    return std::pair{coupling.kernel_width(rags), assumed_kernel_width(coupling, rags)};
  };
  const auto cloth = [](double radius, double side) {
    Rag rag;
    rag.radius = radius, rag.hydrodynamic_diameter = 2 * radius;
    rag.n_columns = 2 * (rag.n_rows = static_cast<int>(std::lround(side / (2 * radius))));
    return rag;
  };
  Rag sphere;
  sphere.n_columns = sphere.n_rows = 1, sphere.hydrodynamic_diameter = 5e-3;
  for (const double radius : {1e-3, 1.5e-3, 2e-3, 2.5e-3, 4e-3}) {
    EXPECT_DOUBLE_EQ(width({cloth(radius, 0.12)}).first, 6e-3);
    EXPECT_DOUBLE_EQ(width({cloth(radius, 0.12), sphere}).first, 6e-3);
  }
  EXPECT_DOUBLE_EQ(width({cloth(1e-3, 0.12), cloth(2e-3, 0.024)}).first, 3e-3);
  EXPECT_DOUBLE_EQ(width({sphere}).first, 0.01);
  EXPECT_EQ(width({cloth(1e-3, 0.12)}).second, "[coupling] kernel_width is not given: 6 mm for cloth, independent of its particles");
  EXPECT_EQ(width({sphere}).second, "[coupling] kernel_width is not given: 10 mm, twice the largest diameter");
  EXPECT_EQ(width({sphere}, "kernel = \"cell\"").second, "");
  EXPECT_EQ(width({sphere}, "kernel_width_mm = 3").second, "");
}

// Requirement: a one-way case says which inertia of its sheets it leaves out; threads, spheres and two-way cases have no such line.
TEST(CouplingSettings, NamesTheInertiaThatOneWayLeavesOut) {
  std::vector<Rag> rags(1);
  rags[0].name = "cloth", rags[0].radius = 2e-3, rags[0].n_columns = 75, rags[0].n_rows = 55, rags[0].n_particles = 75 * 55,
  rags[0].mass = 1e-5;
  const auto lines = [&](const std::string& mode) {
    return left_out_added_mass(read_coupling(CaseFile::parse("[coupling]\nmode = \"" + mode + "\"\n").root()), rags);
  };
  ASSERT_EQ(lines("one_way").size(), 1u);
  EXPECT_NE(lines("one_way")[0].find("\"cloth\" (41.2 g)"), std::string::npos) << lines("one_way")[0];
  EXPECT_NE(lines("one_way")[0].find("up to 11.4 L of water"), std::string::npos) << lines("one_way")[0];  // pi/4 2.2^2 3 dm3
  EXPECT_TRUE(lines("two_way").empty());
  rags[0].n_rows = 1;
  EXPECT_TRUE(lines("one_way").empty());
}

// Requirement: every key of the coupling is in the manual's sections.
TEST(CouplingSettings, SectionsHoldEveryModel) {
  const auto sections = coupling_sections();
  const auto has = [&](const std::string& name) {
    return std::any_of(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
  };
  for (const char* name : {"coupling", "gravity", "coupling.free_stream_drag", "coupling.schiller_naumann"}) EXPECT_TRUE(has(name)) << name;
}

}  // namespace
}  // namespace snag
