#include "solver/pump_monitor.hpp"

#include <cmath>
#include <numbers>
#include <tuple>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/rotating_zone.hpp"
#include "solver/monitors.hpp"

namespace snag {

namespace {

int patch_of(const Mesh& mesh, const std::string& key, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].name == name) return static_cast<int>(p);
    names.push_back(mesh.patches[p].name);
  }
  const auto near = nearest_name(name, names);
  throw Error(ExitCode::usage, "[pump] " + key + ": the mesh has no patch \"" + name + "\"; it has: " + joined(names) +
                                   (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

double area_of(const Flow& flow, int patch, const std::optional<double>& diameter) {
  return diameter ? std::numbers::pi / 4 * *diameter * *diameter : patch_area(flow, patch);
}

}  // namespace

Section PumpSettings::section() {
  return {"pump",
          "Patches of the pump, for head, torque, power and efficiency in every step and as means over each revolution. It needs "
          "[rotating_zone].",
          {setting("inlet", &inlet, "Patch of the inlet flange."),
           setting("outlet", &outlet, "Patch of the outlet flange."),
           setting("walls", &walls, "Patches of the impeller: the torque of the water on them is that of the shaft."),
           {"inlet_diameter", &inlet_diameter, "m", 1e-6, 1e6, Basis::assumed,
            "Diameter of the pipe where the inlet pressure is measured, for the velocity head; by default from the area of the patch."},
           {"outlet_diameter", &outlet_diameter, "m", 1e-6, 1e6, Basis::assumed,
            "Diameter of the pipe where the outlet pressure is measured, for the velocity head; by default from the area of the patch."},
           {"gravity", &gravity, "m/s2", 1e-6, 30, Basis::literature,
            "Gravity for the conversion of pressure to head; no force follows from it."}}};
}
const bool pump_table = add_case_table<PumpSettings>(100);

std::vector<std::string> pump_warnings(const Flow& flow, const PumpSettings& settings) {
  constexpr double alike = 1.25;  // of diameters
  const Mesh& mesh = flow.mesh;
  std::vector<std::string> warnings;
  for (const auto& [key, name, diameter] :
       {std::tuple{"inlet", settings.inlet, settings.inlet_diameter}, std::tuple{"outlet", settings.outlet, settings.outlet_diameter}}) {
    if (!diameter) continue;
    const double of_patch = std::sqrt(4 / std::numbers::pi * patch_area(flow, patch_of(mesh, key, name)));
    if (std::max(*diameter / of_patch, of_patch / *diameter) > alike)
      warnings.push_back(std::string("[pump] ") + key + "_diameter is " + number_text(1e3 * *diameter) + " mm, patch \"" + name +
                         "\" has the area of a circle of " + number_text(std::round(1e4 * of_patch) / 10) +
                         " mm: the velocity head is that of the given diameter; check it, or leave it out");
  }
  if (settings.walls.empty())
    warnings.emplace_back("[pump] walls is empty: torque, power and efficiency are 0; name the walls of the impeller");
  if (!flow.rotating_zone) return warnings;
  for (const std::string& name : settings.walls) {
    const Patch& patch = mesh.patches[static_cast<std::size_t>(patch_of(mesh, "walls", name))];
    std::int64_t standing = 0;
    for (int f = patch.first; f < patch.end(); ++f) standing += mesh.cell_zone[mesh.owner[f]] != flow.rotating_zone->zone();
    if ((standing = sum(mesh.comm, standing)) > 0)
      warnings.push_back("[pump] walls: \"" + name + "\" has " + counted(standing, "face") +
                         " outside the rotating zone: the torque on them counts as torque of the shaft; leave out walls that stand");
  }
  return warnings;
}

PumpMonitor::PumpMonitor(const Flow& flow, const PumpSettings& settings)
    : inlet_(patch_of(flow.mesh, "inlet", settings.inlet)),
      outlet_(patch_of(flow.mesh, "outlet", settings.outlet)),
      inlet_area_(area_of(flow, inlet_, settings.inlet_diameter)),
      outlet_area_(area_of(flow, outlet_, settings.outlet_diameter)),
      gravity_(settings.gravity) {
  if (inlet_ == outlet_)
    throw Error(ExitCode::usage, "[pump]: inlet and outlet are both \"" + settings.inlet + "\", must be two patches; correct one of them");
  for (const std::string& name : settings.walls) walls_.push_back(patch_of(flow.mesh, "walls", name));
}

PumpReading PumpMonitor::read(const Flow& flow, const Shaft& shaft) const {
  PumpReading now;
  now.flow_in = -flow_rate(flow, inlet_), now.flow_out = flow_rate(flow, outlet_);
  const double in = now.flow_in / inlet_area_, out = now.flow_out / outlet_area_;  // m/s
  const double weight = flow.density * gravity_;                                   // N/m3
  now.head = (mean_pressure(flow, outlet_) - mean_pressure(flow, inlet_)) / weight + (out * out - in * in) / (2 * gravity_);
  now.head_total = (flux_means(flow, outlet_).total_pressure - flux_means(flow, inlet_).total_pressure) / weight;
  for (const int wall : walls_) {
    const PatchForce force = patch_force(flow, wall, shaft.origin);
    now.torque_pressure += dot(force.pressure_torque, shaft.axis);
    now.torque_friction += dot(force.friction_torque, shaft.axis);
  }
  now.shaft_power = -now.torque() * shaft.speed;
  now.hydraulic_power = weight * now.flow_out * now.head;
  return now;
}

}  // namespace snag
