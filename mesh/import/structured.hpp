#pragma once
// Boxes of hexahedra or tetrahedra without a file: for tests and for canonical cases.
#include <array>

#include "mesh/mesh.hpp"

namespace snag {

/// A box of n[0] x n[1] x n[2] hexahedra; patches x0, x1, y0, y1, z0, z1 (joined to periodic where periodic[axis]); blocks of slabs along z
/// per rank.
Mesh structured_box(MPI_Comm comm, Vec3 lower, Vec3 upper, std::array<int, 3> n, std::array<bool, 3> periodic = {});

struct BoxShape {
  Vec3 lower{}, upper{1, 1, 1};  // m
  double distortion = 0;  // inner nodes are displaced by up to this share of the spacing along each axis; below 0.2 no cell turns over
};

/// The same box with each hexahedron cut into six tetrahedra, and its inner nodes displaced at random (the same on any number of ranks).
Mesh tetrahedral_box(MPI_Comm comm, const BoxShape& shape, std::array<int, 3> n, std::array<bool, 3> periodic = {});

}  // namespace snag
