#if defined(__AVX512F__)
#pragma GCC target("prefer-vector-width=512")
#endif
#include "benchmark/speed/arithmetic.hpp"

#include <algorithm>
#include <ctime>

namespace snag {

double multiply_add_rate() {
  constexpr int n_lanes = 96, n_rounds = 400000, n_passes = 8;  // twelve vectors of eight at work hide the latency
  double best = 0, kept = 0;
  for (int pass = 0; pass < n_passes; ++pass) {
    alignas(64) double value[n_lanes];
    for (int k = 0; k < n_lanes; ++k) value[k] = k + pass;
    const std::clock_t begun = std::clock();
    for (int round = 0; round < n_rounds; ++round)
#pragma omp simd
      for (int k = 0; k < n_lanes; ++k) value[k] = value[k] * 0.999 + 1e-3;
    const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    for (const double v : value) kept += v;
    if (seconds > 0) best = std::max(best, 2.0 * n_lanes * n_rounds / seconds);
  }
  return kept > 0 ? best : 0;
}

}  // namespace snag
