// A sphere with added mass, pressure gradient and history against exact solutions of its linear equation of motion.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "sphere_motion.hpp"

namespace snag {
namespace {

using std::numbers::pi;
constexpr double rho = 1000, g = 9.81;  // kg/m3, m/s2

PrescribedFlow liquid(double kinematic_viscosity) {
  PrescribedFlow flow;
  flow.density = rho, flow.kinematic_viscosity = kinematic_viscosity;
  return flow;
}

/// Terms of  M dv/dt + K v + B int (t - tau)^(-1/2) dv/dtau dtau = W.
struct Sphere {
  double d, density, nu;
  double volume() const { return pi / 6 * d * d * d; }
  double M() const { return volume() * (density + 0.5 * rho); }
  double K() const { return 3 * pi * rho * nu * d; }
  double B() const { return 1.5 * d * d * std::sqrt(pi * rho * rho * nu); }
  double weight() const { return volume() * (rho - density) * g; }  // upwards, with buoyancy
  double terminal() const { return weight() / K(); }
};

/// exp(x^2) erfc(x).
double scaled_erfc(double x) {
  if (x < 20) return std::exp(x * x) * std::erfc(x);
  const double y = 1 / (x * x);
  return (1 - y * (0.5 - y * (0.75 - y * 1.875))) / (x * std::sqrt(pi));
}

/// From rest, with real roots of z^2 + sqrt(pi) B/M z + K/M (densities up to 5/8 of the fluid's): Brush, Ho and Yen (1964).
double velocity_from_rest(const Sphere& s, double t) {
  const double b = std::sqrt(pi) * s.B() / s.M(), root = std::sqrt(b * b - 4 * s.K() / s.M()), p = 0.5 * (b + root), q = 0.5 * (b - root);
  const auto part = [&](double z) { return (1 - scaled_erfc(z * std::sqrt(t))) / z; };
  return s.weight() / s.M() / (p - q) * (part(q) - part(p));
}

const std::string linear = "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nforces = [\"free_stream_drag\", ";

// Requirement: a light sphere released in still fluid follows the exact solution with Stokes drag, added mass and history, from a
// half of the viscous time to forty times it; without history it is far off.
TEST(UnsteadySphere, RisesWithHistory) {
  const Sphere s{1e-3, 300, 1e-4};  // Re = 0.4 at the end
  ASSERT_LT(std::abs(s.terminal()) * s.d / s.nu, 0.5);
  const double viscous_time = s.d * s.d / (4 * s.nu);
  std::vector<double> worst;
  for (const int steps_per_time : {20, 40, 80}) {
    PieceInFlow run(sphere_piece(s.d, s.density), linear + "\"added_mass\", \"history\"]\n", liquid(s.nu));
    double largest = 0;
    for (int n = 1; n <= 40 * steps_per_time; ++n) {
      run.solver.step(viscous_time / steps_per_time);
      const double t = run.rags.time();
      if (t > 0.5 * viscous_time)
        largest = std::max(largest, std::abs(run.velocity().z - velocity_from_rest(s, t)) / std::abs(s.terminal()));
    }
    worst.push_back(largest);
  }
  std::printf("  largest errors %.2e %.2e %.2e of the terminal velocity\n", worst[0], worst[1], worst[2]);
  for (const double error : worst) EXPECT_LT(error, 3e-4);  // that of the sum of exponentials is 5e-4 of the history force
  PieceInFlow without(sphere_piece(s.d, s.density), linear + "\"added_mass\"]\n", liquid(s.nu));
  without.advance(4 * viscous_time, 400);
  EXPECT_GT(std::abs(without.velocity().z - velocity_from_rest(s, 4 * viscous_time)), 0.1 * std::abs(s.terminal()));
}

// Requirement: a sphere that has long moved at v0 and is let go slows down by v0 less what one from rest under the force K v0 reaches; one
// that is set in motion at the start is slowed much more, by B v0 t^(-1/2).
TEST(UnsteadySphere, DevelopedSlipHasNoPast) {
  const Sphere s{1e-3, 300, 1e-4};
  const double v0 = 0.3 * s.nu / s.d, viscous_time = s.d * s.d / (4 * s.nu), end = 4 * viscous_time;
  const auto velocity = [&](const std::string& form) {
    PieceInFlow run(
        sphere_piece(s.d, s.density, {}, {v0, 0, 0}),
        "[coupling]\nforces = [\"free_stream_drag\", \"added_mass\", \"history\"]\n[coupling.history]\nform = \"" + form + "\"\n",
        liquid(s.nu));
    run.advance(end, 320);
    return run.velocity().x;
  };
  const double reached = velocity_from_rest(s, end) / s.weight() * s.K();  // of v0
  EXPECT_NEAR(velocity("developed") / v0, 1 - reached, 1e-3);
  EXPECT_LT(velocity("basset") / v0, 0.7 * (1 - reached));
}

// Requirement: a sphere that spins freely has the lift of the shear only.
TEST(UnsteadySphere, FreeSpinHasNoLift) {
  PrescribedFlow flow = liquid(1e-5);
  flow.gradient[0] = {0, 4, 0};
  const auto end = [&](const std::string& lift) {
    PieceInFlow run(sphere_piece(5e-3, 1150, {0, 0.01, 0}, {0.1, 0, 0}),
                    "[coupling]\nforces = [\"schiller_naumann\", \"lift\"]\n[coupling.lift]\n" + lift, flow);
    run.advance(0.1, 100);
    return run.position();
  };
  const Vec3 free = end("form = \"mei_free\"\n"), held = end("form = \"mei\"\n");
  EXPECT_EQ(free, end("form = \"mei\"\nrotation_coefficient = 0.0\n"));
  EXPECT_GT(norm(free - held), 1e-5);
}

// Requirement: steps a hundred times the viscous time neither ring nor blow up, light as the sphere may be.
TEST(UnsteadySphere, LongStepsAreStable) {
  for (const double density : {1.0, 300.0, 8000.0}) {
    const Sphere s{1e-3, density, 1e-4};
    PieceInFlow run(sphere_piece(s.d, s.density), linear + "\"added_mass\", \"pressure_gradient\", \"history\", \"lift\", \"torque\"]\n",
                    liquid(s.nu));
    double largest = 0;
    for (int n = 0; n < 200; ++n) {
      run.solver.step(100 * s.d * s.d / (4 * s.nu));
      largest = std::max(largest, norm(run.velocity()));
    }
    EXPECT_LT(largest, 1.15 * std::abs(s.terminal())) << density;
    EXPECT_NEAR(run.velocity().z, s.terminal(), 0.05 * std::abs(s.terminal())) << density;
  }
}

// Requirement: in a fluid that oscillates, u = a sin(w t), a sphere under drag, added mass and pressure gradient ends in the exact
// amplitude and phase of  (m + m_a) dv/dt = K (u - v) + (m_f + m_a) du/dt,  for light, neutral and heavy spheres.
TEST(UnsteadySphere, FollowsAnOscillation) {
  for (const double density : {100.0, 1000.0, 5000.0}) {
    const Sphere s{2e-3, density, 1e-4};
    const double amplitude = 1e-3, w = 2 * s.K() / s.M(), m_f = s.volume() * rho;
    PrescribedFlow flow = liquid(s.nu);
    flow.amplitude = {amplitude, 0, 0}, flow.omega = {w, 0, 0};
    PieceInFlow run(sphere_piece(s.d, s.density), "[coupling]\nforces = [\"free_stream_drag\", \"added_mass\", \"pressure_gradient\"]\n",
                    flow);
    const std::complex<double> i(0, 1), response = (s.K() + i * w * 1.5 * m_f) / (s.K() + i * w * s.M());
    const double period = 2 * pi / w;
    run.advance(10 * period, 10 * 2000);
    double error = 0, square = 0;
    for (int n = 0; n < 2000; ++n) {
      const double before = run.velocity().x, mass = run.rags.rags()[0].mass;
      run.solver.step(period / 2000);
      const double given = mass * (run.velocity().x - before) / (period / 2000);
      EXPECT_NEAR(run.solver.report().force_on_rags.x, given, 1e-9 * mass * amplitude * w);
      const double exact = amplitude * std::imag(response * std::exp(i * (w * run.rags.time())));
      error += std::pow(run.velocity().x - exact, 2), square += exact * exact;
    }
    EXPECT_LT(std::sqrt(error / square), 3e-3) << density;
    if (density == rho) {
      EXPECT_NEAR(std::abs(response), 1, 1e-12);
    }
  }
}

// Requirement: the same with history: the steady response has K + (1 + i) B sqrt(pi w/2) in place of K.
TEST(UnsteadySphere, HistoryInAnOscillation) {
  const Sphere s{2e-3, 3000, 1e-4};
  const double amplitude = 1e-3, w = s.K() / s.M(), m_f = s.volume() * rho;
  PrescribedFlow flow = liquid(s.nu);
  flow.amplitude = {amplitude, 0, 0}, flow.omega = {w, 0, 0};
  PieceInFlow run(sphere_piece(s.d, s.density),
                  "[coupling]\nforces = [\"free_stream_drag\", \"added_mass\", \"pressure_gradient\", \"history\"]\n", flow);
  const std::complex<double> i(0, 1), resistance = s.K() + s.B() * std::sqrt(pi * w) * std::sqrt(i);
  const std::complex<double> response = (resistance + i * w * 1.5 * m_f) / (resistance + i * w * s.M());
  const double period = 2 * pi / w;
  run.advance(20 * period, 20 * 1000);
  double error = 0, square = 0;
  for (int n = 0; n < 1000; ++n) {
    run.solver.step(period / 1000);
    const double exact = amplitude * std::imag(response * std::exp(i * (w * run.rags.time())));
    error += std::pow(run.velocity().x - exact, 2), square += exact * exact;
  }
  std::printf("  rms error %.2e of the response\n", std::sqrt(error / square));
  EXPECT_LT(std::sqrt(error / square), 5e-3);
}

// Requirement: a candidate of the diagnosis at strength zero leaves a run what it is, to the bit, in each of its forms.
TEST(UnsteadySphere, EffectsAtZeroAreTheBase) {
  PrescribedFlow flow = liquid(1e-5);
  flow.amplitude = {0.1, 0, 0.05}, flow.omega = {3, 0, 5}, flow.gradient[0] = {0, 4, 0};
  flow.turbulent_kinetic_energy = 0.01, flow.dissipation_rate = 0.05;
  const std::string base = "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nforces = [\"schiller_naumann\"";
  const auto run = [&](const std::string& text) {
    PieceInFlow piece(sphere_piece(5e-3, 1150, {0.01, 0.02, 0}), text, flow);
    WallSet walls;
    walls.add_plane("wall", {0, 0, 0}, {1, 0, 0});
    piece.solver.set_walls(walls);
    piece.advance(0.1, 100);
    return std::pair(piece.position(), piece.velocity());
  };
  const auto expected = run(base + "]\n");
  for (const std::string& name : fluid_forces().names()) {
    const auto force = fluid_forces().make(name, "test");
    if (name == "gravity" || !force->description().prior) continue;
    const std::string key = force->description().prior->key;
    std::vector<std::string> forms{""};
    for (const auto& parameter : force->parameters())
      if (parameter.key == "form") forms = parameter.choices;
    for (const std::string& form : forms) {
      const auto found = run(base + ", \"" + name + "\"]\n[coupling." + name + "]\n" + key.substr(key.rfind('.') + 1) + " = 0.0\n" +
                             (form.empty() ? "" : "form = \"" + form + "\"\n"));
      EXPECT_EQ(found.first, expected.first) << name << " " << form;
      EXPECT_EQ(found.second, expected.second) << name << " " << form;
    }
  }
}

}  // namespace
}  // namespace snag
