#include "mesh/sliding/sliding_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/vtk_file.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {
namespace {

constexpr double coverage_tolerance = 1e-9;  // of a face's area: meshes that touch tile to 1e-13
constexpr double degree = std::numbers::pi / 180;

/// The open faces of one side, all ranks', at the angle of the error.
struct OpenSide {
  const char* name;
  const RevolvedSide& side;
  Angle turn;
  std::vector<double> share;  // covered, of all faces
  std::vector<std::size_t> face;

  std::span<const int> nodes_of(std::size_t f) const {
    return std::span(side.face[f].node).first(static_cast<std::size_t>(side.face[f].n_nodes));
  }
  double gap(std::size_t f) const { return std::abs(1 - share[f]); }
};

/// Of arcs about the axis (start in [-pi, pi] and length, rad): what is left of the turn when the widest arc without any is taken out.
std::string extent(std::vector<std::pair<double, double>> arcs, const Vec3& zero) {
  std::sort(arcs.begin(), arcs.end());
  constexpr double turn = 2 * std::numbers::pi;
  double reached = -turn, widest = 0, begin = 0;
  for (const auto& [start, length] : arcs) reached = std::max(reached, start + length - turn);
  for (const auto& [start, length] : arcs) {
    if (start - reached > widest) widest = start - reached, begin = start;
    reached = std::max(reached, start + length);
  }
  if (widest < 1e-6) return "all round the axis";
  return number_text(std::round(begin / degree)) + " deg to " + number_text(std::round((begin + turn - widest) / degree)) +
         " deg about the axis from (" + number_text(zero.x) + ", " + number_text(zero.y) + ", " + number_text(zero.z) + ")";
}

std::string extent(double lowest, double highest) {
  return highest - lowest < 1e-6 * std::abs(highest) ? number_text(highest) + " m"
                                                     : number_text(lowest) + " m to " + number_text(highest) + " m";
}

/// How many faces of a side are open, and where.
std::string told(const OpenSide& open, const AxisFrame& frame) {
  constexpr double huge = std::numeric_limits<double>::max();
  std::array<double, 2> radius{huge, -huge}, height{huge, -huge};
  std::vector<std::pair<double, double>> arcs;
  const auto include = [](std::array<double, 2>& range, double x) { range = {std::min(range[0], x), std::max(range[1], x)}; };
  for (const std::size_t f : open.face) {
    const Angle first = open.side.node[open.nodes_of(f)[0]].angle;
    std::array<double, 2> arc{0, 0};
    for (const int n : open.nodes_of(f)) {
      const RevolvedNode& node = open.side.node[n];
      include(radius, node.r), include(height, node.z), include(arc, radians(first, node.angle));
    }
    arcs.emplace_back(std::remainder(radians(0, first + open.turn) + arc[0], 2 * std::numbers::pi), arc[1] - arc[0]);
  }
  return std::to_string(open.face.size()) + " face" + (open.face.size() == 1 ? "" : "s") + " of the " + open.name + " side (" +
         extent(arcs, frame.axes[0]) + ", radius " + extent(radius[0], radius[1]) + ", " + extent(height[0], height[1]) +
         " along the axis)";
}

/// The open face that is covered worst, the first of both sides; empty without an open face.
std::string worst_of(const std::vector<OpenSide>& sides, const AxisFrame& frame) {
  const OpenSide* side = nullptr;
  std::size_t worst = 0;
  for (const OpenSide& open : sides)
    for (const std::size_t f : open.face)
      if (!side || open.gap(f) > side->gap(worst)) side = &open, worst = f;
  if (!side) return {};
  const RevolvedFace& face = side->side.face[worst];
  Vec3 middle;
  for (const int n : side->nodes_of(worst)) middle += side->side.node[n].position(side->turn) / face.n_nodes;
  return std::string("the face of the ") + side->name + " side at " + point_text(frame.point_from(middle)) + " (" + number_text(face.area) +
         " m2, cell " + std::to_string(face.cell_id) + ") is covered by the other side to " + number_text(100 * side->share[worst]) + " %";
}

void draw(const std::vector<OpenSide>& sides, const AxisFrame& frame, const std::filesystem::path& file) {
  VtkPiece piece;
  std::vector<double> covered, turning, cell;
  for (const OpenSide& open : sides)
    for (const std::size_t f : open.face) {
      for (const int n : open.nodes_of(f)) {
        piece.connectivity.push_back(static_cast<std::int64_t>(piece.points.size()));
        piece.points.push_back(frame.point_from(open.side.node[n].position(open.turn)));
      }
      piece.offsets.push_back(static_cast<std::int64_t>(piece.points.size()));
      covered.push_back(open.share[f]);
      turning.push_back(&open == &sides.front() ? 1 : 0);
      cell.push_back(static_cast<double>(open.side.face[f].cell_id));
    }
  piece.cell_arrays = {vtk_array("covered [1]", covered), vtk_array("turning [1]", turning), vtk_array("cell [1]", cell, false)};
  write_vtk(file, VtkKind::polygons, piece);
}

/// What the message says of the picture, which rank 0 draws. Collective.
std::string drawn(const std::vector<OpenSide>& sides, const AxisFrame& frame, MPI_Comm comm, const std::filesystem::path& picture) {
  if (picture.empty()) return "";
  int done = 1;
  if (rank_of(comm) == 0) {
    try {
      draw(sides, frame, picture);
    } catch (const Error&) {
      done = 0;
    }
  }
  MPI_Bcast(&done, 1, MPI_INT, 0, comm);
  return done ? "; they are drawn in " + picture.string() : "; they could not be drawn: " + picture.string() + " cannot be written";
}

}  // namespace

void require_cover(const RevolvedSurface& surface, MPI_Comm comm, Angle turn, const FacetCover& cover,
                   const std::filesystem::path& picture) {
  const int rank = rank_of(comm);
  std::vector<OpenSide> sides{{"turning", surface.rotor, turn, cover.rotor, {}}, {"stationary", surface.stator, 0, cover.stator, {}}};
  std::int64_t n_open = 0;
  for (OpenSide& open : sides)
    for (std::size_t f = 0; f < open.share.size(); ++f) {
      const RevolvedFace& face = open.side.face[f];
      open.share[f] = face.rank == rank ? open.share[f] / face.area : 0;
      n_open += face.rank == rank && open.gap(f) > coverage_tolerance;
    }
  if (sum(comm, n_open) == 0) return;
  std::string list;
  for (OpenSide& open : sides) {
    MPI_Allreduce(MPI_IN_PLACE, open.share.data(), static_cast<int>(open.share.size()), MPI_DOUBLE, MPI_SUM, comm);
    for (std::size_t f = 0; f < open.share.size(); ++f)
      if (open.gap(f) > coverage_tolerance) open.face.push_back(f);
    if (!open.face.empty()) list += (list.empty() ? "" : " and ") + told(open, surface.frame);
  }
  throw Error(ExitCode::mesh, "sliding interface: " + worst_of(sides, surface.frame) + "; open are " + list +
                                  drawn(sides, surface.frame, comm, picture) +
                                  "; both sides must be the same surface of revolution and touch everywhere: compare radius, ends and axis "
                                  "of the two patches there");
}

}  // namespace snag
