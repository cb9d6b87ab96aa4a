#pragma once
// Water in two rings, the inner of which turns: the mesh, its zone, and what the verifications of the turning zone share.
#include "mesh/import/import.hpp"
#include "tests/unit/mesh/sliding_shells.hpp"
#include "tests/verification/solver/flow_cases.hpp"

namespace snag::test {

/// The rings of sliding_shells.hpp, each of their surfaces a patch: rotor_inner, rotor_bottom, stator_outer, stator_bottom, stator_top,
/// and lid_inner, lid_outer, lid_top with a lid, rotor_top without.
inline Sample rings(const Shells& s) {
  Sample sample;
  sample.volumes = {{1, "rotor"}, {2, "stator"}};
  sample.surfaces = {{1, "interface_rotor"}, {2, "interface_stator"}, {3, "rotor_inner"}, {4, "rotor_bottom"},
                     {5, "stator_outer"},    {6, "stator_bottom"},    {7, "stator_top"}};
  if (s.has_lid)
    sample.surfaces.insert(sample.surfaces.end(), {{8, "lid_inner"}, {9, "lid_outer"}, {10, "lid_top"}});
  else
    sample.surfaces.push_back({8, "rotor_top"});
  add_ring(sample, {1, s.inner, s.radius, 0, s.height, 0, s.rotor, {3, 1, 4, s.has_lid ? 1 : 8}}, s);
  add_ring(sample, {2, s.stator_radius, s.outer, 0, s.height, s.stator_start, s.stator, {2, 5, 6, 7}}, s);
  if (s.has_lid) add_ring(sample, {2, s.inner, s.radius, s.height, s.top, s.stator_start, {s.stator[0], s.stator[1], 2}, {8, 9, 2, 10}}, s);
  return sample;
}

inline Mesh ring_mesh(const Shells& shells) {
  const TemporaryFile file(rings(shells), Format::ascii22);
  ImportOptions options;
  const Vec3 period = shells.height * unit(shells.axis);
  if (shells.is_periodic) options.periodic = {{"rotor_bottom", "rotor_top", period}, {"stator_bottom", "stator_top", period}};
  return import_mesh(file.path(), MPI_COMM_WORLD, options);
}

/// The zone "rotor", turning with `speed` in rad/s.
inline std::unique_ptr<RotatingZone> turning_rotor(Mesh& mesh, const Shells& shells, double speed, const std::string& motion = "sliding",
                                                   double start_angle = 0) {
  RotatingZoneSettings settings;
  settings.zone = "rotor", settings.motion.choose(motion), settings.speed = speed, settings.start_angle = start_angle;
  settings.origin = shells.origin, settings.axis = shells.axis;
  return std::make_unique<RotatingZone>(mesh, settings);
}

/// Cells of about equal size: `around` on the circle of the interface, of the stator some more that do not match.
inline Shells plane_rings(double inner, double radius, double outer, int around) {
  const double h = 2 * pi * radius / around;
  const auto cells = [&](double length) { return std::max(1, static_cast<int>(std::lround(length / h))); };
  Shells s{.inner = inner, .radius = radius, .outer = outer, .height = 0.1};
  s.rotor = {around, cells(radius - inner), 1}, s.stator = {around + around / 6, cells(outer - radius), 1};
  s.tetrahedra = false, s.has_lid = false, s.is_periodic = true, s.stator_radius = radius;
  return s;
}

}  // namespace snag::test
