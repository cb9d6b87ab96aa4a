#pragma once
// What the water does to one particle: pure functions of the fluid there and of the particle, one effect a file of coupling/forces/.
//
// A force is evaluated for a whole tile at once (dem/particles/tile.hpp), place k = begin .. end - 1; places without a particle hold
// harmless numbers and what is written there is not used. So every force is one loop over contiguous arrays that vectorises.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/prior.hpp"
#include "base/registry.hpp"
#include "base/vec3.hpp"
#include "coupling/samples.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

/// Vectors stored component by component, to add to.
struct VectorSum {
  double *x = nullptr, *y = nullptr, *z = nullptr;
  void add(int k, const Vec3& v) const { x[k] += v.x, y[k] += v.y, z[k] += v.z; }
};

/// The particles of a tile. All particles of a rag have the same size and mass; neighbours of k in the sheet are k +- 1 and k +-
/// tile.stride.
struct Particles {
  Particles(const Rag& rag_, const Tile& tile_);
  const Rag& rag;
  const Tile& tile;
  int begin, end;                                    // places of the tile
  VectorArray position, velocity, angular_velocity;  // m, m/s, rad/s
  double diameter;                                   // d of the drag law, m
  double mass;                                       // m, kg
  double volume;                                     // V_h, hydrodynamic, m3
  double step = 0;                                   // h, of the sub-step, s
  /// ForceDescription::n_particle_state numbers of each particle that stay with it: number i of place k is state[i * state_stride + k];
  /// zero at birth.
  double* state = nullptr;
  std::size_t state_stride = 0;
  /// J of the water on each particle in the sub-step before, N s; for forces whose description needs it.
  VectorArray last_impulse = {};
  /// |F|/|w| of the drag in the sub-step before, N s/m; zero at birth; for forces whose description needs it.
  const double* last_drag = nullptr;
  std::int64_t id(int column, int row) const;  // of the particle in this column and row of the tile
};

/// What a force adds to. FluidLoad solves (m + added_mass) a = (F + all other forces) phi, phi by the slope (coupling/fluid_load.hpp).
struct Forces {
  VectorSum force;                 // N
  VectorSum torque;                // N m
  double* slope;                   // dF/dw, w = u - v: growth of the force with the fluid's velocity, N s/m, >= 0
  double* added_mass;              // kg; the force then holds added_mass Du/Dt
  double* torque_slope = nullptr;  // dT/d(omega_fluid - omega), N m s, >= 0
  VectorSum fluid_velocity = {};   // m/s, what all others see: for Role::fluid only
  double* slip_growth = nullptr;   // d(slip that all others see)/d(slip of the samples), 1 where nobody sets it: for Role::fluid only
  double* relief = nullptr;        // slip that the force loses per impulse of this sub-step beside the answer of the water, 1/kg
  double* screen = nullptr;        // A ((1 + K)^(1/2) - 1) of cloth that eddies do not cross, m2 (Flow::screen)
};

/// What a model changes; models act in this order, those of one role in the order of their names.
enum class Role {
  fluid,             // the fluid velocity that the others see
  drag,              // adds drag
  drag_replacement,  // takes the place of a share of the drag that `force` and `slope` hold by then
  drag_modifier,     // changes the drag that `force` and `slope` hold by then; force = slope w, unless a model before made it anisotropic
  force,             // adds a force
  weight             // weight and buoyancy: what water at rest does, which no output counts as a force of the water
};

/// What a model is, for the manual.
struct ForceDescription {
  std::string name, equation, source, valid_for;
  bool reacts_on_fluid = true;  // the water feels the opposite force
  SampleSet samples = {};
  bool gives_torque = false, gives_added_mass = false;  // what is not declared is not read
  bool gives_screen = false;
  bool needs_impulse = false, needs_drag = false;  // of the sub-step before
  Role role = Role::force;
  int n_particle_state = 0;         // numbers stored for each particle
  std::optional<Prior> prior = {};  // of a candidate of the diagnosis
};

/// A force known from outside this code: an exact limit or a published number.
struct ReferenceCase {
  std::string what, source;
  SphereState state;
  Vec3 force;                             // N; of a model that changes the fluid or the drag: together with schiller_naumann
  double tolerance = 0;                   // of |force| (or |torque|), 1
  std::optional<Vec3> torque = {};        // N m
  std::optional<double> added_mass = {};  // kg
};

class FluidForce {
 public:
  virtual ~FluidForce() = default;
  virtual ForceDescription description() const = 0;
  /// Table [coupling.NAME] of the case file.
  virtual std::vector<Parameter> parameters() { return {}; }
  /// Whether the water feels the rags, for what was not given and depends on it. After reading.
  virtual void set_coupling(bool /*two_way*/) {}
  /// Adds force, torque, slope and added mass of particles k = begin .. end - 1. No communication; the same result for the same numbers.
  virtual void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const = 0;
  virtual std::vector<ReferenceCase> reference_cases() const = 0;
};

Registry<FluidForce>& fluid_forces();

/// Force, torque, slope and added mass on one sphere.
struct SphereLoad {
  Vec3 force, torque;
  double slope = 0, added_mass = 0;
};
SphereLoad load_on_sphere(const FluidForce& force, const SphereState& state);

/// Sphere moved at Reynolds number Re through still water; drag is then 1/2 rho C_d A |w| w.
ReferenceCase drag_at(double Re, double drag_coefficient, double tolerance, const std::string& source);
/// Creeping flow, F = 3 pi mu d w, at Re = 1e-6.
ReferenceCase stokes_limit();

}  // namespace snag
