// Every force of the registry is held to the same rules; a new file in coupling/forces/ is tested without a line here.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"
#include "coupling/kernel_shape.hpp"
#include "tests/sources.hpp"

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

/// Does nothing where the force has one form only.
void choose_form(FluidForce& force, const std::string& form) {
  for (const auto& parameter : force.parameters())
    if (parameter.key == "form") std::get<AnyChoice*>(parameter.target)->choose(form);
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
      choose_form(force, form);
      const bool on_drag = force.description().role != Role::force;
      for (const double extreme : {prior.minimum, prior.maximum}) set_strength(force, name, extreme);
      bool is_seen = false;
      for (const bool is_cloth : {true, false}) {
        SphereState s = slanted_state();
        if (!is_cloth) s.next_row = {};  // a fibre
        const SphereLoad base = on_drag ? base_load(s) : SphereLoad{};
        set_strength(force, name, 0);
        const SphereLoad none = load_on_sphere(force, s);
        EXPECT_EQ(none.force, base.force);
        EXPECT_EQ(none.torque, base.torque);
        EXPECT_EQ(none.slope, base.slope);
        EXPECT_EQ(none.added_mass, base.added_mass);
        set_strength(force, name, prior.mean);
        const SphereLoad there = load_on_sphere(force, s);
        is_seen = is_seen || norm(there.force - base.force) > 0 || norm(there.torque) > 0;
      }
      EXPECT_TRUE(is_seen);
    }
  });
}

// Requirement: what comes along the axis of a fibre does not change the drag across it (independence principle of Taylor 1952), cloth and
// spheres keep their drag, and along the axis each form has its law: of a swept layer 5.4 Re^(-1/2) cos(i) sin(i)^(1/2) of rho U^2 d/2.
TEST(Forces, DragOfAFibreByItsAxis) {
  const auto law = fluid_forces().make("fibre_drag", "test");
  SphereState s;
  s.next_in_row = {s.diameter, 0, 0};
  const double across = 0.5, rho = s.fluid_density, d = s.diameter;
  choose_form(*law, "swept");
  for (const double along : {0.0, 0.5, 5.0}) {
    s.fluid_velocity = {along, across, 0};
    const double Re = rho * std::hypot(along, across) * d / s.dynamic_viscosity, sine = across / std::hypot(along, across);
    const double pressure = 0.5 * rho * (along * along + across * across) * d * d;
    const Vec3 F = load_on_sphere(*law, s).force;
    EXPECT_NEAR(F.y, pressure * (1.1 * sine * sine + 4 / std::sqrt(Re) * std::pow(sine, 1.5)), 1e-12 * F.y) << along;
    EXPECT_NEAR(F.x, pressure * 5.4 / std::sqrt(Re) * std::sqrt((1 - sine * sine) * sine), 1e-12 * F.y) << along;
    EXPECT_EQ(F.z, 0);
  }
  SphereState cloth = s, sphere = s;
  cloth.next_row = {0, s.diameter, 0}, sphere.next_in_row = {};
  for (const SphereState& other : {cloth, sphere}) EXPECT_EQ(load_on_sphere(*law, other).force, base_load(other).force);
}

// Requirement: of two particles in a row at the angle i to the slip each has the share 1 - theta cos(i)^2 of its drag with form "mutual".
// With form "wake" only the one behind has it. With form "bonded" each has 1 - theta/4 at any angle.
TEST(Forces, ShelterInARow) {
  const auto law = fluid_forces().make("shielding", "test");
  const double theta = 0.5;
  set_strength(*law, "shielding", theta);
  for (const double i : {0.0, 0.6, 1.5}) {
    SphereState ahead;
    ahead.begins_row = true;
    ahead.fluid_velocity = {0.4, 0, 0};
    ahead.next_in_row = ahead.diameter * Vec3{std::cos(i), std::sin(i), 0};  // its neighbour is downstream
    SphereState behind = ahead;
    behind.next_in_row = -1 * ahead.next_in_row;
    const double drag = base_load(ahead).force.x, sheltered = (1 - theta * std::cos(i) * std::cos(i)) * drag;
    const auto expect = [&](const char* form, double of_ahead, double of_behind) {
      choose_form(*law, form);
      EXPECT_NEAR(load_on_sphere(*law, ahead).force.x, of_ahead, 1e-12 * drag) << form << ", angle " << i;
      EXPECT_NEAR(load_on_sphere(*law, behind).force.x, of_behind, 1e-12 * drag) << form << ", angle " << i;
    };
    expect("mutual", sheltered, sheltered);
    expect("wake", drag, sheltered);
    expect("bonded", (1 - theta / 4) * drag, (1 - theta / 4) * drag);
  }
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

}  // namespace
}  // namespace snag
