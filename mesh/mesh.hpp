#pragma once
// The mesh as flat arrays: every finite-volume operator is a loop over faces, owner -> neighbour.
//
//   Cells  [0, n_cells) are owned by this rank, [n_cells, n_cells + n_ghosts) are copies of cells of other ranks.
//   Faces  [0, n_interior) lie between two local cells (at least one owned): face vector S points from owner to neighbour.
//          [n_interior, n_faces) are boundary faces of owned cells, grouped by patch: S points out of the domain, neighbour = -1.
//   The owner is the cell of the lower cell_id: both ranks of a shared face hold it with the same orientation, each adds to its own cells.
//   Periodic patches are joined to interior faces: `delta` holds the way from the owner's to the neighbour's centre, across the period,
//          so that face_centre - (cell_centre[owner] + delta) is the way from the neighbour's centre to the face on every interior face.
//          A cell one period wide is its own neighbour and lists that face twice.
//          [first_facet, n_interior) are facets of a sliding interface (mesh/sliding/turning_mesh.hpp): none without, and then first_facet
//          = n_interior.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "parallel/halo.hpp"

namespace snag {

/// A named part of the boundary: faces [first, first + count) of this rank; the same list of patches on every rank.
struct Patch {
  std::string name;
  int first = 0;
  int count = 0;
  std::int64_t count_global = 0;
  int end() const { return first + count; }
};

/// Two patches that are one surface: faces of `first` shifted by `translation` fall on those of `second`.
struct PeriodicPair {
  std::string first, second;
  Vec3 translation;
};

/// A cylinder or a disc of a sliding interface, as a line in the half-plane (r, z) about the axis.
struct InterfacePart {
  bool is_disc = false;
  double level = 0;             // r of a cylinder, z of a disc, m
  double lower = 0, upper = 0;  // ends: z of a cylinder, r of a disc, m
  int sign = 1;                 // the turning zone lies below (1) or above (-1) the level
};

/// Where the turning zone of a mesh stands, and the surface of revolution at which it ends.
struct TurningPose {
  int zone = -1;                                               // index into zones; -1: nothing turns
  Vec3 origin, axis;                                           // point of the axis, m; unit vector along it
  Mat3 rotation{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  // from where the mesh file has the zone
  std::vector<InterfacePart> parts;

  /// Where a point that turns with the zone is in the mesh file.
  Vec3 turned_back(const Vec3& x) const {
    const Vec3 v = x - origin;
    return origin + v.x * rotation[0] + v.y * rotation[1] + v.z * rotation[2];
  }
  /// Distance from the interface, m, negative on the side of the turning zone; zero on the interface counts as standing. Exact in size
  /// where the nearest point is not on a rim, right in sign everywhere near the interface.
  double distance(const Vec3& x) const;
};

enum class CellShape : std::uint8_t { tetrahedron, pyramid, prism, hexahedron };

struct Mesh {
  MPI_Comm comm = MPI_COMM_SELF;
  int n_cells = 0, n_ghosts = 0, n_interior = 0, n_faces = 0, first_facet = 0;
  std::int64_t n_cells_global = 0, n_interior_global = 0;

  // cells: owned, then ghosts
  std::vector<Vec3> cell_centre;      // m
  std::vector<double> cell_volume;    // m3
  std::vector<std::int64_t> cell_id;  // number of the cell in the mesh file, from 0: the same on any number of ranks
  std::vector<int> cell_zone;         // index into zones
  std::vector<std::string> zones;     // names of the physical volumes ("rotor", "stator")
  Halo halo;                          // of cell fields

  // faces: interior, then boundary by patch
  std::vector<int> owner, neighbour;  // local cells
  std::vector<Vec3> face_vector;      // S, m2
  std::vector<Vec3> face_centre;      // m (of the owner's side for a periodic face)
  std::vector<Vec3> delta;            // owner centre -> neighbour centre; on the boundary -> face centre, m
  std::vector<double> weight;     // linear interpolation: field_f = weight field_owner + (1 - weight) field_neighbour; 1 on the boundary
  std::vector<float> skew_share;  // of interior faces without facets: the share of its skewness that counts (mesh/skewness.hpp)
  std::vector<Patch> patches;
  // of facets, [n_interior - first_facet]: their area over that of the face that they are a part of, on the owner's and the neighbour's
  // side
  std::vector<std::array<double, 2>> facet_share;
  TurningPose turning;

  // cell -> faces of owned cells (compressed rows), all kinds of faces
  std::vector<int> cell_face_start, cell_face;

  // geometry for output, location and walls: nodes of owned cells and of local faces
  std::vector<Vec3> node;                       // m
  std::vector<std::int64_t> node_id;            // number in the mesh file, from 0
  std::vector<CellShape> cell_shape;            // owned cells
  std::vector<int> cell_node_start, cell_node;  // owned cells, nodes in VTK order
  std::vector<int> face_node_start, face_node;  // all local faces, in a cycle that turns right-handed about S

  int n_all_cells() const { return n_cells + n_ghosts; }
  /// Index of a patch; throws Error(mesh) that lists the known names.
  int patch_index(const std::string& name) const;
};

}  // namespace snag
