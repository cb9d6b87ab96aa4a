#pragma once
// Boundary conditions of the flow: one kind, one file in solver/boundaries/kinds/, chosen for each patch by the [[boundary]] tables of the
// case.
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/registry.hpp"
#include "solver/boundaries/inlet_turbulence.hpp"
#include "solver/fields/flow.hpp"
#include "solver/operators/gradient.hpp"

namespace snag {

/// What a condition prescribes on its patch. The answers that the operators need follow from it, unless the condition gives its own.
///   velocity:         u and the flux are given, p is extrapolated from inside (walls, inlets)
///   pressure:         p is given, du/dn = 0; fluid that enters comes along the normal (outlets)
///   normal_velocity:  u.n is given, no friction, p is extrapolated from inside (planes of symmetry)
enum class PrescribedQuantity { velocity, pressure, normal_velocity };

/// Where the flux through the faces of a patch comes from.
enum class FaceFlux {
  given,     // BoundaryValues::flux
  tight,     // nothing passes: the volume that the face sweeps
  from_cell  // interpolated from the cell with the pressure at the face, as fluid leaves or enters
};

/// Values at the boundary faces, face f at f - n_interior.
struct BoundaryValues {
  std::vector<Vec3> velocity;      // where velocity or its normal part is fixed, m/s
  std::vector<double> flux;        // where velocity is fixed, out of the domain, m3/s
  std::vector<double> pressure;    // where pressure is fixed, Pa
  std::vector<Vec3> acceleration;  // of the fluid where it is known, for the pressure there, m/s2
  std::vector<Vec3> spin;          // of a wall that turns, rad/s
};

struct PatchBoundary;

/// A boundary condition on one patch.
class Boundary {
 public:
  virtual ~Boundary() = default;
  /// Its keys in a [[boundary]] table; the records point into this object.
  virtual Section section() = 0;
  virtual PrescribedQuantity fixes() const = 0;
  /// How the velocity of a cell ends at a face, for its gradients, friction and convection: value (friction by the difference to
  /// BoundaryValues::velocity; fluid that enters carries it), slope (no friction; fluid that enters comes along the normal) or
  /// mirror (friction of the normal part alone, by the difference to BoundaryValues::velocity, nothing carried).
  virtual Side velocity_side() const;
  /// How the pressure ends: value (BoundaryValues::pressure) or slope.
  virtual Side pressure_side() const { return fixes() == PrescribedQuantity::pressure ? Side::value : Side::slope; }
  virtual FaceFlux flux() const;
  /// True for solid walls, where wall functions act.
  virtual bool is_wall() const { return false; }
  /// Equivalent sand roughness of a wall, m; 0: smooth.
  virtual double roughness() const { return 0; }
  /// True where water passes: not at walls and planes of symmetry.
  bool is_open() const { return !is_wall() && flux() != FaceFlux::tight; }
  /// True where the pressure is as given, false where its level follows from the flow.
  virtual bool pressure_is_prescribed() const { return pressure_side() == Side::value; }
  /// Where pressure_side() is value: the pressure that the case gives at a time, or with a target of the flow the level that the controller
  /// has found, Pa; before the dynamic head of entering water is subtracted.
  virtual double given_pressure(double /*time*/) const { return 0; }
  /// True where what the water carries has left for good once it is beyond the patch.
  virtual bool is_outlet() const { return pressure_side() == Side::value; }
  /// True where what is beyond the patch has left: an outlet, and an inlet whose given velocity draws water out.
  virtual bool leads_out() const { return is_outlet(); }
  /// True where the case gives the velocity: not where a condition draws it from the flow that leaves.
  bool velocity_is_given() const { return velocity_side() == Side::value && !is_outlet(); }
  /// What to change in its table where the water diverges at it; empty: nothing is known.
  virtual std::string advice() const { return {}; }
  /// Once, before the first step: what depends on the mesh and on the conditions of all its patches, in their order. Collective.
  virtual void prepare(const Mesh&, const Patch&, const std::vector<PatchBoundary>& /*all*/) {}
  /// Before each update: what the condition draws from the flow for the step that leads to `time`; flow.flux_old is then the flux at its
  /// begin, flow.flux that of one step before. At a start time is flow.time. Collective.
  virtual void respond(const Flow&, const Patch&, double /*time*/) {}
  /// Values of the patch at a time. Local; called every step, after the mesh has moved.
  virtual void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const = 0;
  /// Where the flow at the end of a run is not what the case asks of the patch: what to say of it; empty: nothing. Collective.
  virtual std::string unmet(const Flow&, const Patch&) const { return {}; }
  /// Times at which what the case gives may have its extremes, s: the knots of a table.
  virtual std::vector<double> knots() const { return {}; }
  /// What a resume needs of it, the same on every rank and of the same length at any time.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(const std::vector<double>& /*state*/) {}
};

Registry<Boundary>& boundaries();

/// A condition and the patch it is for.
struct PatchBoundary {
  std::string patch;
  std::string where;  // the table of the case file, for messages
  std::unique_ptr<Boundary> boundary;
  InletTurbulence turbulence = {};  // of fluid that enters
};

/// All [[boundary]] tables. Throws Error(usage) for an unknown kind or a table that names no patch.
std::vector<PatchBoundary> read_boundaries(const Table& root);
/// The tables as sections for the manual: the keys that all kinds share, then one section a kind.
std::vector<Section> boundary_sections();

/// The conditions of all patches of a mesh, and their values at a time.
class BoundarySet {
 public:
  /// Throws Error(usage) for a patch without a condition, with two, and for a condition of an unknown patch. Collective.
  BoundarySet(const Mesh& mesh, std::vector<PatchBoundary> conditions);
  /// Once a step. Collective; throws Error(usage) if nothing fixes the pressure and what flows in does not flow out.
  void update(const Flow& flow, double time);

  const BoundaryValues& values() const { return values_; }
  /// Set all velocities, fluxes and wall accelerations to zero and return the values before, for restore(): water at rest.
  BoundaryValues exchange_for_rest_state();
  void restore(const BoundaryValues& values) { values_ = values; }
  Side velocity_side(int patch) const { return velocity_sides_[patch]; }
  Side pressure_side(int patch) const { return pressure_sides_[patch]; }
  FaceFlux flux(int patch) const { return conditions_[patch].boundary->flux(); }
  const std::vector<Side>& velocity_sides() const { return velocity_sides_; }
  const std::vector<Side>& pressure_sides() const { return pressure_sides_; }
  bool is_wall(int patch) const { return conditions_[patch].boundary->is_wall(); }
  double roughness(int patch) const { return conditions_[patch].boundary->roughness(); }
  bool is_open(int patch) const { return conditions_[patch].boundary->is_open(); }
  bool is_outlet(int patch) const { return conditions_[patch].boundary->is_outlet(); }
  bool leads_out(int patch) const { return conditions_[patch].boundary->leads_out(); }
  std::string advice(int patch) const { return conditions_[patch].boundary->advice(); }
  bool velocity_is_given(int patch) const { return conditions_[patch].boundary->velocity_is_given(); }
  double given_pressure(int patch, double time) const { return conditions_[patch].boundary->given_pressure(time); }
  const InletTurbulence& turbulence(int patch) const { return conditions_[patch].turbulence; }
  const std::string& where(int patch) const { return conditions_[patch].where; }
  /// Of all conditions, s.
  std::vector<double> knots() const;
  /// Boundary::unmet of all patches. Collective.
  std::vector<std::string> unmet(const Flow& flow) const;
  /// True if some patch fixes the pressure.
  bool fixes_pressure() const { return fixes_pressure_; }

  /// What a resume needs of all conditions, one after the other; empty if they need nothing.
  std::vector<double> state() const;
  void restore_state(const std::vector<double>& state);

 private:
  /// Flux out of the domain through the patches that give it, m3/s.
  struct NetFlux {
    double net = 0;      // out less in
    double carried = 0;  // sum of what passes the faces and of what walls carry along themselves: the scale of the round-off
    /// But for the rounding of a case's numbers.
    bool is_balanced() const { return std::abs(net) <= 1e-9 * carried; }
  };
  NetFlux net_flux(std::span<const int> faces) const;
  void carry_off_the_rest();
  void check_net_flux() const;
  /// Cells that are not joined to those at other openings, with openings of which none gives the pressure.
  struct LooseRegion {
    std::int64_t id;         // regions()
    int patch;               // an opening,
    Vec3 place;              // and where it is, m
    std::vector<int> faces;  // of given_faces_
  };
  void find_loose_regions();
  void check_loose_regions() const;
  const Mesh& mesh_;
  std::vector<PatchBoundary> conditions_;              // in the order of the patches
  std::vector<Side> velocity_sides_, pressure_sides_;  // of each patch
  std::vector<int> given_faces_;  // of this rank, whose flux is given; counted from n_interior, which changes as a mesh turns
  BoundaryValues values_;
  bool fixes_pressure_ = false;
  std::vector<LooseRegion> loose_regions_;  // the same on every rank
};

}  // namespace snag
