#pragma once
// Pictures of a computed sheet, as a camera would take them: silhouette in perspective, blurred and noisy.
#include <array>
#include <cstdint>
#include <span>

#include "observe/camera.hpp"
#include "observe/picture.hpp"

namespace snag {

/// Cloth to its rim (observe/cloth_to_rim.hpp), of particles of `radius`, m. Pixels are covered in parts of 1/16; what is behind the camera
/// is left out. `seed` of the noise.
GreyPicture photograph(std::span<const Vec3> points, std::span<const std::array<int, 3>> triangles, double radius, const Camera& camera,
                       std::uint64_t seed);
/// The same camera without cloth.
GreyPicture empty_picture(const Camera& camera, std::uint64_t seed);

}  // namespace snag
