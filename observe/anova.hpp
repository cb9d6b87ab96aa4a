#pragma once
// One-way analysis of variance: do groups have one mean?
//
//   F = [sum n_g (mean_g - mean)^2/(a - 1)]/[sum (n_g - 1) s_g^2/(n - a)],   a groups of n_g samples, n = sum n_g,
//   p = P(F_{a-1, n-a} > F).   The counts need not be whole: those of independent samples (observe/independent_samples.hpp) take their
//   place.
#include <span>

namespace snag {

struct Anova {
  double F = 0, p = 1;
};

/// From means, standard deviations (n - 1) and counts of the groups. F = 0 and p = 1 where n <= a or nothing varies within the groups.
Anova anova(std::span<const double> means, std::span<const double> deviations, std::span<const double> counts);

}  // namespace snag
