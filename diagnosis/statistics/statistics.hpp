#pragma once
// Tests and numbers of statistics that the diagnosis rests on. Pure functions.
#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace snag {

/// Normal numbers from a seed, the same with every compiler (the standard library leaves its normal distribution open).
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : engine_(seed) {}
  double operator()();
  /// In [0, 1).
  double uniform();
  /// In 0 .. n-1.
  int index(int n) { return static_cast<int>(uniform() * n); }

 private:
  std::mt19937_64 engine_;
};

double log_sum_exp(std::span<const double> values);
double normal_cdf(double z);
double normal_quantile(double p);
/// Standard normal deviates that fill the distribution evenly where seeds follow each other, so that the few runs of a diagnosis have its
/// spread: quantiles of a Weyl sequence with the golden ratio.
double even_normal_deviate(std::uint64_t seed);
/// Two-sided p of a normal score.
double two_sided_p(double z);
/// Score z >= 0 whose two-sided p this is, at most 38.
double score_of_p(double p);
/// P(chi2 with n degrees of freedom > value).
double chi_squared_tail(double value, double n);

/// Clopper-Pearson interval of a probability after k of n.
std::array<double, 2> clopper_pearson(int k, int n, double level = 0.95);
/// Two-sided p that two samples of events, k1 of n1 and k2 of n2, have one probability (Fisher's exact test).
double fisher_exact(int k1, int n1, int k2, int n2);
/// Two-sided p that counts with these sums over n1 and n2 tests have one rate (conditional binomial test), after division of the
/// sums by the overdispersion (variance over mean, at least 1).
double equal_rates(double sum1, int n1, double sum2, int n2, double overdispersion = 1);

/// A time until an event, or until the test ended without it.
struct Lifetime {
  double time = 0;
  bool censored = false;
};
struct LogRank {
  double z = 0, p = 1;  // z > 0: events of the first sample come earlier than in the second
};
LogRank log_rank(std::span<const Lifetime> a, std::span<const Lifetime> b);

/// 2 E|X - Y| - E|X - X'| - E|Y - Y'|, of samples.
double energy_distance(std::span<const double> a, std::span<const double> b);
/// p of the energy distance by permutations, deterministic for a seed. Of more than 500 values 500 quantiles stand for them: with few
/// values on the other side p is the same, with as many the test is weaker.
double energy_test(std::span<const double> first, std::span<const double> second, std::uint64_t seed, int permutations = 2000);

/// Which hypotheses are rejected at this false discovery rate.
std::vector<bool> benjamini_hochberg(std::span<const double> p, double rate = 0.05);

/// n log(RSS/n) + k log n of a least-squares fit: of a line in x, and of a step between two sets (below: those in the first set).
double bic_of_line(std::span<const double> x, std::span<const double> y);
double bic_of_step(const std::vector<bool>& first, std::span<const double> y);

}  // namespace snag
