// Suction from a tank, as in a wet pit: a plate in place of the pit's floor stands before the pump's opening. Only the water before
// the pump's cover is modelled; it enters through the surface. The mouth is a quarter-round bell of radius bell_radius on the pipe.
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>

#include <numbers>

#include "base/error.hpp"
#include "mesh/generate/cad.hpp"
#include "mesh/generate/pump_solids.hpp"

namespace snag::generate {

namespace {

namespace occ = gmsh::model::occ;

// Solid of revolution under the quarter round, from z_mouth - R (pipe's radius) to z_mouth (pipe's radius + R).
int bell(double pipe_radius, double R, double z_mouth) {
  const int start = occ::addPoint(pipe_radius, 0, z_mouth - R), end = occ::addPoint(pipe_radius + R, 0, z_mouth);
  const int centre = occ::addPoint(pipe_radius + R, 0, z_mouth - R);
  const int axis_low = occ::addPoint(0, 0, z_mouth - R), axis_high = occ::addPoint(0, 0, z_mouth);
  const int outline = occ::addWire({occ::addLine(axis_low, start), occ::addCircleArc(start, centre, end), occ::addLine(end, axis_high),
                                    occ::addLine(axis_high, axis_low)});
  DimTags solid;
  occ::revolve({{2, occ::addPlaneSurface({outline})}}, 0, 0, 0, 0, 0, 1, 2 * std::numbers::pi, solid);
  for (const auto& [dimension, tag] : solid)
    if (dimension == 3) return tag;
  throw Error(ExitCode::mesh, "[pump]: the bell of the inlet could not be revolved; set bell_radius to 0");
}

void check(const PumpDimensions& pump, const SuctionTank& tank, double z_mouth) {
  const auto require = [](bool rule, const std::string& message) {
    if (!rule) throw Error(ExitCode::usage, "[pump]: " + message);
  };
  const double cover = tank.cover(pump), plate = tank.plate(pump),
               mouth_radius = pump.inlet_diameter / 2 + tank.bell_radius + tank.lip_thickness;
  require(z_mouth > cover - 1e-9,
          fmt::format("inlet_length reaches z = {:g} m, must reach the cover at {:g} m; enlarge it", z_mouth, cover));
  require(z_mouth - tank.bell_radius > pump.eye_height(),
          fmt::format("bell_radius ({:g} m), must be shorter than the inlet pipe; enlarge inlet_length", tank.bell_radius));
  require(plate > z_mouth + 0.005,
          fmt::format("plate_distance ({:g} m), must leave 5 mm between mouth and plate; enlarge it", tank.plate_distance));
  require(cover + tank.length > plate + tank.plate_thickness,
          fmt::format("tank_length ({:g} m), must reach beyond the plate; enlarge it", tank.length));
  require(tank.axis_height > mouth_radius && tank.depth - tank.axis_height > mouth_radius && tank.width > 2 * mouth_radius,
          fmt::format("tank_axis_height ({:g} m), must keep the mouth of radius {:g} m within the tank; change it", tank.axis_height,
                      mouth_radius));
  const double half = tank.plate_width / 2;
  require(half < tank.axis_height && half < tank.depth - tank.axis_height && half < tank.width / 2,
          fmt::format("plate_width ({:g} m), must leave room between plate and tank; reduce it", tank.plate_width));
}

}  // namespace

std::vector<Parameter> SuctionTank::parameters() {
  using enum Basis;
  return {
      {"tank_length", &length, "m", 0.05, 20, assumed, "Length of the tank before the pump's cover."},
      {"tank_width", &width, "m", 0.05, 20, measured, "Width of the tank."},
      {"tank_depth", &depth, "m", 0.05, 20, measured, "Depth of the tank, from floor to water surface (+y)."},
      {"tank_axis_height", &axis_height, "m", 0.02, 20, assumed, "Height of the pump's axis above the tank's floor."},
      {"plate_distance", &plate_distance, "m", 0.005, 5, measured, "Distance from the eye to the plate, which models the floor of a pit."},
      {"plate_width", &plate_width, "m", 0.02, 20, assumed, "Side of the square plate."},
      {"plate_thickness", &plate_thickness, "m", 0.001, 1, assumed, "Thickness of the plate."},
      {"cover_thickness", &cover_thickness, "m", 0.001, 1, assumed,
       "Thickness of the casing's cover, whose outside is a wall of the tank."},
      {"bell_radius", &bell_radius, "m", 0, 1, assumed, "Rounding of the inlet's mouth; 0: sharp."},
      {"lip_thickness", &lip_thickness, "m", 0.001, 1, assumed, "Wall of a mouth that protrudes into the tank."},
  };
}

std::vector<int> tank_solid(const PumpDimensions& pump, const SuctionTank& tank, double inlet_length) {
  const double z_eye = pump.eye_height(), z_mouth = z_eye + inlet_length, cover = tank.cover(pump), radius = pump.inlet_diameter / 2;
  check(pump, tank, z_mouth);
  const int box = occ::addBox(-tank.width / 2, -tank.axis_height, cover, tank.width, tank.depth, tank.length);
  std::vector<int> obstacles{occ::addBox(-tank.plate_width / 2, -tank.plate_width / 2, tank.plate(pump), tank.plate_width, tank.plate_width,
                                         tank.plate_thickness)};
  if (z_mouth > cover + 1e-6)
    obstacles.push_back(cylinder({0, 0, cover}, {0, 0, z_mouth - cover}, radius + tank.bell_radius + tank.lip_thickness));
  std::vector<int> parts = cut({box}, obstacles);
  parts.push_back(cylinder({0, 0, z_eye}, {0, 0, inlet_length}, radius));
  if (tank.bell_radius > 0) parts.push_back(bell(radius, tank.bell_radius, z_mouth));
  return fused(parts);
}

}  // namespace snag::generate
