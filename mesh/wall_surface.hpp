#pragma once
// Walls as triangles, for particles: from patches of the mesh or from STL. Every rank holds all of them.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct WallTriangle {
  std::array<Vec3, 3> node;         // m; right-handed about the normal
  Vec3 normal;                      // unit, out of the fluid
  int part = 0;                     // index into parts
  std::array<int, 3> node_index{};  // shared nodes have the same index: edges and corners are not counted twice
  int face = 0;                     // of a mesh: place of its face among those of all ranks, in order of ranks, patches as named, faces
};

struct WallSurface {
  std::vector<std::string> parts;  // patch names
  std::vector<WallTriangle> triangles;
};

/// Triangles of the named patches of a mesh, quadrilaterals split; sorted by cell and face of the mesh file, so the same on any number of
/// ranks. Collective.
WallSurface wall_surface(const Mesh& mesh, const std::vector<std::string>& patches);
/// ASCII or binary STL as one part; nodes closer than 1e-9 of the size are joined. Collective; throws Error(io).
WallSurface read_stl(const std::filesystem::path& file, const std::string& part, double scale = 1);

}  // namespace snag
