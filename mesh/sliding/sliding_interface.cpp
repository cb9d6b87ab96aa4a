// Facets: for each rotor face the stator faces near it, from bins; their polygons are cut in a plane about the rotor face's first node, so
// that coordinates are small and both ranks of a facet compute the same.
#include "mesh/sliding/sliding_interface.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <type_traits>

#include "mesh/sliding/sliding_bins.hpp"
#include "mesh/sliding/sliding_gap.hpp"
#include "mesh/sliding/sliding_geometry.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr double round_off_share = 1e-13;  // of the smaller face: a smaller piece is round-off

double reduced(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// A facet as it goes from the rank that cuts it to those that own its cells.
struct CutFacet {
  int rotor, stator;    // faces of the surface
  double area;          // m2
  Vec3 vector, centre;  // m2, m
};
static_assert(std::is_trivially_copyable_v<CutFacet>);

/// One angle's facets.
class FacetCutter {
 public:
  FacetCutter(const RevolvedSurface& surface, SlidingBins& bins, Angle turn) : surface_(surface), bins_(bins), turn_(turn) {
    for (const RevolvedNode& node : surface.rotor.node) rotor_plane_.push_back(node.plane_position(turn));
  }

  /// Those of the rotor's faces first .. last - 1, in this order.
  std::vector<CutFacet> cut(int first, int last) {
    for (int r = first; r < last; ++r) cut(r);
    return std::move(facets_);
  }

 private:
  void cut(int r) {
    const RevolvedFace& rotor = surface_.rotor.face[static_cast<std::size_t>(r)];
    const RevolvedNode& first = surface_.rotor.node[rotor.node[0]];
    const Angle base_angle = first.angle + turn_;
    const Point2 base = rotor_plane_[rotor.node[0]];
    const FlatFace flat =
        rotor.is_disc ? flat_disc_face(rotor, rotor_plane_, base) : flat_cylinder_face(surface_.rotor, rotor, turn_, base_angle);
    bins_.near(rotor, flat, base, base_angle, candidates_);
    const double theta = radians(0, base_angle);
    for (const int s : candidates_) {
      const RevolvedFace& stator = surface_.stator.face[static_cast<std::size_t>(s)];
      if (stator.sign == rotor.sign) continue;
      FlatFace other =
          rotor.is_disc ? flat_disc_face(stator, bins_.plane(), base) : flat_cylinder_face(surface_.stator, stator, 0, base_angle);
      if (!boxes_meet(flat.polygon, other.polygon)) continue;
      const FlatFace common{intersection(flat.polygon, other.polygon), smaller_rim(flat.outer_rim, other.outer_rim),
                            std::max(flat.inner_rim, other.inner_rim)};
      if (common.polygon.n < 3) continue;
      PatchGeometry patch = rotor.is_disc ? disc_patch(common, base, first.z) : cylinder_patch(common.polygon, first.r);
      if (patch.area <= round_off_share * std::min(rotor.area, stator.area)) continue;
      if (!rotor.is_disc) patch.vector = turned(patch.vector, theta), patch.centre = turned(patch.centre, theta);
      facets_.push_back({r, s, patch.area, surface_.frame.vector_from(rotor.sign * patch.vector), surface_.frame.point_from(patch.centre)});
    }
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
  Angle turn_;
  std::vector<Point2> rotor_plane_;  // of the nodes, in the axis frame, at this angle
  std::vector<int> candidates_;
  std::vector<CutFacet> facets_;
};

/// To the ranks that own a side of each: all ranks cut facets, equally many, whoever owns the interface. Their order stays that of the
/// rotor's faces, as those are dealt out in the order of the ranks. Collective.
std::vector<CutFacet> sent_to_owners(MPI_Comm comm, const RevolvedSurface& surface, const std::vector<CutFacet>& facets) {
  const auto owners = [&surface](const CutFacet& facet) {
    return std::pair(surface.rotor.face[static_cast<std::size_t>(facet.rotor)].rank,
                     surface.stator.face[static_cast<std::size_t>(facet.stator)].rank);
  };
  RowsByRank<CutFacet> sent;
  sent.counts.assign(static_cast<std::size_t>(size_of(comm)), 0);
  for (const CutFacet& facet : facets) {
    const auto [first, second] = owners(facet);
    ++sent.counts[static_cast<std::size_t>(first)];
    if (second != first) ++sent.counts[static_cast<std::size_t>(second)];
  }
  std::vector<std::size_t> next(sent.counts.size(), 0);
  std::partial_sum(sent.counts.begin(), sent.counts.end() - 1, next.begin() + 1);
  sent.rows.resize(next.back() + static_cast<std::size_t>(sent.counts.back()));
  for (const CutFacet& facet : facets) {
    const auto [first, second] = owners(facet);
    sent.rows[next[static_cast<std::size_t>(first)]++] = facet;
    if (second != first) sent.rows[next[static_cast<std::size_t>(second)]++] = facet;
  }
  return exchanged(comm, sent).rows;
}

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
  const std::vector<RevolvedFace>&rotor = surface_->rotor.face, &stator = surface_->stator.face;
  const std::int64_t n = std::ssize(rotor), rank = rank_of(comm_), size = size_of(comm_);
  FacetCutter cutter(*surface_, *bins_, turn);
  std::vector<CutFacet> mine = cutter.cut(static_cast<int>(n * rank / size), static_cast<int>(n * (rank + 1) / size));
  if (size > 1) mine = sent_to_owners(comm_, *surface_, mine);
  FacetCover cover{std::vector<double>(rotor.size()), std::vector<double>(stator.size())};
  std::vector<Facet> facets;
  for (const CutFacet& facet : mine) {
    const auto r = static_cast<std::size_t>(facet.rotor), s = static_cast<std::size_t>(facet.stator);
    cover.rotor[r] += facet.area, cover.stator[s] += facet.area;
    const auto side = [&facet](const RevolvedFace& face) {
      return FacetSide{face.cell_id, face.rank, face.cell, face.face, facet.area / face.area};
    };
    facets.push_back({side(rotor[r]), side(stator[s]), facet.vector, facet.centre, facet.area});
  }
  require_cover(*surface_, comm_, turn, cover, description_.gap_picture);
  return facets;
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
