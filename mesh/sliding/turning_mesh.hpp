#pragma once
// A mesh with a turning zone: at each angle the zone's geometry is turned and the two sides of its interface are joined by facets.
//
// Facets are interior faces [mesh.first_facet, mesh.n_interior): every operator that loops over the faces crosses the interface by them.
// Their number changes with the angle, and boundary faces move along behind them: face numbers of the boundary are kept as f - n_interior,
// per-face fields go through resize_facets(). The patches of the interface leave the list of patches. Cells that may become partners across
// the interface are ghosts from the beginning, so that cell fields keep their size.
//
// Everything is computed from the geometry at angle 0: an angle is reached with the same numbers whatever came before.
#include <vector>

#include "mesh/sliding/sliding_interface.hpp"

namespace snag {

class TurningMesh {
 public:
  /// Gives the mesh (at angle 0, as it was read) the curved interface and joins it at `angle`; warns of bounded weights there. The mesh
  /// must outlive this object. Collective; throws Error(mesh) as SlidingInterface does.
  TurningMesh(Mesh& mesh, const SlidingDescription& description, double angle = 0);

  /// Bring the zone to `angle` (rad, from where the mesh file has it). Collective; throws Error(mesh) where a face is not covered.
  void turn(double angle);
  double angle() const { return angle_; }

  /// Index of the turning zone in mesh.zones.
  int zone() const { return zone_; }
  const SlidingDescription& description() const { return interface_.description(); }
  /// Volume that each face sweeps along its vector per time when the zone turns with `omega` (rad/s), m3/s, [n_faces].
  void set_mesh_flux(double omega, std::vector<double>& flux) const;
  /// Largest |sum of face vectors| of a cell at the interface over the sum of their lengths. Collective.
  double closure() const;
  /// Facets of all ranks, each counted once. Collective.
  std::int64_t n_facets_global() const;
  /// Those of them at this angle that lie so near the end of the line between the centres of their cells, or beyond it, that their
  /// interpolation weight is a bound instead of the linear one. Collective.
  std::int64_t n_bounded_global() const;

 private:
  void release_interface();
  void add_ghosts();
  void number_interface_cells();
  void keep_reference();
  void turn_geometry();
  void join(const std::vector<Facet>& facets);
  int cell_of(const FacetSide& side) const;

  Mesh& mesh_;
  SlidingInterface interface_;
  int zone_ = 0;
  double angle_ = 0;
  std::int64_t n_bounded_ = 0;
  // of what turns, at angle 0
  struct Turning {
    std::vector<int> cell, face, boundary_face, node;  // boundary_face: f - n_interior
    std::vector<Vec3> cell_centre, face_vector, face_centre, node_position;
    std::vector<std::pair<int, Vec3>> period;  // of faces joined across one: of delta what the centres lack
  };
  Turning reference_;
  std::vector<double> unit_mesh_flux_, unit_boundary_mesh_flux_;  // at omega = 1 of Turning::face, of boundary faces
  std::vector<std::pair<std::int64_t, int>> cell_of_id_;          // of all local cells at the interface, sorted
};

/// Makes room for the facets of the new angle in a field [n_faces] that was sized for the old one: the values on facets become `value`,
/// those of all other faces stay.
template <class T>
void resize_facets(const Mesh& mesh, std::vector<T>& field, const T& value = {}) {
  const auto n_boundary = static_cast<std::size_t>(mesh.n_faces - mesh.n_interior);
  const std::size_t n_old = field.size() - n_boundary, n_new = static_cast<std::size_t>(mesh.n_interior);
  if (n_new + n_boundary > field.capacity()) field.reserve((n_new + n_boundary) / 64 * 65);
  if (n_new > n_old)
    field.insert(field.begin() + static_cast<std::ptrdiff_t>(n_old), n_new - n_old, value);
  else
    field.erase(field.begin() + static_cast<std::ptrdiff_t>(n_new), field.begin() + static_cast<std::ptrdiff_t>(n_old));
  std::fill(field.begin() + mesh.first_facet, field.begin() + mesh.n_interior, value);
}

}  // namespace snag
