// By counting how many values are in each part of an interval, which then shrinks to the part that holds the quantile.
#include "parallel/quantile.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "parallel/sum.hpp"

namespace snag {

double quantile(MPI_Comm comm, std::vector<double> values, double p) {
  constexpr int n_parts = 1024, n_rounds = 4;  // to 1e-12 of the range
  const std::int64_t n = sum(comm, static_cast<std::int64_t>(values.size()));
  if (n == 0) return 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) low = std::min(low, value), high = std::max(high, value);
  low = minimum(comm, low), high = maximum(comm, high);
  std::int64_t place = std::min(static_cast<std::int64_t>(p * static_cast<double>(n)), n - 1);  // the quantile's, in ascending order
  if (place == 0) return low;
  if (place == n - 1) return high;
  for (int round = 0; round < n_rounds && high > low; ++round) {
    const double per_part = n_parts / (high - low);
    const auto part = [&](double value) { return std::clamp(static_cast<int>((value - low) * per_part), 0, n_parts - 1); };
    std::vector<std::int64_t> counts(n_parts, 0);
    for (const double value : values) ++counts[part(value)];
    MPI_Allreduce(MPI_IN_PLACE, counts.data(), n_parts, MPI_INT64_T, MPI_SUM, comm);
    int found = 0;
    while (place >= counts[found]) place -= counts[found++];
    std::erase_if(values, [&](double value) { return part(value) != found; });
    const double begun = low;
    low = begun + found / per_part, high = begun + (found + 1) / per_part;
  }
  return 0.5 * (low + high);
}

}  // namespace snag
