// Facets: for each rotor face the stator faces near it, from bins; their polygons are cut in a plane about the rotor face's first node, so
// that coordinates are small and both ranks of a facet compute the same.
#include "mesh/sliding/sliding_interface.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/sliding/sliding_bins.hpp"
#include "mesh/sliding/sliding_gap.hpp"
#include "mesh/sliding/sliding_geometry.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr double round_off_share = 1e-13;  // of the smaller face: a smaller piece is round-off

double reduced(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// One angle's facets.
class FacetCutter {
 public:
  FacetCutter(const RevolvedSurface& surface, SlidingBins& bins, int rank, Angle turn)
      : surface_(surface),
        bins_(bins),
        rank_(rank),
        turn_(turn),
        cover_{std::vector<double>(surface.rotor.face.size()), std::vector<double>(surface.stator.face.size())} {
    for (const RevolvedNode& node : surface.rotor.node) rotor_plane_.push_back(node.plane_position(turn));
  }

  std::vector<Facet> cut() {
    for (const RevolvedFace& rotor : surface_.rotor.face) cut(rotor);
    return std::move(facets_);
  }

  const FacetCover& cover() const { return cover_; }

 private:
  bool is_mine(const RevolvedFace& face) const { return face.rank == rank_; }

  void cut(const RevolvedFace& rotor) {
    const RevolvedNode& first = surface_.rotor.node[rotor.node[0]];
    const Angle base_angle = first.angle + turn_;
    const Point2 base = rotor_plane_[rotor.node[0]];
    const FlatFace flat =
        rotor.is_disc ? flat_disc_face(rotor, rotor_plane_, base) : flat_cylinder_face(surface_.rotor, rotor, turn_, base_angle);
    bins_.near(rotor, flat, base, base_angle, candidates_);
    const double theta = radians(0, base_angle);
    for (const int s : candidates_) {
      const RevolvedFace& stator = surface_.stator.face[static_cast<std::size_t>(s)];
      if ((!is_mine(rotor) && !is_mine(stator)) || stator.sign == rotor.sign) continue;
      FlatFace other =
          rotor.is_disc ? flat_disc_face(stator, bins_.plane(), base) : flat_cylinder_face(surface_.stator, stator, 0, base_angle);
      if (!boxes_meet(flat.polygon, other.polygon)) continue;
      const FlatFace common{intersection(flat.polygon, other.polygon), smaller_rim(flat.outer_rim, other.outer_rim),
                            std::max(flat.inner_rim, other.inner_rim)};
      if (common.polygon.n < 3) continue;
      PatchGeometry patch = rotor.is_disc ? disc_patch(common, base, first.z) : cylinder_patch(common.polygon, first.r);
      if (patch.area <= round_off_share * std::min(rotor.area, stator.area)) continue;
      if (!rotor.is_disc) patch.vector = turned(patch.vector, theta), patch.centre = turned(patch.centre, theta);
      add(rotor, stator, patch);
    }
  }

  void add(const RevolvedFace& rotor, const RevolvedFace& stator, const PatchGeometry& patch) {
    cover_.rotor[static_cast<std::size_t>(&rotor - surface_.rotor.face.data())] += patch.area;
    cover_.stator[static_cast<std::size_t>(&stator - surface_.stator.face.data())] += patch.area;
    const auto side = [&](const RevolvedFace& face) {
      return FacetSide{face.cell_id, face.rank, face.cell, face.face, patch.area / face.area};
    };
    facets_.push_back({side(rotor), side(stator), surface_.frame.vector_from(rotor.sign * patch.vector),
                       surface_.frame.point_from(patch.centre), patch.area});
  }

  static double smaller_rim(double a, double b) { return a == 0 ? b : b == 0 ? a : std::min(a, b); }

  static bool boxes_meet(const Polygon& a, const Polygon& b) {
    for (const double Point2::*axis : {&Point2::x, &Point2::y}) {
      const auto [low_a, high_a] = range(a, axis);
      const auto [low_b, high_b] = range(b, axis);
      if (low_a > high_b || low_b > high_a) return false;
    }
    return true;
  }
  static std::pair<double, double> range(const Polygon& polygon, const double Point2::*axis) {
    double low = polygon[0].*axis, high = low;
    for (int i = 1; i < polygon.n; ++i) low = std::min(low, polygon[i].*axis), high = std::max(high, polygon[i].*axis);
    return {low, high};
  }

  const RevolvedSurface& surface_;
  SlidingBins& bins_;
  int rank_;
  Angle turn_;
  std::vector<Point2> rotor_plane_;  // of the nodes, in the axis frame, at this angle
  FacetCover cover_;
  std::vector<int> candidates_;
  std::vector<Facet> facets_;
};

}  // namespace

SlidingInterface::SlidingInterface(const Mesh& mesh, const SlidingDescription& description)
    : description_(description),
      comm_(mesh.comm),
      surface_(std::make_unique<RevolvedSurface>(revolved_surface(mesh, description))),
      bins_(std::make_unique<SlidingBins>(*surface_)) {}
SlidingInterface::~SlidingInterface() = default;
SlidingInterface::SlidingInterface(SlidingInterface&&) noexcept = default;

std::vector<Facet> SlidingInterface::facets(double angle) const {
  const Angle turn = angle_of(reduced(angle));
  FacetCutter cutter(*surface_, *bins_, rank_of(comm_), turn);
  std::vector<Facet> result = cutter.cut();
  require_cover(*surface_, comm_, turn, cutter.cover(), description_.gap_picture);
  return result;
}

Mat3 SlidingInterface::rotation(double angle) const { return snag::rotation(unit(description_.axis), reduced(angle)); }

Vec3 SlidingInterface::turned_point(const Mat3& rotation, const Vec3& point) const {
  return description_.origin + rotation * (point - description_.origin);
}

void SlidingInterface::curve(Mesh& mesh) const { replace_geometry(curved_geometry(mesh, *surface_), mesh); }

std::vector<double> SlidingInterface::mesh_flux(const Mesh& mesh, double omega) const {
  const auto zone = std::find(mesh.zones.begin(), mesh.zones.end(), description_.rotor_zone);
  std::vector<double> flux = turning_flux(mesh, *surface_, static_cast<int>(zone - mesh.zones.begin()));
  for (double& value : flux) value *= omega;
  return flux;
}

}  // namespace snag
