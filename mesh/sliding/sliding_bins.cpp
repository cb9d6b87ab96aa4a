#include "mesh/sliding/sliding_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace snag {

template <class Act>
void SlidingBins::Part::for_each_bin(const Box& box, const Act& act) const {
  if (n_x == 0) return;
  const auto bin = [](double x, double from, double step) { return static_cast<int>(std::floor((x - from) / step)); };
  // a hair's breadth more, because round-off must not part two faces that touch
  const double hair_x = 1e-6 * width.x, hair_y = 1e-6 * width.y;
  int first_x = bin(box.lower.x - hair_x, lower.x, width.x), last_x = bin(box.upper.x + hair_x, lower.x, width.x);
  if (wraps)
    last_x = std::min(last_x, first_x + n_x - 1);
  else
    first_x = std::clamp(first_x, 0, n_x - 1), last_x = std::clamp(last_x, 0, n_x - 1);
  const int first_y = std::clamp(bin(box.lower.y - hair_y, lower.y, width.y), 0, n_y - 1);
  const int last_y = std::clamp(bin(box.upper.y + hair_y, lower.y, width.y), 0, n_y - 1);
  for (int y = first_y; y <= last_y; ++y)
    for (int x = first_x; x <= last_x; ++x) act(static_cast<std::size_t>(y * n_x + (x % n_x + n_x) % n_x));
}

SlidingBins::Box SlidingBins::box_of(const RevolvedFace& face, const FlatFace& flat, Point2 base, Angle base_angle) {
  Box box{flat.polygon[0], flat.polygon[0]};
  for (int i = 1; i < flat.polygon.n; ++i) {
    const Point2 x = flat.polygon[i];
    box.lower = {std::min(box.lower.x, x.x), std::min(box.lower.y, x.y)};
    box.upper = {std::max(box.upper.x, x.x), std::max(box.upper.y, x.y)};
  }
  const Point2 origin = face.is_disc ? base : Point2{radians(0, base_angle), 0};
  return {box.lower + origin, box.upper + origin};
}

/// About one face a bin.
void SlidingBins::size_bins(const std::vector<RevolvedFace>& faces, const std::vector<Box>& boxes) {
  constexpr double far = std::numeric_limits<double>::max();
  for (const bool is_disc : {false, true}) {
    auto& parts = is_disc ? discs_ : cylinders_;
    std::vector<Box> extent(parts.size(), {{far, far}, {-far, -far}});
    std::vector<int> count(parts.size(), 0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (faces[f].is_disc != is_disc) continue;
      Box& e = extent[static_cast<std::size_t>(faces[f].part)];
      e.lower = {std::min(e.lower.x, boxes[f].lower.x), std::min(e.lower.y, boxes[f].lower.y)};
      e.upper = {std::max(e.upper.x, boxes[f].upper.x), std::max(e.upper.y, boxes[f].upper.y)};
      ++count[static_cast<std::size_t>(faces[f].part)];
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (count[p] == 0) continue;
      Part& part = parts[p];
      part.wraps = !is_disc;
      if (part.wraps) extent[p].lower.x = 0, extent[p].upper.x = 2 * std::numbers::pi;
      const Point2 size = extent[p].upper - extent[p].lower;
      const double unit_x = is_disc ? 1 : radii_[p];
      part.n_x = std::clamp(static_cast<int>(std::sqrt(count[p] * unit_x * size.x / size.y)), 1, 4096);
      part.n_y = std::clamp(count[p] / part.n_x, 1, 4096);
      part.lower = extent[p].lower, part.width = {size.x / part.n_x, size.y / part.n_y};
      part.start.assign(static_cast<std::size_t>(part.n_x * part.n_y) + 1, 0);
    }
  }
}

SlidingBins::SlidingBins(const RevolvedSurface& surface)
    : cylinders_(surface.radii.size()), discs_(surface.levels.size()), radii_(surface.radii) {
  const RevolvedSide& side = surface.stator;
  for (const RevolvedNode& node : side.node) plane_.push_back(node.plane_position());
  last_search_.resize(side.face.size());
  for (const RevolvedFace& face : side.face) {
    const int first = face.node[0];
    const FlatFace flat =
        face.is_disc ? flat_disc_face(face, plane_, plane_[first]) : flat_cylinder_face(side, face, 0, side.node[first].angle);
    box_.push_back(box_of(face, flat, plane_[first], side.node[first].angle));
  }
  size_bins(side.face, box_);
  for (std::size_t f = 0; f < box_.size(); ++f) {
    Part& part = part_of(side.face[f]);
    part.for_each_bin(box_[f], [&](std::size_t bin) { ++part.start[bin + 1]; });
  }
  for (auto* parts : {&cylinders_, &discs_})
    for (Part& part : *parts) {
      for (std::size_t bin = 1; bin < part.start.size(); ++bin) part.start[bin] += part.start[bin - 1];
      part.face.resize(part.start.empty() ? 0 : static_cast<std::size_t>(part.start.back()));
      part.next = part.start;
    }
  for (std::size_t f = 0; f < box_.size(); ++f) {
    Part& part = part_of(side.face[f]);
    part.for_each_bin(box_[f], [&](std::size_t bin) { part.face[part.next[bin]++] = static_cast<int>(f); });
  }
}

void SlidingBins::near(const RevolvedFace& face, const FlatFace& flat, Point2 base, Angle base_angle, std::vector<int>& candidates) {
  candidates.clear();
  ++search_;
  const Part& part = part_of(face);
  const Box box = box_of(face, flat, base, base_angle);
  const Point2 hair = 1e-6 * part.width;
  part.for_each_bin(box, [&](std::size_t bin) {
    for (int k = part.start[bin]; k < part.start[bin + 1]; ++k) {
      const int other = part.face[k];
      if (std::exchange(last_search_[other], search_) == search_) continue;
      const Box& there = box_[other];
      // Twice the way between the middles, and the room that both boxes take of it.
      Point2 way = (there.lower + there.upper) - (box.lower + box.upper);
      const Point2 room = (there.upper - there.lower) + (box.upper - box.lower) + 2 * hair;
      if (part.wraps && std::abs(way.x) > 2 * std::numbers::pi) way.x -= std::copysign(4 * std::numbers::pi, way.x);
      if (std::abs(way.x) <= room.x && std::abs(way.y) <= room.y) candidates.push_back(other);
    }
  });
  std::sort(candidates.begin(), candidates.end());
}

}  // namespace snag
