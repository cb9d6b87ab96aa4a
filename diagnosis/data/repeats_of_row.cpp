#include "diagnosis/data/repeats_of_row.hpp"

#include <cmath>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

// n numbers of mean 0 and sample variance 1: normal quantiles, scaled.
std::vector<double> scores(int n) {
  std::vector<double> z;
  double square = 0;
  for (int i = 0; i < n; ++i) z.push_back(normal_quantile((i + 0.5) / n)), square += z.back() * z.back();
  for (double& value : z) value *= std::sqrt((n - 1) / square);
  return z;
}

}  // namespace

MeanAndSd of_logarithm(const MeanAndSd& quantity) {
  const double ratio = quantity.sd / quantity.mean, variance = std::log1p(ratio * ratio);
  return {.mean = std::log(quantity.mean) - 0.5 * variance, .sd = std::sqrt(variance)};
}

std::vector<Datum> repeats_of(const DatumRow& row, const Observable& observable) {
  using Kind = Observable::Kind;
  std::vector<Datum> repeats(static_cast<std::size_t>(row.n), row.datum);
  for (int i = 0; i < row.n; ++i) repeats[static_cast<std::size_t>(i)].replicate += i;
  if (observable.kind == Kind::event || observable.kind == Kind::count) {
    const auto total = std::llround(row.datum.value * row.n), each = total / row.n, rest = total % row.n;
    for (int i = 0; i < row.n; ++i) repeats[static_cast<std::size_t>(i)].value = static_cast<double>(each + (i < rest));
    return repeats;
  }
  if (row.sd == 0) return repeats;
  const std::vector<double> z = scores(row.n);
  const MeanAndSd logarithm = observable.kind == Kind::lognormal ? of_logarithm({row.datum.value, row.sd}) : MeanAndSd{};
  for (std::size_t i = 0; i < z.size(); ++i)
    repeats[i].value =
        observable.kind == Kind::lognormal ? std::exp(logarithm.mean + logarithm.sd * z[i]) : row.datum.value + row.sd * z[i];
  return repeats;
}

}  // namespace snag
