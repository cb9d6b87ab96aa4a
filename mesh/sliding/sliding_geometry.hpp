#pragma once
// Faces and cells at a sliding interface, whose edges there are curves (the flat-edged rest of the mesh: geometry.hpp).
//
// Edge from a to b on the interface: theta and z linear in s = -1 .. 1 with half spans alpha = (theta_b - theta_a)/2, beta = (z_b - z_a)/2,
// about its middle (theta_m, z_m); between the curve and its chord lies a sliver of area vector
//
//   c = 1/2 closed-integral r x dr = -2 R beta (sin(alpha)/alpha - cos(alpha)) e_t + R^2 (alpha - sin(alpha) cos(alpha)) e_z
//
// so a face has S = S_chords + sum c, whichever surface it spans: the c of the two faces at an edge cancel and cells close.
// Volumes: the sliver is the cone over the curve from the middle m of the chord, V = (m - o).c/3; an interface face is the surface of
// revolution itself, V = (R A - o.S)/3 (cylinder, o from the axis) or (Z A - o.S)/3 (disc). Both zones together fill the domain.
// Mesh flux of a face that turns with omega:   -1/2 omega closed-integral r^2 dz, r^2 quadratic along a straight edge, R^2 on a curve.
#include <vector>

#include "mesh/sliding/sliding_surface.hpp"

namespace snag {

/// What replaces the mesh's geometry on this rank, rotor at angle 0.
struct CurvedGeometry {
  std::vector<int> node;  // local nodes on the interface
  std::vector<Vec3> node_position;
  std::vector<int> face;                       // local faces with a node on the interface, rising
  std::vector<Vec3> face_vector, face_centre;  // m2, m
  std::vector<int> cell;                       // owned cells with a node on the interface, rising
  std::vector<double> cell_volume;             // m3
  std::vector<Vec3> cell_centre;               // m
};

CurvedGeometry curved_geometry(const Mesh& mesh, const RevolvedSurface& surface);

/// Writes it into a mesh, with `delta` and `weight` of all faces that see the change, ghosts included. Collective.
void replace_geometry(const CurvedGeometry& geometry, Mesh& mesh);

/// closed-integral of -1/2 r^2 dz along the border of each local face of cells of `zone`, else 0: mesh flux per omega, along the face
/// vector, m3. The sum over the faces of a cell is zero to round-off.
std::vector<double> turning_flux(const Mesh& mesh, const RevolvedSurface& surface, int zone);

/// A piece of the surface of revolution in a frame whose third axis is that of rotation.
struct PatchGeometry {
  double area = 0;      // on the surface, m2
  Vec3 vector, centre;  // along +r or +z, m2; mean point, m
};
/// Of a cylinder of radius R between straight lines in (phi, z); the first axis points along phi = 0.
PatchGeometry cylinder_patch(const Polygon& polygon, double R);
/// Of a disc at level Z; `base`: position of the origin of the face's coordinates.
PatchGeometry disc_patch(const FlatFace& face, Point2 base, double Z);
/// `frame` turned about its third axis.
Vec3 turned(const Vec3& v, double angle);

}  // namespace snag
