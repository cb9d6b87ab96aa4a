// Gathering and levelling of the interface; symbols in sliding_surface.hpp.
#include "mesh/sliding/sliding_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/geometry.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double level_tolerance = 1e-6;  // of the extent: coordinates of one circle or plane agree at least so well in a mesh file

/// A face as it travels between ranks, its corners in the axis frame.
struct SentFace {
  std::int64_t cell_id = 0;
  int rank = 0, cell = 0, face = 0, n_nodes = 0;
  std::array<std::int64_t, 4> node{-1, -1, -1, -1};
  std::array<Vec3, 4> position{};
};
static_assert(std::is_trivially_copyable_v<SentFace>);

/// Of all ranks, by cell_id, then nodes. Collective.
std::vector<SentFace> faces_of(const Mesh& mesh, const AxisFrame& frame, const std::string& patch_name) {
  const Patch& patch = mesh.patches[static_cast<std::size_t>(mesh.patch_index(patch_name))];
  std::vector<SentFace> mine;
  for (int f = patch.first; f < patch.end(); ++f) {
    SentFace face{mesh.cell_id[mesh.owner[f]], rank_of(mesh.comm), mesh.owner[f], f};
    for (const int node : row(mesh.face_node_start, mesh.face_node, f)) {
      face.node[static_cast<std::size_t>(face.n_nodes)] = mesh.node_id[node];
      face.position[static_cast<std::size_t>(face.n_nodes++)] = frame.position(mesh.node[node]);
    }
    mine.push_back(face);
  }
  std::vector<SentFace> all = gathered(mesh.comm, mine);
  std::sort(all.begin(), all.end(),
            [](const SentFace& a, const SentFace& b) { return std::tie(a.cell_id, a.node) < std::tie(b.cell_id, b.node); });
  return all;
}

/// Values that agree within the tolerance count as one, their mean.
class Levels {
 public:
  Levels(std::vector<double> values, double tolerance) : tolerance_(tolerance) {
    std::sort(values.begin(), values.end());
    for (std::size_t i = 0; i < values.size();) {
      std::size_t end = i;
      double offset = 0;
      while (end < values.size() && values[end] - values[i] <= tolerance) offset += values[end++] - values[i];
      mean.push_back(values[i] + offset / static_cast<double>(end - i));
      i = end;
    }
  }
  int index(double value) const {
    const auto nearest =
        std::min_element(mean.begin(), mean.end(), [&](double a, double b) { return std::abs(a - value) < std::abs(b - value); });
    return nearest != mean.end() && std::abs(*nearest - value) <= 2 * tolerance_ ? static_cast<int>(nearest - mean.begin()) : -1;
  }
  std::vector<double> mean;

 private:
  double tolerance_;
};

using Edge = std::pair<std::int64_t, std::int64_t>;
Edge edge_of(std::int64_t a, std::int64_t b) { return std::minmax(a, b); }

double radius_of(const Vec3& x) { return std::hypot(x.x, x.y); }

/// What is known of one side before radii and levels are found.
struct RawSide {
  std::vector<SentFace> face;
  std::vector<bool> is_disc;
  std::map<std::pair<bool, Edge>, int> uses;  // of an edge by discs or by cylinders: once on a rim

  bool is_rim(std::size_t f, int i) const { return uses.at({is_disc[f], edge(f, i)}) == 1; }
  Edge edge(std::size_t f, int i) const { return edge_of(face[f].node[corner(i)], face[f].node[corner((i + 1) % face[f].n_nodes)]); }
  static std::size_t corner(int i) { return static_cast<std::size_t>(i); }
};

/// Builds the surface; throws the same on every rank because all hold the same faces.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const AxisFrame& frame, std::vector<SentFace> rotor, std::vector<SentFace> stator) : surface_{frame, {}, {}, {}, {}, {}} {
    raw_[0].face = std::move(rotor), raw_[1].face = std::move(stator);
  }

  RevolvedSurface build() {
    double extent = 0;
    for (const RawSide& side : raw_)
      for (const SentFace& face : side.face)
        for (int i = 0; i < face.n_nodes; ++i) extent = std::max(extent, radius_of(face.position[RawSide::corner(i)]));
    tolerance_ = level_tolerance * extent;
    std::vector<double> radii, levels;
    for (RawSide& side : raw_) classify(side), collect(side, radii, levels);
    radii_ = Levels(radii, tolerance_), levels_ = Levels(levels, tolerance_);
    surface_.radii = radii_.mean, surface_.levels = levels_.mean;
    fill(raw_[0], surface_.rotor), fill(raw_[1], surface_.stator);
    auto& edges = surface_.curved_edges;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return std::move(surface_);
  }

 private:
  [[noreturn]] void fail(const SentFace& face, const std::string& what) const {
    Vec3 centre;
    for (int i = 0; i < face.n_nodes; ++i) centre += face.position[RawSide::corner(i)] / face.n_nodes;
    throw Error(ExitCode::mesh, "sliding interface: the face at " + point_text(surface_.frame.point_from(centre)) + " " + what);
  }

  void classify(RawSide& side) const {
    for (const SentFace& face : side.face) {
      double low_z = largest, high_z = -largest, low_r = largest, high_r = 0;
      for (int i = 0; i < face.n_nodes; ++i) {
        const Vec3& x = face.position[RawSide::corner(i)];
        low_z = std::min(low_z, x.z), high_z = std::max(high_z, x.z);
        low_r = std::min(low_r, radius_of(x)), high_r = std::max(high_r, radius_of(x));
      }
      const bool is_disc = high_z - low_z <= tolerance_;
      if (!is_disc && high_r - low_r > tolerance_)
        fail(face, "lies on neither a cylinder nor a disc about the axis (r " + number_text(low_r) + " to " + number_text(high_r) +
                       " m, z " + number_text(low_z) + " to " + number_text(high_z) +
                       " m); both sides must be made of these: correct the mesh, the axis or its origin");
      side.is_disc.push_back(is_disc);
    }
    for (std::size_t f = 0; f < side.face.size(); ++f)
      for (int i = 0; i < side.face[f].n_nodes; ++i) ++side.uses[{side.is_disc[f], side.edge(f, i)}];
  }

  /// Radii of cylinders and of discs' rims, levels of discs and of cylinders' rims.
  void collect(const RawSide& side, std::vector<double>& radii, std::vector<double>& levels) const {
    for (std::size_t f = 0; f < side.face.size(); ++f)
      for (int i = 0; i < side.face[f].n_nodes; ++i) {
        const Vec3 &a = side.face[f].position[RawSide::corner(i)],
                   &b = side.face[f].position[RawSide::corner((i + 1) % side.face[f].n_nodes)];
        (side.is_disc[f] ? levels : radii).push_back(side.is_disc[f] ? a.z : radius_of(a));
        if (!side.is_rim(f, i)) continue;
        const double at_a = side.is_disc[f] ? radius_of(a) : a.z, at_b = side.is_disc[f] ? radius_of(b) : b.z;
        if (std::abs(at_a - at_b) > tolerance_)
          fail(side.face[f],
               "has an edge on the border of the interface that is not part of a circle about the axis; the interface must be a full "
               "surface of revolution: is the axis right?");
        auto& rims = side.is_disc[f] ? radii : levels;
        rims.push_back(at_a), rims.push_back(at_b);
      }
  }

  void fill(const RawSide& raw, RevolvedSide& side) {
    std::map<std::int64_t, RevolvedNode> node;
    for (std::size_t f = 0; f < raw.face.size(); ++f)
      for (int i = 0; i < raw.face[f].n_nodes; ++i) {
        const Vec3& x = raw.face[f].position[RawSide::corner(i)];
        node.try_emplace(raw.face[f].node[RawSide::corner(i)],
                         RevolvedNode{raw.face[f].node[RawSide::corner(i)], radius_of(x), x.z, angle_of(std::atan2(x.y, x.x))});
      }
    for (std::size_t f = 0; f < raw.face.size(); ++f) level_nodes(raw, f, node);
    std::map<std::int64_t, int> number_of;
    for (const auto& [id, n] : node) number_of[id] = static_cast<int>(side.node.size()), side.node.push_back(n);
    std::vector<Point2> plane;
    for (const RevolvedNode& n : side.node) plane.push_back(n.plane_position());
    for (std::size_t f = 0; f < raw.face.size(); ++f) side.face.push_back(finished(raw, f, number_of, side, plane));
  }

  void level_nodes(const RawSide& raw, std::size_t f, std::map<std::int64_t, RevolvedNode>& node) {
    for (int i = 0; i < raw.face[f].n_nodes; ++i) {
      const Edge edge = raw.edge(f, i);
      const bool is_rim = raw.is_rim(f, i);
      for (const std::int64_t id : {edge.first, edge.second}) {
        RevolvedNode& n = node.at(id);
        if (!raw.is_disc[f] || is_rim) n.r = levelled(radii_, n.r, raw.face[f]);
        if (raw.is_disc[f] || is_rim) n.z = levelled(levels_, n.z, raw.face[f]);
      }
      if (!raw.is_disc[f] || is_rim) surface_.curved_edges.push_back(edge);
    }
  }
  double levelled(const Levels& levels, double value, const SentFace& face) const {
    const int index = levels.index(value);
    if (index < 0) fail(face, "is not at the same position as the other faces of its surface; correct the mesh, the axis or its origin");
    return levels.mean[static_cast<std::size_t>(index)];
  }

  /// The face turned counter-clockwise, with its rims and its area.
  RevolvedFace finished(const RawSide& raw, std::size_t f, const std::map<std::int64_t, int>& number_of, const RevolvedSide& side,
                        const std::vector<Point2>& plane) const {
    const SentFace& sent = raw.face[f];
    RevolvedFace face{.cell_id = sent.cell_id, .rank = sent.rank, .cell = sent.cell, .face = sent.face, .is_disc = raw.is_disc[f]};
    face.n_nodes = sent.n_nodes;
    for (int i = 0; i < face.n_nodes; ++i) {
      face.node[RawSide::corner(i)] = number_of.at(sent.node[RawSide::corner(i)]);
      face.is_arc[RawSide::corner(i)] = face.is_disc && raw.is_rim(f, i);
    }
    const RevolvedNode first = side.node[static_cast<std::size_t>(face.node[0])];
    face.part = face.is_disc ? levels_.index(first.z) : radii_.index(first.r);
    const auto flat = [&] { return face.is_disc ? flat_disc_face(face, plane, {}) : flat_cylinder_face(side, face, 0, first.angle); };
    if (moments(flat().polygon).area < 0) {
      face.sign = -1;
      std::reverse(face.node.begin(), face.node.begin() + face.n_nodes);
      std::reverse(face.is_arc.begin(), face.is_arc.begin() + face.n_nodes - 1);  // edge i lies between nodes i and i + 1
    }
    for (int i = 0; i < face.n_nodes; ++i) {
      if (!face.is_arc[RawSide::corner(i)]) continue;
      const RevolvedNode &a = side.node[face.node[RawSide::corner(i)]], &b = side.node[face.node[RawSide::corner((i + 1) % face.n_nodes)]];
      (radians(a.angle, b.angle) > 0 ? face.outer_rim : face.inner_rim) = a.r;
    }
    const FlatFace done = flat();
    require_sound(sent, face, side, done.polygon);
    face.area =
        face.is_disc ? disc_moments(done, {}).area : surface_.radii[static_cast<std::size_t>(face.part)] * moments(done.polygon).area;
    return face;
  }

  /// Of the straight edge from a to b in the plane of a disc.
  static double distance_to_axis(const RevolvedNode& a, const RevolvedNode& b) {
    const Point2 from = a.plane_position(), along = b.plane_position() - from;
    const double length_squared = dot(along, along);
    const double s = length_squared > 0 ? std::clamp(-dot(from, along) / length_squared, 0.0, 1.0) : 0;
    const Point2 nearest = from + s * along;
    return std::sqrt(dot(nearest, nearest));
  }

  void require_sound(const SentFace& sent, const RevolvedFace& face, const RevolvedSide& side, const Polygon& polygon) const {
    if (!is_convex(polygon)) fail(sent, "is not convex; a sliding interface needs triangles or convex quadrilaterals");
    for (int i = 0; i < face.n_nodes; ++i) {
      const RevolvedNode &a = side.node[face.node[RawSide::corner(i)]], &b = side.node[face.node[RawSide::corner((i + 1) % face.n_nodes)]];
      if ((!face.is_disc || face.is_arc[RawSide::corner(i)]) && std::abs(radians(a.angle, b.angle)) > 2 * std::numbers::pi / 3 + 1e-9)
        fail(sent, "is wider than a third of a turn; refine the interface");
      if (face.inner_rim > 0 && !face.is_arc[RawSide::corner(i)] && distance_to_axis(a, b) < face.inner_rim - tolerance_)
        fail(sent, "has an edge that cuts the circle of the inner rim (r " + number_text(face.inner_rim) + " m); refine the rim");
    }
  }

  RevolvedSurface surface_;
  std::array<RawSide, 2> raw_;
  double tolerance_ = 0;
  Levels radii_{{}, 0}, levels_{{}, 0};
};

/// Cells of the patches lie in their zones, and no face joins the zones: turning would tear it.
void require_separate(const Mesh& mesh, const SlidingDescription& description) {
  const auto zone = std::find(mesh.zones.begin(), mesh.zones.end(), description.rotor_zone);
  if (zone == mesh.zones.end())
    throw Error(ExitCode::mesh, "sliding interface: zone \"" + description.rotor_zone + "\" is not in the mesh; name the zone that turns");
  const int rotor = static_cast<int>(zone - mesh.zones.begin());
  const auto turns = [&](int cell) { return mesh.cell_zone[cell] == rotor; };
  for (int f = 0; f < mesh.n_interior; ++f)
    if (turns(mesh.owner[f]) != turns(mesh.neighbour[f]))
      throw Error(ExitCode::mesh, "sliding interface: the turning and the stationary zone share the face at " +
                                      point_text(mesh.face_centre[f]) + "; they must be meshed apart, with a patch on each side");
  for (const bool of_rotor : {true, false}) {
    const Patch& patch = mesh.patches[mesh.patch_index(of_rotor ? description.rotor_patch : description.stator_patch)];
    for (int f = patch.first; f < patch.end(); ++f)
      if (turns(mesh.owner[f]) != of_rotor)
        throw Error(ExitCode::mesh, "sliding interface: patch \"" + patch.name + "\" at " + point_text(mesh.face_centre[f]) +
                                        " belongs to zone \"" + mesh.zones[mesh.cell_zone[mesh.owner[f]]] + "\"; it must be the " +
                                        (of_rotor ? "turning" : "stationary") + " side");
  }
}

}  // namespace

Angle angle_of(double radians) {
  const double turns = radians / (2 * std::numbers::pi), fraction = (turns - std::floor(turns)) * 0x1p64;
  return fraction < 0x1p64 ? static_cast<Angle>(fraction) : 0;
}

AxisFrame::AxisFrame(const SlidingDescription& description) : origin(description.origin) {
  const Vec3 e3 = unit(description.axis);
  if (norm_squared(e3) == 0) throw Error(ExitCode::usage, "sliding interface: axis is zero; give the direction of the axis of rotation");
  const Vec3 size{std::abs(e3.x), std::abs(e3.y), std::abs(e3.z)};
  const Vec3 across = size.x <= size.y && size.x <= size.z ? Vec3{1, 0, 0} : size.y <= size.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 e1 = unit(across - dot(across, e3) * e3);
  axes = {e1, cross(e3, e1), e3};
}

Point2 RevolvedNode::plane_position(Angle turn) const {
  const double theta = radians(0, angle + turn);
  return {r * std::cos(theta), r * std::sin(theta)};
}

Vec3 RevolvedNode::position(Angle turn) const {
  const Point2 x = plane_position(turn);
  return {x.x, x.y, z};
}

const RevolvedNode* RevolvedSurface::node_of(std::int64_t id) const {
  for (const RevolvedSide* side : {&rotor, &stator}) {
    const auto at =
        std::lower_bound(side->node.begin(), side->node.end(), id, [](const RevolvedNode& n, std::int64_t i) { return n.id < i; });
    if (at != side->node.end() && at->id == id) return &*at;
  }
  return nullptr;
}

bool RevolvedSurface::is_curved(std::int64_t a, std::int64_t b) const {
  return std::binary_search(curved_edges.begin(), curved_edges.end(), edge_of(a, b));
}

Moments disc_moments(const FlatFace& face, Point2 centre) {
  Moments total = face.outer_rim > 0 ? moments_inside(face.polygon, centre, face.outer_rim) : moments(face.polygon);
  if (face.inner_rim > 0) {
    const Moments hole = moments_inside(face.polygon, centre, face.inner_rim);
    total.area -= hole.area;
    total.first = total.first - hole.first;
  }
  return total;
}

FlatFace flat_cylinder_face(const RevolvedSide& side, const RevolvedFace& face, Angle turn, Angle base) {
  FlatFace flat;
  for (int i = 0; i < face.n_nodes; ++i) {
    const RevolvedNode& node = side.node[static_cast<std::size_t>(face.node[static_cast<std::size_t>(i)])];
    flat.polygon.add({radians(base, node.angle + turn), node.z});
  }
  return flat;
}

FlatFace flat_disc_face(const RevolvedFace& face, const std::vector<Point2>& plane, Point2 base) {
  FlatFace flat;
  flat.outer_rim = face.outer_rim, flat.inner_rim = face.inner_rim;
  for (std::size_t i = 0, n = static_cast<std::size_t>(face.n_nodes); i < n; ++i) {
    const Point2 a = plane[static_cast<std::size_t>(face.node[i])], b = plane[static_cast<std::size_t>(face.node[(i + 1) % n])];
    flat.polygon.add(a - base);
    const Point2 chord = 0.5 * (a + b);
    if (face.is_arc[i] && face.outer_rim > 0 && cross(a, b) > 0)
      flat.polygon.add(face.outer_rim * face.outer_rim / dot(chord, chord) * chord - base);  // where the tangents at both ends meet
  }
  return flat;
}

RevolvedSurface revolved_surface(const Mesh& mesh, const SlidingDescription& description) {
  const AxisFrame frame(description);
  on_all_ranks(mesh.comm, [&] { require_separate(mesh, description); });
  return SurfaceBuilder(frame, faces_of(mesh, frame, description.rotor_patch), faces_of(mesh, frame, description.stator_patch)).build();
}

}  // namespace snag
