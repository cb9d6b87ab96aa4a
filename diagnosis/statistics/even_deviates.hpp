#pragma once
// Normal deviates in space for starts of a run that scatter.
#include <array>
#include <cstdint>

namespace snag {

/// Three standard normal deviates that fill space evenly where seeds follow each other, as even_normal_deviate does in one dimension.
std::array<double, 3> even_normal_deviates(std::uint64_t seed);

}  // namespace snag
