#pragma once
// The two sides of a sliding interface as one surface of revolution, the same on every rank.
//
//   cylinder part   r = R:  edges are straight in (theta, z)
//   disc part       z = Z:  edges are straight in the plane, those on its rims are arcs
//
// Radii R of cylinders and rims and levels Z of discs and rims are levelled over both sides (they differ by the accuracy of the mesh file),
// so that both sides cover exactly the same surface.
#include <array>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/sliding/sliding_clip.hpp"

namespace snag {

/// The turning zone and its border.
struct SlidingDescription {
  Vec3 origin{};                                // a point of the axis, m
  Vec3 axis{0, 0, 1};                           // direction; angles turn right-handed about it
  std::string rotor_zone = "rotor";             // turns; every other zone stands
  std::string rotor_patch = "interface_rotor";  // faces of rotor cells
  std::string stator_patch = "interface_stator";
  std::filesystem::path gap_picture{};  // a .vtp for the faces of both sides that do not cover each other, should there be any; "": none
};

/// An angle in units of 2^-64 turns: sums and differences wrap around by themselves and are exact.
using Angle = std::uint64_t;
Angle angle_of(double radians);
/// From `from` to `to`, rad, within half a turn either way.
inline double radians(Angle from, Angle to) {
  return static_cast<double>(static_cast<std::int64_t>(to - from)) * (2 * std::numbers::pi * 0x1p-64);
}

/// Cartesian frame with its third axis along the axis of rotation.
struct AxisFrame {
  Vec3 origin;
  Mat3 axes;  // rows: unit vectors
  explicit AxisFrame(const SlidingDescription& description);
  Vec3 components(const Vec3& v) const { return axes * v; }
  Vec3 position(const Vec3& x) const { return axes * (x - origin); }
  Vec3 vector_from(const Vec3& v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
  Vec3 point_from(const Vec3& x) const { return origin + vector_from(x); }
};

struct RevolvedNode {
  std::int64_t id = 0;  // node_id of the mesh
  double r = 0, z = 0;  // m
  Angle angle = 0;
  /// Components in the axis frame, m.
  Vec3 position(Angle turn = 0) const;
  Point2 plane_position(Angle turn = 0) const;
};

struct RevolvedFace {
  std::int64_t cell_id = 0;
  int rank = 0, cell = 0, face = 0;  // who owns it, and its local numbers there
  bool is_disc = false;
  int part = 0;  // index into radii (cylinder) or levels (disc)
  int sign = 1;  // of the component of its vector along r (cylinder) or z (disc), out of its cell
  int n_nodes = 0;
  std::array<int, 4> node{};            // counter-clockwise in (theta, z) or (x, y)
  double outer_rim = 0, inner_rim = 0;  // radii of the arcs of a disc face, 0 for none
  std::array<bool, 4> is_arc{};         // edge i of a disc face, node i -> i + 1
  double area = 0;                      // on the surface of revolution, m2
};

struct RevolvedSide {
  std::vector<RevolvedNode> node;  // by id
  std::vector<RevolvedFace> face;  // by cell_id, then nodes: the same order on any number of ranks
};

struct RevolvedSurface {
  AxisFrame frame;
  std::vector<double> radii, levels;  // m
  RevolvedSide rotor, stator;
  std::vector<std::pair<std::int64_t, std::int64_t>> curved_edges;  // lower and higher node_id, sorted

  const RevolvedNode* node_of(std::int64_t id) const;  // null if it is not on the interface
  bool is_curved(std::int64_t a, std::int64_t b) const;
};

/// Gathers both patches. Collective. Throws Error(mesh) if a face lies on neither a cylinder nor a disc, a rim is no circle, a face is not
/// convex or wider than a third of a turn, or the zones share a face.
RevolvedSurface revolved_surface(const Mesh& mesh, const SlidingDescription& description);

/// A face in its plane: (phi, z) about a base, or (x, y).
struct FlatFace {
  Polygon polygon;                      // arcs at outer rims are replaced by their tangents, at inner rims by their chords
  double outer_rim = 0, inner_rim = 0;  // m, the circles that cut it
};
/// Area on the disc and first moment, `centre`: where the axis meets the plane.
Moments disc_moments(const FlatFace& face, Point2 centre);
FlatFace flat_cylinder_face(const RevolvedSide& side, const RevolvedFace& face, Angle turn, Angle base);
/// `plane`: positions of the side's nodes.
FlatFace flat_disc_face(const RevolvedFace& face, const std::vector<Point2>& plane, Point2 base);

}  // namespace snag
