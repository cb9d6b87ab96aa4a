#pragma once
// Random numbers by counter: the same for the same (seed, particle, count), on any number of ranks and after a resume.
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/vec3.hpp"

namespace snag {

/// Mixing function of splitmix64: well mixed bits of a number. Source: Steele, Lea and Flood (2014), OOPSLA, 453.
inline std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

/// Uniform in (0, 1], from a mixed number.
inline double uniform(std::uint64_t z) { return (static_cast<double>(z >> 11) + 1) * 0x1p-53; }

/// Three independent standard normal numbers (Box and Muller 1958).
inline Vec3 normal_numbers(std::uint64_t seed, std::int64_t particle, std::uint64_t count) {
  const std::uint64_t key = mixed(mixed(mixed(seed) ^ static_cast<std::uint64_t>(particle)) ^ count);
  const double r = std::sqrt(-2 * std::log(uniform(mixed(key)))), phi = 2 * std::numbers::pi * uniform(mixed(key + 1));
  const double s = std::sqrt(-2 * std::log(uniform(mixed(key + 2)))), psi = 2 * std::numbers::pi * uniform(mixed(key + 3));
  return {r * std::cos(phi), r * std::sin(phi), s * std::cos(psi)};
}

}  // namespace snag
