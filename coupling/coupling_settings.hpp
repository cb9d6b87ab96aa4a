#pragma once
// What a case says of the coupling: [coupling] with a table for each force, and [gravity].
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/fluid_load.hpp"
#include "coupling/kernel_shape.hpp"
#include "mesh/mesh.hpp"

namespace snag {

/// Forces that go together, by one name among the `forces` of a case.
struct ForceSet {
  std::string name;
  std::vector<std::string> forces;
  std::string meaning;
};
/// The first is what a case without `forces` gets.
const std::vector<ForceSet>& force_sets();
/// The forces with every set in place of its name.
std::vector<std::string> spelt_out(const std::vector<std::string>& names);

struct CouplingSettings {
  enum class Mode { none, one_way, two_way };
  Choice<Mode> mode{Mode::two_way, {"none", "one_way", "two_way"}};
  std::string kernel = "gaussian";
  std::optional<double> kernel_width;                             // delta, m; not given: chosen for the rags
  std::vector<std::string> forces = force_sets().front().forces;  // sets are spelt out when a case is read

  Section section();
  bool two_way() const { return mode == Mode::two_way; }
};

/// The models that a case chose.
struct Coupling {
  CouplingSettings settings;
  std::unique_ptr<KernelShape> shape;
  FluidForces forces;  // in order of their names in `settings`; weight and buoyancy last where [gravity] is given

  /// Kernel width in force for these rags, m.
  double kernel_width(const std::vector<Rag>& rags) const;
};

/// Reads [coupling], [coupling.FORCE] of the forces it lists, [coupling.KERNEL], and [gravity]. Throws Error(usage) for an unknown name,
/// one listed twice, or two_way with `two_way_possible` false (a prescribed flow feels nothing; the default is then one_way).
Coupling read_coupling(const Table& root, bool two_way_possible = true);
/// Acceleration of [gravity], m/s2; zero without that table. For rags without water, and for bounds.
Vec3 read_gravity(const Table& root);
/// For the manual: [coupling], [gravity], and a table for each force and kernel that has parameters.
std::vector<Section> coupling_sections();

/// Remarks on the kernel width against particle diameters, the sides of sheets and the cells where particles are, with numbers; empty if it
/// fits. `places`: of particles, on any rank, m. Collective, the same on every rank.
std::vector<std::string> kernel_warnings(const Coupling& coupling, const std::vector<Rag>& rags, const Mesh& mesh,
                                         std::span<const Vec3> places);

/// A remark for each force that looks for the nearest wall where the rags know none, though the water has walls (`water_has_walls`) or the
/// force is nothing without.
std::vector<std::string> wall_warnings(const Coupling& coupling, bool rags_know_walls, bool water_has_walls);

/// A remark where the laws of drag are those of cloth or fibres alone and a piece is neither; empty otherwise.
std::string undragged_warning(const Coupling& coupling, const std::vector<Rag>& rags);

/// A remark where friction carries the impulse of a two-way cloth out of its kernel within less than a step (s) of water of this kinematic
/// viscosity (m2/s): delta^2/nu; empty where it does not.
std::string viscous_step_warning(const Coupling& coupling, const std::vector<Rag>& rags, double step, double viscosity);

/// The kernel width that a case without kernel_width has, for its heading; empty where it is given or the kernel has no width.
std::string assumed_kernel_width(const Coupling& coupling, const std::vector<Rag>& rags);

/// What a one-way case leaves out of the inertia of its cloth, a line for each piece that is a sheet: a flat plate W x L, W <= L, that is
/// accelerated across itself takes with it up to
///   m = pi/4 rho W^2 L    (a strip of the width W; a rectangle less: a square 0.48 of it)
/// where the forces on its particles know their own volumes only. Source: Lamb (1932), Hydrodynamics, section 71; Brennen (1982), A review
/// of added mass and fluid inertial forces.
std::vector<std::string> left_out_added_mass(const Coupling& coupling, const std::vector<Rag>& rags);

}  // namespace snag
