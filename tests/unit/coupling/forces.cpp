// Every force of the registry is held to the same rules; a new file in coupling/forces/ is tested without a line here.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "base/error.hpp"
#include "coupling/coupled_solver.hpp"
#include "coupling/coupling_settings.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/kernel_shape.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

/// A state without symmetry: every force has something to act on.
SphereState slanted_state() {
  SphereState s;
  s.fluid_velocity = {0.3, -0.2, 0.5};
  s.velocity = {-0.1, 0.4, 0.2};
  s.angular_velocity = {20, -30, 10};
  s.velocity_gradient = {Vec3{3, -20, 7}, Vec3{5, -2, 11}, Vec3{-13, 4, -1}};
  s.pressure_gradient = {900, -400, 2000};
  s.material_acceleration = {2, -5, 3};
  s.position = {0.1, 0.2, 0.3};
  s.turbulent_kinetic_energy = 0.02, s.dissipation_rate = 0.3, s.solid_fraction = 0.2;
  s.turbulent_kinetic_energy_gradient = {0.3, -0.1, 0.2};
  s.disturbance_width = 3e-3, s.point_disturbance = 20, s.wall_distance = 1.7e-3, s.wall_normal = unit({1, -2, 2});
  s.next_in_row = {1.2e-3, 1.5e-3, -0.4e-3}, s.next_row = {0.3e-3, -0.5e-3, 1.9e-3};
  return s;
}

const Mat3 turn = [] {  // by 0.7 about (1, 2, 3)
  const Vec3 a = unit({1, 2, 3});
  const double c = std::cos(0.7), s = std::sin(0.7);
  Mat3 m;
  const Vec3 e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int j = 0; j < 3; ++j) {
    const Vec3 column = c * e[j] + s * cross(a, e[j]) + (1 - c) * dot(a, e[j]) * a;
    for (int i = 0; i < 3; ++i) m[i][j] = column[i];
  }
  return m;
}();

Mat3 turned(const Mat3& G) {
  Mat3 out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) out[i][j] += turn[i][k] * G[k][l] * turn[j][l];
  return out;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
  EXPECT_LE(norm(a - b), tolerance) << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x << ", " << b.y << ", " << b.z
                                    << ")";
}

template <class Work>
void for_each_force(const Work& work) {
  ASSERT_FALSE(fluid_forces().names().empty());
  for (const auto& name : fluid_forces().names()) {
    SCOPED_TRACE(name);
    work(*fluid_forces().make(name, "test"), name);
  }
}

// Requirement: each force gives the exact limits and published numbers that it names, and names at least one.
TEST(Forces, ReferenceCases) {
  for_each_force([](FluidForce& force, const std::string&) {
    EXPECT_FALSE(force.reference_cases().empty());
    for (const auto& reference : force.reference_cases()) {
      EXPECT_FALSE(reference.source.empty());
      const auto load = load_on_sphere(force, reference.state);
      const double scale = std::max(norm(reference.force), 1e-30);
      expect_near(load.force, reference.force, reference.tolerance * scale + 1e-18, reference.what);
      if (reference.torque)
        expect_near(load.torque, *reference.torque, reference.tolerance * norm(*reference.torque), reference.what + ": torque");
      if (reference.added_mass) {
        EXPECT_NEAR(load.added_mass, *reference.added_mass, reference.tolerance * *reference.added_mass) << reference.what;
      }
    }
  });
}

// Requirement: a force does not depend on the speed of the observer.
TEST(Forces, GalileanInvariance) {
  for_each_force([](FluidForce& force, const std::string&) {
    const SphereState at_rest = slanted_state();
    SphereState moving = at_rest;
    const Vec3 observer{1.5, -0.7, 2.2};
    moving.fluid_velocity += observer, moving.velocity += observer;
    const auto a = load_on_sphere(force, at_rest), b = load_on_sphere(force, moving);
    expect_near(a.force, b.force, 1e-12 * norm(a.force), "force");
    expect_near(a.torque, b.torque, 1e-12 * norm(a.torque), "torque");
  });
}

// Requirement: a force turns with the set-up, parameters that are vectors included; random numbers do not.
TEST(Forces, Rotation) {
  for_each_force([](FluidForce& force, const std::string&) {
    if (force.description().prior && force.description().prior->random) return;
    const SphereState s = slanted_state();
    const auto straight = load_on_sphere(force, s);
    SphereState t = s;
    for (auto member :
         {&SphereState::fluid_velocity, &SphereState::pressure_gradient, &SphereState::material_acceleration, &SphereState::position,
          &SphereState::velocity, &SphereState::angular_velocity, &SphereState::turbulent_kinetic_energy_gradient,
          &SphereState::wall_normal, &SphereState::next_in_row, &SphereState::next_row})
      t.*member = turn * (s.*member);
    t.velocity_gradient = turned(s.velocity_gradient);
    for (const auto& parameter : force.parameters())
      if (auto* vector = std::get_if<Vec3*>(&parameter.target)) **vector = turn * **vector;
    const auto load = load_on_sphere(force, t);
    expect_near(load.force, turn * straight.force, 1e-12 * norm(straight.force), "force");
    expect_near(load.torque, turn * straight.torque, 1e-12 * norm(straight.torque), "torque");
    EXPECT_NEAR(load.slope, straight.slope, 1e-12 * straight.slope);
  });
}

/// The load of schiller_naumann alone.
SphereLoad base_load(const SphereState& s) { return load_on_sphere(*fluid_forces().make("schiller_naumann", "test"), s); }

/// Sets theta, the number at the key of the prior.
void set_strength(FluidForce& force, const std::string& name, double theta) {
  const std::string key = force.description().prior->key, table = (name == "gravity" ? name : "coupling." + name) + ".";
  ASSERT_EQ(key.rfind(table, 0), 0u) << key;
  for (const auto& parameter : force.parameters()) {
    if (key_with_unit(parameter) != key.substr(table.size())) continue;
    auto* target = std::get_if<double*>(&parameter.target);
    ASSERT_NE(target, nullptr) << key;
    EXPECT_TRUE(theta >= parameter.minimum && theta <= parameter.maximum) << key << " = " << theta;
    **target = theta;
    return;
  }
  FAIL() << key << " is no key of " << name;
}

// Requirement: a candidate of the diagnosis at strength zero is the base model to the bit, and at its prior mean it is not, where the state
// has all it can need; all of the range of its prior is allowed by its key, in each of its forms.
TEST(Forces, CandidatesAreTheBaseModelAtZero) {
  for_each_force([](FluidForce& force, const std::string& name) {
    if (!force.description().prior || name == "gravity") return;  // the strength of gravity is a vector
    const Prior prior = *force.description().prior;
    EXPECT_TRUE(prior.minimum <= prior.mean && prior.mean <= prior.maximum && prior.sd > 0 && prior.minimum <= 0 && prior.maximum >= 0);
    std::vector<std::string> forms{""};
    for (const auto& parameter : force.parameters())
      if (parameter.key == "form") forms = parameter.choices;
    for (const std::string& form : forms) {
      SCOPED_TRACE(form);
      for (const auto& parameter : force.parameters())
        if (parameter.key == "form") std::get<AnyChoice*>(parameter.target)->choose(form);
      const bool on_drag = force.description().role != Role::force;
      const SphereState s = slanted_state();
      const SphereLoad base = on_drag ? base_load(s) : SphereLoad{};
      for (const double extreme : {prior.minimum, prior.maximum}) set_strength(force, name, extreme);
      set_strength(force, name, 0);
      const SphereLoad none = load_on_sphere(force, s);
      EXPECT_EQ(none.force, base.force);
      EXPECT_EQ(none.torque, base.torque);
      EXPECT_EQ(none.slope, base.slope);
      EXPECT_EQ(none.added_mass, base.added_mass);
      set_strength(force, name, prior.mean);
      const SphereLoad there = load_on_sphere(force, s);
      EXPECT_TRUE(norm(there.force - base.force) > 0 || norm(there.torque) > 0);
    }
  });
}

// Requirement: the slope given for the implicit step is what a stable step needs: not negative, finite at rest, and F = K w for a drag.
TEST(Forces, SlopeIsFiniteAndNotNegative) {
  for_each_force([](FluidForce& force, const std::string&) {
    SphereState s = slanted_state();
    for (const double speed : {0.0, 1e-12, 1e-3, 1.0, 30.0}) {
      s.velocity = s.fluid_velocity + Vec3{speed, 0, 0};
      const auto load = load_on_sphere(force, s);
      EXPECT_TRUE(std::isfinite(load.slope) && load.slope >= 0) << "speed " << speed;
      EXPECT_TRUE(std::isfinite(norm(load.force))) << "speed " << speed;
      EXPECT_GE(load.added_mass, 0);
    }
  });
}

// Requirement: folds closer than the kernel resolves (solid fraction 1 and above) leave every force finite and a drag positive.
TEST(Forces, FiniteWhereSolidsOverlap) {
  for_each_force([](FluidForce& force, const std::string&) {
    SphereState s = slanted_state();
    for (const double solid : {0.9, 1.0, 1.05}) {
      s.solid_fraction = solid;
      const auto load = load_on_sphere(force, s);
      EXPECT_TRUE(std::isfinite(norm(load.force)) && std::isfinite(load.slope)) << solid;
      EXPECT_GE(load.slope, 0) << solid;
      if (force.description().role == Role::drag) {
        EXPECT_GT(dot(load.force, s.fluid_velocity - s.velocity), 0) << solid;
        EXPECT_GT(load.slope, 0) << solid;
      }
    }
  });
}

// Requirement: only forces are spread to the water: a model that gives a couple and no force does not say that the water feels it. Nor does
// the water feel what carries the water that the particle displaces, for its inertia is in the equation of the water.
TEST(Forces, SilentAreThoseThatTheWaterDoesNotFeel) {
  for_each_force([](FluidForce& force, const std::string& name) {
    const auto load = load_on_sphere(force, slanted_state());
    const bool couple = norm(load.torque) > 0 && norm(load.force) == 0;
    EXPECT_EQ(force.description().reacts_on_fluid, !couple && name != "gravity" && name != "pressure_gradient");
  });
}

// Requirement: a force that gives torque or added mass says so in its description, for nothing else is read.
TEST(Forces, CardsDeclareWhatIsGiven) {
  for_each_force([](FluidForce& force, const std::string&) {
    const auto load = load_on_sphere(force, slanted_state());
    EXPECT_EQ(norm(load.torque) > 0, force.description().gives_torque);
    EXPECT_EQ(load.added_mass > 0, force.description().gives_added_mass);
  });
}

// Requirement: defaults lie in their ranges, every number has a unit that is known, and a meaning.
TEST(Forces, ParametersAreComplete) {
  for_each_force([](FluidForce& force, const std::string& name) {
    EXPECT_EQ(force.description().name, name);
    EXPECT_FALSE(force.description().equation.empty());
    EXPECT_FALSE(force.description().source.empty());
    for (const auto& parameter : force.parameters()) {
      SCOPED_TRACE(parameter.key);
      EXPECT_FALSE(parameter.meaning.empty());
      EXPECT_LT(parameter.minimum, parameter.maximum);
      const auto in_range = [&](double x) { EXPECT_TRUE(x >= parameter.minimum && x <= parameter.maximum) << x; };
      if (auto* number = std::get_if<double*>(&parameter.target)) in_range(**number);
      if (auto* vector = std::get_if<Vec3*>(&parameter.target))
        for (int i = 0; i < 3; ++i) in_range((**vector)[i]);
      EXPECT_NO_THROW(key_with_unit(parameter));
    }
  });
}

// Requirement: no model is dropped by the linker: a registry holds what its folder holds.
TEST(Forces, RegistryHoldsTheFolder) {
  EXPECT_EQ(fluid_forces().names().size(), n_sources("coupling/forces"));
  EXPECT_EQ(kernel_shapes().names().size(), n_sources("coupling/kernels"));
}

// Requirement: the free-stream law is the published one, with its jump of 9 % at Re = 0.5 and its constant above 1000.
TEST(Forces, FreeStreamBranches) {
  const auto law = fluid_forces().make("free_stream_drag", "test");
  const auto C_d = [&](double Re) {
    const auto reference = drag_at(Re, 1, 0, "");
    return load_on_sphere(*law, reference.state).force.x / reference.force.x;
  };
  EXPECT_NEAR(C_d(0.4), 60, 1e-9);
  EXPECT_NEAR(C_d(0.5 * (1 + 1e-9)) / C_d(0.5 * (1 - 1e-9)), 1 + 0.15 * std::pow(0.5, 0.687), 1e-7);
  EXPECT_NEAR(C_d(500), 24.0 / 500 * (1 + 0.15 * std::pow(500, 0.687)), 1e-12);
  EXPECT_NEAR(C_d(1001), 0.44, 1e-12);
}

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
  EXPECT_EQ(warnings("kernel_width_mm = 50").size(), 1u);
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
