#include "diagnosis/statistics/even_deviates.hpp"

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

std::array<double, 3> even_normal_deviates(std::uint64_t seed) {
  // 2^64 times the fractions of 13^(1/2), 17^(1/2) and 4^(1/3): irrational, and of a dozen roots and other numbers those by which the first
  // thousand places depend least on each other.
  constexpr std::array<std::uint64_t, 3> steps{0x9b05688c2b3e6c1fU, 0x1f83d9abfb41bd6bU, 0x965fea53d6e3c82bU};
  std::array<double, 3> all{};
  for (std::size_t i = 0; i < all.size(); ++i)
    all.at(i) = normal_quantile((static_cast<double>((seed * steps.at(i)) >> 11) + 0.5) * 0x1p-53);
  return all;
}

}  // namespace snag
