#pragma once
// Faces of the four cell shapes in VTK's numbering of nodes, each cycle right-handed about the way out of the cell.
// VTK's prism (wedge) is the one whose triangle 0 1 2 turns right-handed about the way out; the other bases turn about the way in.
#include <array>
#include <span>

#include "mesh/mesh.hpp"

namespace snag {

struct ShapeFace {
  int n_nodes;
  std::array<int, 4> node;
};

inline std::span<const ShapeFace> faces_of(CellShape shape) {
  static constexpr std::array<ShapeFace, 4> tetrahedron{{{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {0, 3, 2}}}};
  static constexpr std::array<ShapeFace, 5> pyramid{{{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
  static constexpr std::array<ShapeFace, 5> prism{
      {{3, {0, 1, 2}}, {3, {3, 5, 4}}, {4, {0, 3, 4, 1}}, {4, {1, 4, 5, 2}}, {4, {2, 5, 3, 0}}}};
  static constexpr std::array<ShapeFace, 6> hexahedron{
      {{4, {0, 3, 2, 1}}, {4, {4, 5, 6, 7}}, {4, {0, 1, 5, 4}}, {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {3, 0, 4, 7}}}};
  switch (shape) {
    case CellShape::tetrahedron:
      return tetrahedron;
    case CellShape::pyramid:
      return pyramid;
    case CellShape::prism:
      return prism;
    default:
      return hexahedron;
  }
}

constexpr int n_nodes_of(CellShape shape) {
  constexpr std::array<int, 4> count{4, 5, 6, 8};
  return count[static_cast<std::size_t>(shape)];
}

}  // namespace snag
