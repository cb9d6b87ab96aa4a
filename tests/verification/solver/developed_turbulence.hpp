#pragma once
// Developed turbulent flow in a plane channel (m = 0) or a pipe (m = 1) by the k-epsilon model or its realizable variant in one dimension,
// from the shear, which is known: tau = G r/(m + 1). An independent solution: no momentum equation, no pressure, its own grid and
// iteration.
//
//   du/dr = - tau/(mu + mu_t),   1/r^m d/dr (r^m (mu + mu_t/sigma) d phi/dr) + sources = 0,   u at the wall cell from the wall function
#include <algorithm>
#include <cmath>
#include <vector>

namespace snag::test {

struct DevelopedFlow {
  double rho = 998.2, mu = 1.003e-3;
  double radius = 0.1;  // of the pipe, or half the height of the channel, m
  int m = 1;            // 0: channel, 1: pipe
  int n = 100;          // cells
  bool realizable = false;
  double roughness = 0;  // k_s, m

  static constexpr double C_mu = 0.09, C_1 = 1.44, C_2 = 1.92, sigma_epsilon = 1.3, kappa = 0.41, E = 9.8;

  /// Mean velocity, m/s, for a pressure gradient G, Pa/m.
  double mean_velocity(double G) const {
    const double h = radius / n, nu = mu / rho, y = 0.5 * h, u_tau2 = G * radius / (m + 1) / rho;
    const auto place = [&](int i) { return (i + 0.5) * h; };
    std::vector<double> k(n, 3 * u_tau2), e(n), nu_t(n);
    for (int i = 0; i < n; ++i) e[i] = std::pow(u_tau2, 1.5) / (kappa * (radius - place(i)));
    for (int turn = 0; turn < 4000; ++turn) {
      for (int i = 0; i < n; ++i) {
        // Realizable: in shear S D:D = W:W = S^2/2, A_s U = 6^(1/2) cos(pi/6) S, with S of the turn before.
        const double S = turn > 0 ? u_tau2 * place(i) / radius / (nu + nu_t[i]) : 0;
        nu_t[i] = realizable && turn > 0 ? k[i] * k[i] / (4 * e[i] + std::sqrt(4.5) * S * k[i]) : C_mu * k[i] * k[i] / e[i];
      }
      const double u_star = std::pow(C_mu, 0.25) * std::sqrt(k[n - 1]);
      std::vector<double> production(n), source(n), sink(n);
      for (int i = 0; i < n; ++i) {
        const double slope = u_tau2 * place(i) / radius / (nu + nu_t[i]);
        production[i] = i + 1 < n ? nu_t[i] * slope * slope : u_tau2 * u_star / (kappa * y);
        source[i] = C_1 * e[i] / k[i] * production[i], sink[i] = C_2 * e[i] / k[i];
        if (realizable) {
          const double eta = slope * k[i] / e[i];
          source[i] = std::max(0.43, eta / (eta + 5)) * slope * e[i], sink[i] = 1.9 * e[i] / (k[i] + std::sqrt(nu * e[i]));
        }
      }
      const double wall_epsilon = u_star * u_star * u_star / (kappa * y);
      relax(e, nu_t, realizable ? 1.2 : sigma_epsilon, source, sink, wall_epsilon);
      for (int i = 0; i < n; ++i) sink[i] = e[i] / k[i];
      relax(k, nu_t, 1, production, sink, -1);
    }
    const double y_star = std::pow(C_mu, 0.25) * std::sqrt(k[n - 1]) * y / nu;
    std::vector<double> u(n);
    const double rough = 1 + E * std::exp(-8.5 * kappa) * std::pow(C_mu, 0.25) * std::sqrt(k[n - 1]) * roughness / nu;
    u[n - 1] = u_tau2 * y / (nu * kappa * y_star / std::log(E / rough * y_star));
    for (int i = n - 2; i >= 0; --i) {
      const double r = (i + 1) * h;
      u[i] = u[i + 1] + h * u_tau2 * r / radius / (nu + 0.5 * (nu_t[i] + nu_t[i + 1]));
    }
    double flow = 0, area = 0;
    for (int i = 0; i < n; ++i) flow += u[i] * std::pow(place(i), m), area += std::pow(place(i), m);
    return flow / area;
  }

  /// Pressure gradient for a mean velocity U.
  double pressure_gradient(double U) const {
    double G = (m + 1) * rho * U * U / 600 / radius;
    for (int i = 0; i < 6; ++i) G *= std::pow(U / mean_velocity(G), 1.8);
    return G;
  }

 private:
  /// One implicit step of 1/sink length for phi (tridiagonal); wall_value < 0: no flux through the wall.
  void relax(std::vector<double>& phi, const std::vector<double>& nu_t, double sigma, const std::vector<double>& source,
             const std::vector<double>& sink, double wall_value) const {
    const double h = radius / n;
    std::vector<double> upper(n), right(n);
    for (int i = 0; i < n; ++i) {
      const auto diffusion = [&](int a) { return (mu / rho + 0.5 * (nu_t[a] + nu_t[a + 1]) / sigma) / h * std::pow((a + 1) * h, m); };
      const double V = h * std::pow((i + 0.5) * h, m), below = i > 0 ? diffusion(i - 1) : 0, above = i + 1 < n ? diffusion(i) : 0;
      double diagonal = V * 2 * sink[i] + below + above, b = V * (source[i] + sink[i] * phi[i]), lower = below, up = above;
      if (wall_value >= 0 && i + 1 == n) diagonal = 1, b = wall_value, lower = up = 0;
      const double pivot = diagonal - (i > 0 ? lower * upper[i - 1] : 0);
      upper[i] = up / pivot, right[i] = (b + (i > 0 ? lower * right[i - 1] : 0)) / pivot;
    }
    for (int i = n - 1; i >= 0; --i) phi[i] = right[i] + (i + 1 < n ? upper[i] * phi[i + 1] : 0);
  }
};

/// Darcy friction factor of a pipe, Colebrook (1939); roughness: k_s over the diameter.
inline double colebrook(double Re, double roughness = 0) {
  double f = 0.02;
  for (int i = 0; i < 50; ++i) f = std::pow(-2 * std::log10(roughness / 3.7 + 2.51 / (Re * std::sqrt(f))), -2);
  return f;
}

}  // namespace snag::test
