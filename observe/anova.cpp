#include "observe/anova.hpp"

#include <boost/math/distributions/fisher_f.hpp>

namespace snag {

namespace {

Anova anova_with_share(std::span<const double> means, std::span<const double> deviations, std::span<const double> counts, double share) {
  double n = 0, grand = 0;
  for (std::size_t i = 0; i < means.size(); ++i) n += share * counts[i], grand += share * counts[i] * means[i];
  grand /= n;
  double between = 0, within = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    between += share * counts[i] * (means[i] - grand) * (means[i] - grand);
    within += (share * counts[i] - 1) * deviations[i] * deviations[i];
  }
  const double groups = static_cast<double>(means.size());
  if (n <= groups || within <= 0) return {};
  const double F = between / (groups - 1) / (within / (n - groups));
  return {F, boost::math::cdf(boost::math::complement(boost::math::fisher_f(groups - 1, n - groups), F))};
}

}  // namespace

Anova anova(std::span<const double> means, std::span<const double> deviations, std::span<const double> counts) {
  return anova_with_share(means, deviations, counts, 1);
}

double independent_share(std::span<const double> means, std::span<const double> deviations, std::span<const double> counts, double p) {
  double low = 0.02, high = 1;
  if (anova_with_share(means, deviations, counts, high).p > p) return 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (anova_with_share(means, deviations, counts, middle).p > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace snag
