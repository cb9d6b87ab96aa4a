#include "mesh/generate/pump_solids.hpp"

#include <gmsh.h>

#include <array>
#include <cmath>

#include "base/error.hpp"
#include "mesh/generate/cad.hpp"

namespace snag::generate {

namespace {

namespace occ = gmsh::model::occ;

int point(const Vec3& p) { return occ::addPoint(p.x, p.y, p.z); }

Vec3 at_height(const Vec3& p, double z) { return {p.x, p.y, z}; }

std::vector<int> points(const std::vector<Vec3>& list, double z) {
  std::vector<int> result;
  for (const Vec3& p : list) result.push_back(point(at_height(p, z)));
  return result;
}

std::vector<int> extruded(int face, const Vec3& way) {
  DimTags all;
  occ::extrude({{2, face}}, way.x, way.y, way.z, all);
  std::vector<int> volumes;
  for (const auto& [dimension, tag] : all)
    if (dimension == 3) volumes.push_back(tag);
  return volumes;
}

int first_vane(const PumpDimensions& pump) {
  const VanePlan plan = vane_plan(pump);
  const auto front = points(plan.front, 0), back = points(plan.back, 0);
  // Half a circle in one arc would be ambiguous: each nose is two arcs that meet at its tip.
  const auto nose = [](int from, const Vec3& tip, const Vec3& centre, int to) {
    const int middle = point(tip), c = point(centre);
    return std::array{occ::addCircleArc(from, c, middle), occ::addCircleArc(middle, c, to)};
  };
  const int front_side = occ::addSpline(front), back_side = occ::addSpline(back);
  const auto trailing = nose(front.back(), plan.trailing_tip, plan.trailing_centre, back.back());
  const auto leading = nose(back.front(), plan.leading_tip, plan.leading_centre, front.front());
  const int outline = occ::addWire({front_side, trailing[0], trailing[1], back_side, leading[0], leading[1]});
  return extruded(occ::addPlaneSurface({outline}), {0, 0, pump.impeller_width}).at(0);
}

std::vector<int> vanes(const PumpDimensions& pump) {
  std::vector<int> all{first_vane(pump)};
  for (int k = 1; k < pump.vanes; ++k) {
    DimTags copy;
    occ::copy({{3, all.front()}}, copy);
    occ::rotate(copy, 0, 0, 0, 0, 0, 1, k * pump.pitch());
    all.push_back(copy.at(0).second);
  }
  return all;
}

std::vector<int> spiral_prism(const PumpDimensions& pump, const VolutePlan& plan) {
  const double z = -pump.side_gap;
  const auto spiral = points(plan.spiral, z);
  const int outer = point({plan.spiral.back().x, plan.outlet_start, z}), inner = point({plan.nose_side.x, plan.outlet_start, z});
  const int side = point(at_height(plan.nose_side, z)), bottom = point(at_height(plan.nose_bottom, z));
  const int centre = point(at_height(plan.nose_centre, z));
  const int outline =
      occ::addWire({occ::addSpline(spiral), occ::addLine(spiral.back(), outer), occ::addLine(outer, inner), occ::addLine(inner, side),
                    occ::addCircleArc(side, centre, bottom), occ::addCircleArc(bottom, centre, spiral.front())});
  return extruded(occ::addPlaneSurface({outline}), {0, 0, pump.casing_width()});
}

// A closed wire of four curves through four corners; arcs about `centre` where it is given.
int four_curves(const std::array<int, 4>& corner, int centre = 0) {
  std::vector<int> curves;
  for (std::size_t k = 0; k < 4; ++k) {
    const int from = corner[k], to = corner[(k + 1) % 4];
    curves.push_back(centre ? occ::addCircleArc(from, centre, to) : occ::addLine(from, to));
  }
  return occ::addWire(curves);
}

// From the rectangle to the circle. Both wires have four curves that start at the same corner and run in the same sense,
// the circle's ends at the angles of the rectangle's corners: otherwise the loft twists.
int outlet_loft(const PumpDimensions& pump, const VolutePlan& plan) {
  const double half_width = plan.throat / 2, half_height = pump.casing_width() / 2, radius = pump.outlet_diameter / 2;
  const double x = plan.nose_side.x + half_width, z = pump.impeller_width / 2;
  const double diagonal = std::hypot(half_width, half_height), y = plan.outlet_start, y_end = y + pump.outlet_loft_length;
  std::array<int, 4> rectangle{}, circle{};
  constexpr std::array<std::array<int, 2>, 4> sign{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const double dx = sign[k][0] * half_width, dz = sign[k][1] * half_height;
    rectangle[k] = point({x + dx, y, z + dz});
    circle[k] = point({x + radius * dx / diagonal, y_end, z + radius * dz / diagonal});
  }
  DimTags loft;
  occ::addThruSections({four_curves(rectangle), four_curves(circle, point({x, y_end, z}))}, loft, -1, true, true);
  return loft.at(0).second;
}

}  // namespace

std::vector<int> rotor_solid(const PumpDimensions& pump) {
  const double b2 = pump.impeller_width;
  const int disc = cylinder({0, 0, 0}, {0, 0, b2}, pump.sliding_radius());
  // The eye turns with the impeller: the leading edges, which reach into it, stay off the interface.
  const int eye = cylinder({0, 0, b2}, {0, 0, pump.eye_length}, pump.inlet_diameter / 2);
  auto rotor = cut(fused({disc, eye}), vanes(pump));
  occ::rotate(with_dimension(3, rotor), 0, 0, 0, 0, 0, 1, pump.rotor_angle);
  return rotor;
}

std::vector<int> casing_solid(const PumpDimensions& pump) {
  const VolutePlan plan = volute_plan(pump);
  std::vector<int> parts = spiral_prism(pump, plan);
  const int loft = outlet_loft(pump, plan);
  parts.push_back(loft);
  occ::synchronize();
  // The pipe grows from the loft's own end face: their vertices are the same.
  for (const Face& face : faces_of({loft})) {
    if (!face.lies_at(1, plan.outlet_start + pump.outlet_loft_length)) continue;
    for (const int pipe : extruded(face.tag, {0, pump.outlet_length.value_or(8 * pump.outlet_diameter), 0})) parts.push_back(pipe);
  }
  const auto water = fused(parts);
  // Three cylinders, and only after the fusion, which would merge their walls: the middle one's wall becomes the interface.
  const double b2 = pump.impeller_width, gap = pump.side_gap, radius = pump.sliding_radius();
  std::vector<int> tools{cylinder({0, 0, 0}, {0, 0, b2}, radius)};
  if (gap > 0) {
    tools.push_back(cylinder({0, 0, -gap}, {0, 0, gap}, radius));
    tools.push_back(cylinder({0, 0, b2}, {0, 0, gap}, radius));
  }
  return cut(water, tools);
}

std::vector<int> inlet_pipe_solid(const PumpDimensions& pump, double length) {
  return {cylinder({0, 0, pump.eye_height()}, {0, 0, length}, pump.inlet_diameter / 2)};
}

}  // namespace snag::generate
