#pragma once
// What the water does to one particle: pure functions of the fluid there and of the particle, one effect a file of coupling/forces/.
//
// A force is evaluated for a whole tile at once (dem/tile.hpp), place k = begin .. end - 1; places without a particle hold harmless numbers
// and what is written there is not used. So every force is one loop over contiguous arrays that vectorises.
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"
#include "base/vec3.hpp"
#include "dem/rag.hpp"
#include "dem/tile.hpp"

namespace snag {

/// Vectors stored component by component, read as array[k].
struct VectorArray {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  Vec3 operator[](int k) const { return {x[k], y[k], z[k]}; }
};

/// The same to add to.
struct VectorSum {
  double *x = nullptr, *y = nullptr, *z = nullptr;
  void add(int k, const Vec3& v) const { x[k] += v.x, y[k] += v.y, z[k] += v.z; }
};

/// Fields that a force needs at the particles beside the velocity; what nobody needs is not averaged.
struct SampleSet {
  bool velocity_gradient = false, pressure_gradient = false, material_acceleration = false;
  SampleSet operator|(const SampleSet& b) const {
    return {velocity_gradient || b.velocity_gradient, pressure_gradient || b.pressure_gradient,
            material_acceleration || b.material_acceleration};
  }
};

/// The fluid at the particles of a tile, undisturbed by the particle itself as far as the kernel can tell. Fields that no force asked for
/// are zero.
struct FluidSamples {
  double density = 0;                            // rho, kg/m3
  double dynamic_viscosity = 0;                  // mu, Pa s
  VectorArray velocity;                          // u, m/s
  std::array<VectorArray, 3> velocity_gradient;  // G_ij = du_i/dx_j; row i is velocity_gradient[i], 1/s
  VectorArray pressure_gradient;                 // Pa/m
  VectorArray material_acceleration;             // Du/Dt, m/s2
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
};

/// What a force adds to. FluidLoad solves (m + added_mass) a = (F + all other forces) phi, phi by the slope (coupling/fluid_load.hpp).
struct Forces {
  VectorSum force;     // N
  VectorSum torque;    // N m
  double* slope;       // dF/dw, w = u - v: growth of the force with the fluid's velocity, N s/m, >= 0
  double* added_mass;  // kg; the force then holds added_mass Du/Dt
};

/// What a model is, for the manual.
struct Card {
  std::string name, equation, source, valid_for;
  bool reacts_on_fluid = true;  // the water feels the opposite force
  SampleSet samples = {};
  bool gives_torque = false, gives_added_mass = false;  // what is not declared is not read
};

/// State of one sphere in a fluid, for reference cases and tests.
struct SphereState {
  double fluid_density = 998.2, dynamic_viscosity = 1.003e-3;     // kg/m3, Pa s
  Vec3 fluid_velocity, pressure_gradient, material_acceleration;  // m/s, Pa/m, m/s2
  Mat3 velocity_gradient{};                                       // 1/s
  double diameter = 2e-3, particle_density = 1020;                // m, kg/m3
  Vec3 position, velocity, angular_velocity;                      // m, m/s, rad/s
};

/// A force known from outside this code: an exact limit or a published number.
struct ReferenceCase {
  std::string what, source;
  SphereState state;
  Vec3 force;            // N
  double tolerance = 0;  // of |force|, 1
};

class FluidForce {
 public:
  virtual ~FluidForce() = default;
  virtual Card card() const = 0;
  /// Table [coupling.NAME] of the case file.
  virtual std::vector<Parameter> parameters() { return {}; }
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
