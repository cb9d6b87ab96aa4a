#include "diagnosis/statistics/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

const double log_2pi = std::log(2 * std::numbers::pi);

// log of the normal distribution function; the asymptotic form where the function itself underflows.
double log_normal_cdf(double z) {
  if (z > -30) return std::log(0.5 * std::erfc(-z / std::numbers::sqrt2));
  return -0.5 * z * z - std::log(-z) - 0.5 * log_2pi + std::log1p(-1 / (z * z) + 3 / (z * z * z * z));
}

// log(Phi(b) - Phi(a)), a < b.
double log_normal_mass(double a, double b) {
  if (a > 0) return log_normal_mass(-b, -a);
  const double upper = std::isinf(b) ? 0 : log_normal_cdf(b);
  if (std::isinf(a)) return upper;
  return upper + std::log1p(-std::min(std::exp(log_normal_cdf(a) - upper), 1 - 1e-15));
}

// The least Phi with some of the bounded parameters held at a bound.
struct Held {
  Eigen::VectorXd d;
  double value = std::numeric_limits<double>::infinity();
};

Held least(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const std::vector<int>& held, const Eigen::VectorXd& at) {
  const int n = static_cast<int>(g.size());
  std::vector<int> free;
  Held result{Eigen::VectorXd::Zero(n)};
  for (int i = 0; i < n; ++i) {
    if (i < static_cast<int>(held.size()) && held[i])
      result.d[i] = at[i];
    else
      free.push_back(i);
  }
  const Eigen::VectorXd rest = g + H * result.d;
  const Eigen::VectorXd step = H(free, free).llt().solve(rest(free));
  for (std::size_t i = 0; i < free.size(); ++i) result.d[free[i]] = -step[static_cast<Eigen::Index>(i)];
  result.value = g.dot(result.d) + 0.5 * result.d.dot(H * result.d);
  return result;
}

// Minimum within the bounds: Phi is convex, so that the free minimum is the answer where it lies inside; else every choice of bounds is
// tried, 243 of five parameters.
Held least_within(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const int k = static_cast<int>(lower.size());
  Held best;
  for (int choice = 0; choice < static_cast<int>(std::pow(3, k)); ++choice) {
    std::vector<int> held(k);
    Eigen::VectorXd at = Eigen::VectorXd::Zero(k);
    for (int i = 0, c = choice; i < k; ++i, c /= 3) {
      held[i] = c % 3;
      at[i] = held[i] == 1 ? lower[i] : upper[i];
    }
    Held tried = least(H, g, held, at);
    bool inside = true;
    for (int i = 0; i < k; ++i) inside = inside && tried.d[i] >= lower[i] - 1e-12 && tried.d[i] <= upper[i] + 1e-12;
    if (inside && tried.value < best.value) best = std::move(tried);
    if (inside && choice == 0) break;
  }
  return best;
}

// Mean and variance of a standard normal number within bounds.
struct Truncated {
  double mean = 0, variance = 1;
};

Truncated truncated_normal(double lower, double upper) {
  const double log_mass = log_normal_mass(lower, upper);
  const auto density = [&](double z) { return std::isinf(z) ? 0 : std::exp(-0.5 * z * z - 0.5 * log_2pi - log_mass); };
  const auto times = [](double z, double d) { return d == 0 ? 0 : z * d; };
  const double at_lower = density(lower), at_upper = density(upper), mean = at_lower - at_upper;
  const double variance = 1 + times(lower, at_lower) - times(upper, at_upper) - mean * mean;
  const double width = std::isfinite(upper - lower) ? upper - lower : 1;
  return {std::clamp(mean, lower, upper), std::clamp(variance, 1e-12 * width * width, 1.0)};
}

// As above, of two parameters.
double log_rectangle_integral(const Eigen::VectorXd& g, const Eigen::MatrixXd& A, const Eigen::VectorXd& lower,
                              const Eigen::VectorXd& upper) {
  const double own = A(0, 0) - A(0, 1) * A(0, 1) / A(1, 1), width = 1 / std::sqrt(own);
  const double centre = std::clamp(-(g[0] - A(0, 1) * g[1] / A(1, 1)) / own, lower[0], upper[0]);
  const double begin = std::max(lower[0], centre - 10 * width), end = std::min(upper[0], centre + 10 * width);
  constexpr int n = 400;
  std::vector<double> terms;
  for (int i = 0; i <= n; ++i) {
    const double x = begin + (end - begin) * i / n, weight = i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2;
    terms.push_back(std::log(weight) - g[0] * x - 0.5 * A(0, 0) * x * x +
                    log_truncated_gaussian(g[1] + A(0, 1) * x, A(1, 1), lower[1], upper[1]));
  }
  return log_sum_exp(terms) + std::log(std::max(end - begin, 1e-300) / (3 * n));
}

}  // namespace

TruncatedDraw truncated_normal_draw(double lower, double upper, double uniform) {
  if (lower > 0) {  // below zero the distribution function has all its digits
    const TruncatedDraw mirrored = truncated_normal_draw(-upper, -lower, uniform);
    return {-mirrored.value, mirrored.log_mass};
  }
  const double log_mass = log_normal_mass(lower, upper);
  constexpr double far = -30;  // there the density falls as exp(-z^2/2) alone does: z^2/2 is exponential beyond the bound
  if (upper < far) {
    const double rest = std::isinf(lower) ? 0 : std::exp(0.5 * (upper * upper - lower * lower));
    return {-std::sqrt(upper * upper - 2 * std::log1p(-uniform * (1 - rest))), log_mass};
  }
  const double below = normal_cdf(lower);
  return {std::clamp(normal_quantile(std::clamp(below + uniform * std::exp(log_mass), 1e-300, 1 - 1e-16)), lower, upper), log_mass};
}

double log_truncated_gaussian(double g, double a, double lower, double upper) {
  const double centre = -g / a, width = 1 / std::sqrt(a);
  return 0.5 * g * g / a + std::log(width) + 0.5 * log_2pi + log_normal_mass((lower - centre) / width, (upper - centre) / width);
}

double log_box_integral(const Eigen::VectorXd& g, const Eigen::MatrixXd& A, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  if (g.size() == 0) return 0;
  if (g.size() == 1) return log_truncated_gaussian(g[0], A(0, 0), lower[0], upper[0]);
  if (g.size() == 2) return log_rectangle_integral(g, A, lower, upper);
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  const Eigen::MatrixXd& L = factor.matrixLLT();
  Eigen::VectorXd mean = -factor.solve(g);
  Eigen::MatrixXd V = factor.solve(Eigen::MatrixXd::Identity(g.size(), g.size()));
  double log_integral = -0.5 * g.dot(mean) + 0.5 * static_cast<double>(g.size()) * log_2pi - L.diagonal().array().log().sum();
  std::vector<Eigen::Index> open(static_cast<std::size_t>(g.size()));
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = static_cast<Eigen::Index>(i);
  while (!open.empty()) {
    const auto score = [&](double bound, Eigen::Index i) { return (bound - mean[i]) / std::sqrt(V(i, i)); };
    const auto log_mass = [&](Eigen::Index i) { return log_normal_mass(score(lower[i], i), score(upper[i], i)); };
    const auto next = std::min_element(open.begin(), open.end(), [&](auto a, auto b) { return log_mass(a) < log_mass(b); });
    const Eigen::Index i = *next;
    open.erase(next);
    log_integral += log_mass(i);
    const Truncated own = truncated_normal(score(lower[i], i), score(upper[i], i));
    const Eigen::VectorXd column = V.col(i) / std::sqrt(V(i, i));
    mean += own.mean * column;
    V -= (1 - own.variance) * column * column.transpose();
  }
  return log_integral;
}

LinearSolution solve(const Eigen::MatrixXd& JtJ, const Eigen::VectorXd& Jt_rho, double rho_square, const Eigen::VectorXd& prior,
                     const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const int n = static_cast<int>(prior.size()), k = static_cast<int>(lower.size());
  if (!JtJ.allFinite() || !Jt_rho.allFinite() || !std::isfinite(rho_square))
    throw Error(
        ExitCode::usage,
        "diagnosis: deviations over their uncertainties are too large to be squared; are the uncertainties too small, in other units "
        "than the data, or are data wrong by powers of ten?");
  LinearSolution solution;
  solution.precision = JtJ + Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd g = Jt_rho - prior;
  const Held best = least_within(solution.precision, g, lower, upper);
  solution.d = best.d;
  solution.objective = 0.5 * rho_square + 0.5 * prior.squaredNorm() + best.value;
  solution.covariance = solution.precision.llt().solve(Eigen::MatrixXd::Identity(n, n));
  // The unbounded parameters integrate to a determinant, the bounded ones to a truncated Gaussian.
  const auto& H = solution.precision;
  const int m = n - k;
  const Eigen::VectorXd gradient = g + H * best.d;
  Eigen::MatrixXd A = H.topLeftCorner(k, k);
  double log_determinant = 0;
  if (m > 0) {
    const Eigen::LLT<Eigen::MatrixXd> rest(H.bottomRightCorner(m, m));
    const Eigen::MatrixXd factor = rest.matrixL();
    log_determinant = 2 * factor.diagonal().array().log().sum();
    A -= H.topRightCorner(k, m) * rest.solve(H.bottomLeftCorner(m, k));
  }
  double log_prior_mass = 0;
  for (int i = 0; i < k; ++i) log_prior_mass += log_normal_mass(lower[i] - prior[i], upper[i] - prior[i]);
  solution.log_evidence = -solution.objective - 0.5 * log_determinant - 0.5 * k * log_2pi - log_prior_mass +
                          log_box_integral(gradient.head(k), A, lower - best.d.head(k), upper - best.d.head(k));
  return solution;
}

LinearSolution solve(const LinearModel& model) {
  return solve(model.J.transpose() * model.J, model.J.transpose() * model.rho, model.rho.squaredNorm(), model.prior, model.lower,
               model.upper);
}

}  // namespace snag
