#pragma once
// The border between a turning and a standing zone whose meshes share no nodes: at any angle the faces of both sides are cut into facets,
// each a face between one rotor cell and one stator cell.
//
//   Facets tile both sides:   sum over the facets of an interface face = its area vector,   to 1e-12 of it
//   Cells close:              sum of face vectors and facets of a cell = 0,                 to 1e-12 of its surface
// provided that the mesh carries the geometry of curve() and everything of the rotor is turned by rotation(angle). Facets sweep no volume.
// A piece smaller than 1e-13 of the smaller of its faces is round-off and left out; what is left out is part of the check of each face.
//
// Cost: some 0.4 us a facet, shared out over all ranks, one exchange of 64 bytes a facet with the owners of its sides, and one small
// reduction.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/sliding/sliding_surface.hpp"

namespace snag {

class SlidingBins;

/// The cell on one side of a facet.
struct FacetSide {
  std::int64_t cell_id = 0;  // of the mesh file
  int rank = 0;              // that owns the cell
  int cell = 0, face = 0;    // local numbers there: owned cell, boundary face of the interface's patch that the facet is a part of, as the
                             // mesh was when the interface was built
  double share = 0;          // of that face's area
};

struct Facet {
  FacetSide rotor, stator;
  Vec3 vector, centre;  // rotor -> stator, m2; mean point of the facet, m: where it is at this angle, in the frame of the stator
  double area = 0;      // on the surface of revolution, m2; a little more than |vector|
};

class SlidingInterface {
 public:
  /// Every rank holds the faces of both sides. Collective; throws Error(mesh) as revolved_surface() does. The mesh is not kept.
  SlidingInterface(const Mesh& mesh, const SlidingDescription& description);
  ~SlidingInterface();
  SlidingInterface(SlidingInterface&&) noexcept;

  /// Facets of which this rank owns a cell, with the rotor turned by `angle` (rad, right-handed about the axis) from where the mesh file
  /// has it; in the same order, and to the bit the same numbers, on both ranks of a facet. Collective; throws Error(mesh) where a
  /// face is not covered by the other side, as require_cover() does.
  std::vector<Facet> facets(double angle) const;

  /// Matrix that turns vectors of the rotor by `angle`, consistent with facets() to round-off at any number of turns.
  Mat3 rotation(double angle) const;
  /// Point of the rotor at angle 0 -> where it is at the angle of `rotation`.
  Vec3 turned_point(const Mat3& rotation, const Vec3& point) const;

  /// Gives the mesh (rotor at angle 0) the curved edges of the interface: vectors and centres of faces, volumes and centres of cells,
  /// delta, weight, nodes. Collective.
  void curve(Mesh& mesh) const;
  /// Volume that each local face of the turning zone sweeps along its vector per time, m3/s, zero on the interface and on other zones'
  /// faces; the same at every angle. Sums to zero over every cell. `omega`: rad/s.
  std::vector<double> mesh_flux(const Mesh& mesh, double omega) const;

  const RevolvedSurface& surface() const { return *surface_; }
  const SlidingDescription& description() const { return description_; }

 private:
  SlidingDescription description_;
  MPI_Comm comm_;
  std::unique_ptr<RevolvedSurface> surface_;
  std::unique_ptr<SlidingBins> bins_;  // of the stator's faces
};

}  // namespace snag
