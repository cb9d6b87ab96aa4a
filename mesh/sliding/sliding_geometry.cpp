// Equations and symbols: sliding_geometry.hpp. Further, for a piece of a cylinder, along its border:
//
//   S = R (closed-integral sin(phi) dz, closed-integral (1 - cos(phi)) dz),   A = R integral dphi dz,   mean of (x, y) = R S / A
//   on a line of half spans alpha, beta about (phi_m, z_m):   integral (cos, sin)(phi) dz = 2 beta sin(alpha)/alpha (cos, sin)(phi_m)
#include "mesh/sliding/sliding_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/geometry.hpp"
#include "mesh/shapes.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

// Below this share of the surrounding polygon's area a quotient of moments is noise, and the middle of the polygon stands in for it.
constexpr double noise_share = 1e-6;

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

/// The sliver between an edge's curve and its chord, in the axis frame.
struct Sliver {
  Vec3 vector, chord_middle, centre;  // c, m2; m, m; of its area, m: 2/5 of the sagitta from the chord
};

Sliver sliver(const RevolvedNode& a, const RevolvedNode& b) {
  const double alpha = 0.5 * radians(a.angle, b.angle), beta = 0.5 * (b.z - a.z), R = a.r;
  const double theta = radians(0, a.angle) + alpha;
  const Vec3 e_r{std::cos(theta), std::sin(theta), 0}, e_t{-e_r.y, e_r.x, 0};
  Sliver s;
  s.vector = -2 * R * beta * (sinc(alpha) - std::cos(alpha)) * e_t + Vec3{0, 0, R * R * (alpha - std::sin(alpha) * std::cos(alpha))};
  s.chord_middle = R * std::cos(alpha) * e_r + Vec3{0, 0, 0.5 * (a.z + b.z)};
  s.centre = s.chord_middle + 0.4 * R * (1 - std::cos(alpha)) * e_r;
  return s;
}

/// Volume and first moment of cones from o over the parts of a cell's surface.
struct Cones {
  Vec3 o;
  double volume = 0;
  Vec3 moment{};  // about o
  /// Over a part of volume V whose points have the mean x; sign -1 takes it away.
  void add(double V, const Vec3& x, double sign = 1) {
    volume += sign * V;
    moment += 0.75 * sign * V * (x - o);
  }
};

/// The mesh as the interface sees it: positions in the axis frame, nodes of the interface on the surface of revolution.
class CurvedMesh {
 public:
  CurvedMesh(const Mesh& mesh, const RevolvedSurface& surface)
      : mesh_(mesh), surface_(surface), patch_(static_cast<std::size_t>(mesh.n_faces)) {
    for (std::size_t n = 0; n < mesh.node.size(); ++n) {
      const RevolvedNode* node = surface.node_of(mesh.node_id[n]);
      revolved_.push_back(node);
      position_.push_back(node ? node->position() : surface.frame.position(mesh.node[n]));
    }
    fill_patches(surface.rotor), fill_patches(surface.stator);
  }

  bool touches(std::span<const int> nodes) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](int n) { return revolved_[n] != nullptr; });
  }
  bool is_on_interface(int node) const { return revolved_[node] != nullptr; }
  const Vec3& position(int node) const { return position_[node]; }
  std::span<const int> face_nodes(int f) const { return row(mesh_.face_node_start, mesh_.face_node, f); }

  FaceGeometry flat_face(int f) const {
    std::array<Vec3, 8> points;
    return face_geometry(positions(position_, face_nodes(f), points));
  }

  /// Face vector and centre, in the axis frame.
  FaceGeometry face(int f) const {
    const FaceGeometry flat = flat_face(f);
    FaceGeometry result{flat.vector, flat.centre};
    for_each_sliver(f, [&](const Sliver& s) { result.vector += s.vector; });
    if (patch_[f].area > 0) {
      result.centre = patch_[f].centre;
      return result;
    }
    const Vec3& S = result.vector;
    Vec3 offset;
    for_each_sliver(f, [&](const Sliver& s) { offset += dot(s.vector, S) * (s.centre - flat.centre); });
    if (norm_squared(S) > 0) result.centre += offset / norm_squared(S);
    return result;
  }

  /// Volume and centre of an owned cell, in the axis frame: those of its chords, then slivers and pieces of the surface of revolution.
  CellGeometry cell(int c) const {
    std::array<Vec3, 8> points;
    const auto nodes = positions(position_, row(mesh_.cell_node_start, mesh_.cell_node, c), points);
    const CellGeometry flat = cell_geometry(mesh_.cell_shape[c], nodes);
    Cones cones{flat.centre, flat.volume};
    int last = -1;
    for (const int f : row(mesh_.cell_face_start, mesh_.cell_face, c)) {
      const bool is_owner = mesh_.owner[f] == c && f != last;  // a cell that is its own neighbour lists the face twice
      last = f;
      if (patch_[f].area > 0) {
        add_patch(f, cones);
        continue;
      }
      const Vec3 shift = is_owner ? Vec3{} : period(f);
      for_each_sliver(f, [&](const Sliver& s) {
        cones.add((is_owner ? 1 : -1) * dot(s.chord_middle - shift - cones.o, s.vector) / 3, s.centre - shift);
      });
    }
    return {cones.volume, cones.o + cones.moment / cones.volume};
  }

  /// -1/2 closed-integral r^2 dz.
  double turning_flux(int f) const {
    if (patch_[f].area > 0) return 0;
    double integral = 0;
    for_each_edge(f, [&](int a, int b, bool is_curved) {
      const Vec3 &x = position_[a], &y = position_[b];
      const double r_squared =
          is_curved ? revolved_[a]->r * revolved_[a]->r : (x.x * x.x + x.y * x.y + x.x * y.x + x.y * y.y + y.x * y.x + y.y * y.y) / 3;
      integral += r_squared * (y.z - x.z);
    });
    return -0.5 * integral;
  }

 private:
  template <class Act>
  void for_each_edge(int f, const Act& act) const {
    const auto nodes = face_nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const int a = nodes[i], b = nodes[(i + 1) % nodes.size()];
      act(a, b, revolved_[a] && revolved_[b] && surface_.is_curved(mesh_.node_id[a], mesh_.node_id[b]));
    }
  }
  template <class Act>
  void for_each_sliver(int f, const Act& act) const {
    for_each_edge(f, [&](int a, int b, bool is_curved) {
      if (is_curved) act(sliver(*revolved_[a], *revolved_[b]));
    });
  }

  /// From the neighbour's side of a face to the owner's where they are a period apart.
  Vec3 period(int f) const { return surface_.frame.components(snag::period(mesh_, f)); }

  void fill_patches(const RevolvedSide& side) {
    std::vector<Point2> plane;
    for (const RevolvedNode& node : side.node) plane.push_back(node.plane_position());
    const int rank = rank_of(mesh_.comm);
    for (const RevolvedFace& face : side.face) {
      if (face.rank != rank) continue;
      PatchGeometry& patch = patch_[face.face];
      const RevolvedNode& first = side.node[face.node[0]];
      if (face.is_disc) {
        const Point2 base = plane[face.node[0]];
        patch = disc_patch(flat_disc_face(face, plane, base), base, first.z);
      } else {
        patch = cylinder_patch(flat_cylinder_face(side, face, 0, first.angle).polygon, first.r);
        patch.centre = turned(patch.centre, radians(0, first.angle));
      }
      height_.resize(patch_.size(), 0);
      height_[face.face] = face.sign * (face.is_disc ? first.z : first.r);
    }
  }

  /// The cone over the piece of the surface of revolution takes the place of that over the flat face.
  void add_patch(int f, Cones& cones) const {
    const PatchGeometry& patch = patch_[f];
    cones.add((height_[f] * patch.area - dot(cones.o, face(f).vector)) / 3, patch.centre);
    const auto nodes = face_nodes(f);
    Vec3 mean;
    for (const int n : nodes) mean += position_[n] / static_cast<double>(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 &a = position_[nodes[i]], &b = position_[nodes[(i + 1) % nodes.size()]];
      cones.add(dot(a - cones.o, cross(b - cones.o, mean - cones.o)) / 6, (a + b + mean) / 3, -1);
    }
  }

  const Mesh& mesh_;
  const RevolvedSurface& surface_;
  std::vector<Vec3> position_;                 // of nodes
  std::vector<const RevolvedNode*> revolved_;  // of nodes; null off the interface
  std::vector<PatchGeometry> patch_;           // of faces; area 0 off the interface
  std::vector<double> height_;                 // of faces: r or z of the piece along its normal, m
};

}  // namespace

Vec3 turned(const Vec3& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

PatchGeometry cylinder_patch(const Polygon& polygon, double R) {
  const Point2 mean = middle(polygon);
  double S_r = 0, S_t = 0, box = 0;
  for (int i = 0; i < polygon.n; ++i) {
    const Point2 a = polygon[i], b = polygon.after(i);
    const double beta = 0.5 * (b.y - a.y), span = 2 * beta * sinc(0.5 * (b.x - a.x)), phi = 0.5 * (a.x + b.x);
    S_r += span * std::sin(phi);
    S_t += 2 * beta - span * std::cos(phi);
    box = std::max(box, dot(a - mean, a - mean));
  }
  PatchGeometry patch{R * moments(polygon).area, {R * S_r, R * S_t, 0}, {R * std::cos(mean.x), R * std::sin(mean.x), mean.y}};
  if (patch.area > noise_share * R * box) patch.centre = {R * patch.vector.x / patch.area, R * patch.vector.y / patch.area, mean.y};
  return patch;
}

PatchGeometry disc_patch(const FlatFace& face, Point2 base, double Z) {
  const Moments m = disc_moments(face, Point2{} - base);
  const bool is_whole = face.outer_rim == 0 && face.inner_rim == 0;
  const bool is_noise = m.area <= noise_share * moments(face.polygon).area;
  const Point2 mean = base + (is_whole || is_noise ? middle(face.polygon) : 1 / m.area * m.first);
  return {m.area, {0, 0, m.area}, {mean.x, mean.y, Z}};
}

CurvedGeometry curved_geometry(const Mesh& mesh, const RevolvedSurface& surface) {
  const CurvedMesh curved(mesh, surface);
  const AxisFrame& frame = surface.frame;
  CurvedGeometry result;
  for (int n = 0; n < static_cast<int>(mesh.node.size()); ++n) {
    if (!curved.is_on_interface(n)) continue;
    result.node.push_back(n);
    result.node_position.push_back(frame.point_from(curved.position(n)));
  }
  for (int f = 0; f < mesh.n_faces; ++f) {
    if (!curved.touches(curved.face_nodes(f))) continue;
    const FaceGeometry face = curved.face(f);
    result.face.push_back(f);
    result.face_vector.push_back(frame.vector_from(face.vector));
    result.face_centre.push_back(frame.point_from(face.centre));
  }
  for (int c = 0; c < mesh.n_cells; ++c) {
    if (!curved.touches(row(mesh.cell_node_start, mesh.cell_node, c))) continue;
    const CellGeometry cell = curved.cell(c);
    result.cell.push_back(c);
    result.cell_volume.push_back(cell.volume);
    result.cell_centre.push_back(frame.point_from(cell.centre));
  }
  return result;
}

void replace_geometry(const CurvedGeometry& geometry, Mesh& mesh) {
  const std::vector<Vec3> flat_centre = mesh.cell_centre;
  for (std::size_t i = 0; i < geometry.node.size(); ++i) mesh.node[geometry.node[i]] = geometry.node_position[i];
  for (std::size_t i = 0; i < geometry.face.size(); ++i) {
    mesh.face_vector[geometry.face[i]] = geometry.face_vector[i];
    mesh.face_centre[geometry.face[i]] = geometry.face_centre[i];
  }
  for (std::size_t i = 0; i < geometry.cell.size(); ++i) {
    mesh.cell_volume[geometry.cell[i]] = geometry.cell_volume[i];
    mesh.cell_centre[geometry.cell[i]] = geometry.cell_centre[i];
  }
  mesh.halo.exchange(mesh.cell_volume);
  mesh.halo.exchange(mesh.cell_centre);
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    if (N < 0) {
      mesh.delta[f] = mesh.face_centre[f] - mesh.cell_centre[P];
      continue;
    }
    // across a period too, where delta is not the difference of the centres
    mesh.delta[f] += (mesh.cell_centre[N] - flat_centre[N]) - (mesh.cell_centre[P] - flat_centre[P]);
    const Vec3 from_face = mesh.cell_centre[P] + mesh.delta[f] - mesh.face_centre[f];
    mesh.weight[f] = dot(mesh.face_vector[f], from_face) / dot(mesh.face_vector[f], mesh.delta[f]);
  }
}

std::vector<double> turning_flux(const Mesh& mesh, const RevolvedSurface& surface, int zone) {
  const CurvedMesh curved(mesh, surface);
  std::vector<double> flux(static_cast<std::size_t>(mesh.n_faces), 0);
  for (int f = 0; f < mesh.n_faces; ++f)
    if (mesh.cell_zone[mesh.owner[f]] == zone) flux[f] = curved.turning_flux(f);
  return flux;
}

}  // namespace snag
