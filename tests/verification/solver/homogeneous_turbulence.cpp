// ranks: 1
// Requirement: models of k and epsilon follow the exact solution of their equations where nothing depends on the place.
#include <gtest/gtest.h>

#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double k_start = 0.3, epsilon_start = 0.6;  // m2/s2, m2/s3

/// k and epsilon in a periodic box whose velocity gradient is given, without a momentum equation.
class Homogeneous {
 public:
  Homogeneous(const std::string& model, const Mat3& gradient)
      : mesh_(structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 2}, {true, true, true})),
        boundary_(mesh_, {}),
        workspace_(mesh_),
        flow(mesh_),
        turbulence_(read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"" + model +
                                                    "\"\ntolerance = 1e-12\ninitial_k = \"0.3 m2/s2\"\ninitial_epsilon = \"0.6 m2/s3\"\n")
                                        .root())) {
    flow.dynamic_viscosity = 1e-12;  // (nu epsilon)^(1/2) is nothing against k
    std::fill(flow.velocity_gradient.begin(), flow.velocity_gradient.end(), gradient);
    turbulence_->prepare(flow, boundary_, workspace_);
    turbulence_->start(flow, boundary_);
  }
  void advance(double dt) {
    const TimeScheme time = bdf(dt, before_);
    turbulence_->begin_step(flow, time);
    turbulence_->correct(flow, boundary_, time, 0);
    before_ = dt;
  }
  double k() const { return flow.turbulent_kinetic_energy[0]; }
  double epsilon() const { return flow.dissipation_rate[0]; }

 private:
  Mesh mesh_;
  BoundarySet boundary_;
  Workspace workspace_;

 public:
  Flow flow;

 private:
  std::unique_ptr<Turbulence> turbulence_;
  double before_ = 0;
};

Mat3 shear(double S) { return {Vec3{0, S, 0}, Vec3{}, Vec3{}}; }

/// C_mu of the model in a flow with this gradient, at the start.
double C_mu_in(const Mat3& gradient) {
  const Homogeneous water("realizable_k_epsilon", gradient);
  return water.flow.eddy_viscosity[0] * epsilon_start / (k_start * k_start);
}

/// Rate of k and of epsilon over k S and epsilon S in homogeneous shear with eta = S k/epsilon.
struct Rates {
  double k, epsilon;
};
Rates standard(double eta) { return {0.09 * eta - 1 / eta, 1.44 * 0.09 * eta - 1.92 / eta}; }
/// D:D = W:W = S^2/2 and w = 0: U = S, A_s = 6^(1/2) cos(pi/6).
Rates realizable(double eta) {
  const double C_mu = 1 / (4 + std::sqrt(4.5) * eta);
  return {C_mu * eta - 1 / eta, std::max(0.43, eta / (eta + 5)) - 1.9 / eta};
}

/// The root of d eta/dt = 0, where production over dissipation stays.
double asymptote(Rates (*rates)(double)) {
  double low = 1, high = 20;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    const Rates at = rates(middle);
    (at.k > at.epsilon ? low : high) = middle;
  }
  return low;
}

/// k and epsilon at St = `end` by the classical method of Runge and Kutta in ln k and ln epsilon.
std::pair<double, double> exact_shear(Rates (*rates)(double), double S, double end) {
  double ln_k = std::log(k_start), ln_e = std::log(epsilon_start);
  constexpr int n = 20000;
  const double h = end / n;
  const auto at = [&](double dk, double de) { return rates(S * std::exp(ln_k + dk - ln_e - de)); };
  for (int i = 0; i < n; ++i) {
    const Rates a = at(0, 0), b = at(0.5 * h * a.k, 0.5 * h * a.epsilon), c = at(0.5 * h * b.k, 0.5 * h * b.epsilon),
                d = at(h * c.k, h * c.epsilon);
    ln_k += h / 6 * (a.k + 2 * b.k + 2 * c.k + d.k), ln_e += h / 6 * (a.epsilon + 2 * b.epsilon + 2 * c.epsilon + d.epsilon);
  }
  return {std::exp(ln_k), std::exp(ln_e)};
}

void check_shear(const std::string& model, Rates (*rates)(double)) {
  constexpr double S = 7, end = 10;  // 1/s; St
  const auto [k, epsilon] = exact_shear(rates, S, end);
  std::vector<double> h, error;
  for (const int steps : {200, 400, 800}) {
    Homogeneous water(model, shear(S));
    for (int i = 0; i < steps; ++i) water.advance(end / S / steps);
    h.push_back(1.0 / steps), error.push_back(std::abs(water.k() / k - 1) + std::abs(water.epsilon() / epsilon - 1));
  }
  EXPECT_GT(observed_order(("homogeneous shear, " + model).c_str(), h, error), 1.8);
  EXPECT_LT(error.back(), 5e-3);

  const double eta = asymptote(rates);
  std::printf("%s: S k/epsilon at last %.3f\n", model.c_str(), eta);
  Homogeneous water(model, shear(S));
  for (int i = 0; i < 2000; ++i) water.advance(0.02 / S);
  EXPECT_NEAR(S * water.k() / water.epsilon() / eta, 1, 0.01);
}

}  // namespace

// Without strain the realizable model decays with k/epsilon = T + (C_2 - 1) t, C_2 = 1.9, second order in time.
TEST(HomogeneousTurbulence, realizable_decay) {
  constexpr double C_2 = 1.9, T = k_start / epsilon_start;
  const double k = k_start * std::pow(1 + (C_2 - 1) / T, -1 / (C_2 - 1)),
               epsilon = epsilon_start * std::pow(1 + (C_2 - 1) / T, -C_2 / (C_2 - 1));
  std::vector<double> h, error;
  for (const int steps : {40, 80, 160, 320}) {
    Homogeneous water("realizable_k_epsilon", {});
    for (int i = 0; i < steps; ++i) water.advance(1.0 / steps);
    h.push_back(1.0 / steps), error.push_back(std::abs(water.k() / k - 1) + std::abs(water.epsilon() / epsilon - 1));
  }
  EXPECT_GT(observed_order("decay, realizable", h, error), 1.8);
  EXPECT_LT(error.back(), 1e-3);
}

// In homogeneous shear both models follow their equations to second order in time, and S k/epsilon goes to its limit: of the standard model
// ((C_2 - 1)/(C_mu (C_1 - 1)))^(1/2), of the realizable one the root of its equations.
TEST(HomogeneousTurbulence, standard_shear) {
  EXPECT_NEAR(asymptote(standard), std::sqrt(0.92 / (0.09 * 0.44)), 1e-9);
  check_shear("k_epsilon", standard);
}
TEST(HomogeneousTurbulence, realizable_shear) { check_shear("realizable_k_epsilon", realizable); }

// C_mu in shear, plane strain, axisymmetric expansion and contraction, and rotation: with A_s = 6^(1/2) cos(arccos(6^(1/2) w)/3).
TEST(HomogeneousTurbulence, realizable_C_mu) {
  constexpr double T = k_start / epsilon_start, S = 7;
  const auto C_mu = [&](double A_s, double U) { return 1 / (4 + A_s * U * T); };
  const double A_plane = std::sqrt(6) * std::cos(pi / 6), A_expanding = std::sqrt(6) * std::cos(pi / 3), A_contracting = std::sqrt(6);
  EXPECT_NEAR(C_mu_in({}), 0.25, 1e-12);
  EXPECT_NEAR(C_mu_in(shear(S)), C_mu(A_plane, S), 1e-12);
  EXPECT_NEAR(C_mu_in({Vec3{S, 0, 0}, Vec3{0, -S, 0}, Vec3{}}), C_mu(A_plane, std::sqrt(2) * S), 1e-12);
  // w = 6^(-1/2) where one direction grows and two shrink, - 6^(-1/2) where two grow
  EXPECT_NEAR(C_mu_in({Vec3{2 * S, 0, 0}, Vec3{0, -S, 0}, Vec3{0, 0, -S}}), C_mu(A_contracting, std::sqrt(6) * S), 1e-7);
  EXPECT_NEAR(C_mu_in({Vec3{-2 * S, 0, 0}, Vec3{0, S, 0}, Vec3{0, 0, S}}), C_mu(A_expanding, std::sqrt(6) * S), 1e-7);
  // pure rotation: D = 0, W:W = S^2/2
  EXPECT_NEAR(C_mu_in({Vec3{0, 0.5 * S, 0}, Vec3{-0.5 * S, 0, 0}, Vec3{}}), C_mu(A_plane, S / std::sqrt(2)), 1e-12);
}

// No normal stress is negative at any strain: 2/3 k >= 2 nu_t D_11 in the direction of the largest strain rate.
TEST(HomogeneousTurbulence, realizable_normal_stress) {
  for (const double S : {1.0, 10.0, 100.0, 1000.0})
    for (const Mat3& gradient : {Mat3{Vec3{S, 0, 0}, Vec3{0, -S, 0}, Vec3{}}, Mat3{Vec3{2 * S, 0, 0}, Vec3{0, -S, 0}, Vec3{0, 0, -S}}}) {
      const Homogeneous water("realizable_k_epsilon", gradient);
      EXPECT_LE(2 * water.flow.eddy_viscosity[0] * gradient[0].x, 2. / 3 * k_start);
    }
}

// Cloth that eddies do not cross: nu_t and production of k fall by 1 + L s, L = nu_t/(C_mu^(1/4) k^(1/2)).
TEST(HomogeneousTurbulence, cloth_hinders_exchange) {
  constexpr double S = 7, s = 20, dt = 1e-6;
  for (const char* model : {"k_epsilon", "realizable_k_epsilon"}) {
    Homogeneous water(model, shear(S));
    const double nu_t = water.flow.eddy_viscosity[0], L = nu_t / (std::pow(0.09, 0.25) * std::sqrt(k_start));
    EXPECT_GT(L * s, 0.5);
    water.flow.screen.assign(water.flow.eddy_viscosity.size(), s);
    water.advance(dt);
    EXPECT_NEAR((water.k() - k_start) / dt, nu_t * S * S / (1 + L * s) - epsilon_start, 1e-4) << model;
    EXPECT_NEAR(water.flow.face_viscosity[0], water.flow.density * nu_t / (1 + L * s), 1e-5 * water.flow.density * nu_t) << model;
  }
}
