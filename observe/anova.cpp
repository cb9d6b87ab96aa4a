#include "observe/anova.hpp"

#include <boost/math/distributions/fisher_f.hpp>

namespace snag {

Anova anova(std::span<const double> means, std::span<const double> deviations, std::span<const double> counts) {
  double n = 0, grand = 0;
  for (std::size_t i = 0; i < means.size(); ++i) n += counts[i], grand += counts[i] * means[i];
  grand /= n;
  double between = 0, within = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    between += counts[i] * (means[i] - grand) * (means[i] - grand);
    within += (counts[i] - 1) * deviations[i] * deviations[i];
  }
  const double groups = static_cast<double>(means.size());
  if (n <= groups || within <= 0) return {};
  const double F = between / (groups - 1) / (within / (n - groups));
  return {F, boost::math::cdf(boost::math::complement(boost::math::fisher_f(groups - 1, n - groups), F))};
}

}  // namespace snag
