#pragma once
// What a camera far away would see of a sheet: its silhouette as a picture, and the moments of that picture.
//
//   m_ij = sum over pixels x^i y^j,   centroid (m_10, m_01)/m_00,   area m_00 (pixel area),
//   elongation ratio and orientation: those of the ellipse with the same second-order central moments      [Jensen (2018), Eqs. A.1 - A.3]
#include <array>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "observe/coverage.hpp"

namespace snag {

/// Directions of a picture: x to the right, y up; the camera looks along -(right x up). Orthogonal unit vectors.
struct View {
  Vec3 right{1, 0, 0}, up{0, 1, 0};
};

struct Silhouette {
  double area = 0;              // m2, what covers itself counts once
  double x = 0, y = 0;          // centroid along right and up, m
  double elongation_ratio = 0;  // major over minor axis of the ellipse; 0 for an empty picture
  double orientation = 0;       // of the major axis from `right`, counter-clockwise, rad, in (-pi/2, pi/2]
};

/// Of all that is covered.
Silhouette moments(const Coverage& picture);

/// Parallel projection of cloth to its rim (observe/cloth_to_rim.hpp), of particles of these radii, m; pixel side `pixel` in metres. A
/// pixel is covered if its centre is.
Coverage covered_by(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles,
                    const View& view, double pixel);
/// Its moments.
Silhouette silhouette(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles,
                      const View& view, double pixel);

}  // namespace snag
