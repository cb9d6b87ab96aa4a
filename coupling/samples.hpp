#pragma once
// The fluid at the particles, as forces see it. A further sample is one member each of SampleSet, FluidSamples and SphereState, and one row
// of the table in samples.cpp, which says where it comes from: the cells of a flow, a flow given as a formula, the state of one sphere.
#include <array>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

struct Flow;
struct PrescribedFlow;
struct Rag;
struct Tile;
class Kernel;
class ParticleList;
class WaterPrediction;

/// Vectors stored component by component, read as array[k].
struct VectorArray {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  Vec3 operator[](int k) const { return {x[k], y[k], z[k]}; }
};

/// Fields that a force needs at the particles in addition to the velocity; what nobody needs is not averaged.
struct SampleSet {
  bool velocity_gradient = false, pressure_gradient = false, material_acceleration = false;
  bool turbulence = false, solid_fraction = false, wall = false, disturbance = false, coverage = false;
  bool point_disturbance = false;
  SampleSet operator|(const SampleSet& b) const;
};

/// The fluid at the particles of a tile, undisturbed by the particle itself as far as the kernel can tell. Of the fields only the velocity
/// and what the force's description asks for may be read.
struct FluidSamples {
  double density = 0;              // rho, kg/m3
  double dynamic_viscosity = 0;    // mu, Pa s
  VectorArray velocity = {};       // u, m/s
  VectorArray velocity_rate = {};  // of u on the way of the particle, with `start` at that place, but for the answer to forces, m/s2
  VectorArray start = {};  // place of the particle at the start of the step, for which the samples are, m; null: they are those on its way
  const double* response = nullptr;                    // velocity that u loses per impulse of the particle, 1/kg; null: zero
  double response_left = 0;                            // times response and the impulse of the last step: a rate of u, 1/s
  std::array<VectorArray, 3> velocity_gradient = {};   // G_ij = du_i/dx_j; row i is velocity_gradient[i], 1/s
  VectorArray pressure_gradient = {};                  // Pa/m
  VectorArray material_acceleration = {};              // Du/Dt, m/s2
  const double* turbulent_kinetic_energy = nullptr;    // k, m2/s2
  const double* dissipation_rate = nullptr;            // epsilon, m2/s3
  VectorArray turbulent_kinetic_energy_gradient = {};  // m/s2
  const double* solid_fraction = nullptr;              // volume of particles over volume, 1
  const double* disturbance_width =
      nullptr;  // over which the particle's own force is smeared in these samples, m; 1e9 where it is not in them
  const double* point_disturbance = nullptr;  // added to 1/disturbance_width by points of the kernel that lie apart, 1/m
  const double* point_width = nullptr;        // over which each of these points is smeared, m
  const double* coverage = nullptr;  // share of the kernel that the cloth around the particle fills: 1 inside a flat sheet, 1/2 at an edge
  const double* edge_distance = nullptr;  // s of coupling/cloth_edges.hpp, m; with the coverage
  const double* wall_distance = nullptr;  // of the particle's centre from the nearest wall, m; far away a large number
  VectorArray wall_normal = {};           // unit, from that wall to the particle
};

/// State of one sphere in a fluid, for reference cases and tests.
struct SphereState {
  double fluid_density = 998.2, dynamic_viscosity = 1.003e-3;                     // kg/m3, Pa s
  Vec3 fluid_velocity, pressure_gradient, material_acceleration;                  // m/s, Pa/m, m/s2
  Mat3 velocity_gradient{};                                                       // 1/s
  double diameter = 2e-3, particle_density = 1020;                                // m, kg/m3
  Vec3 position, velocity, angular_velocity;                                      // m, m/s, rad/s
  double turbulent_kinetic_energy = 0, dissipation_rate = 0, solid_fraction = 0;  // m2/s2, m2/s3, 1
  Vec3 turbulent_kinetic_energy_gradient;                                         // m/s2
  double disturbance_width = 1e9, point_disturbance = 0, point_width = 1e-3;      // m, 1/m, m
  double wall_distance = 1e9;                                                     // m
  Vec3 wall_normal{0, 0, 1};
  Vec3 next_in_row, next_row;  // to the bonded neighbours on both sides, that move with the sphere; zero: none; m
  bool begins_row = false;     // without the neighbour at -next_in_row
  double step = 1e-3;          // s
};

/// What a sample of the cells of a flow is made of.
struct CellSource {
  const Flow& flow;
  Kernel& kernel;              // located at the particles
  std::span<const int> cells;  // that it uses: the others need no values
  const std::vector<Rag>& rags;
  const WaterPrediction& prediction;
  bool two_way;
  const ParticleList& particles;
  std::span<const Tile> tiles;
};

/// What a sample of a formula is made of, at places begin .. end - 1 of a tile.
struct FormulaSource {
  const PrescribedFlow& flow;
  Vec3 rate;                       // du/dt of the uniform part, m/s2
  VectorArray position, velocity;  // of the particles, m; of the fluid there, m/s
  int begin, end;
};

/// Where one sample comes from.
struct SampleRow {
  bool SampleSet::*needed;
  std::variant<const double * FluidSamples::*, VectorArray FluidSamples::*> target;
  /// Values of the owned cells, [n_cells][components], to be averaged; what is computed for it goes into `made`. Collective. None: the
  /// sample is found at the particles (walls).
  std::function<const double*(const CellSource&, std::vector<double>& made)> of_cells = {};
  /// Fills the components of the places. None: zero.
  std::function<void(const FormulaSource&, double* const* components)> of_formula = {};
  /// Components of one sphere. None: the sphere lacks it.
  std::function<Vec3(const SphereState&)> of_sphere = {};

  int components() const { return target.index() == 0 ? 1 : 3; }
  void point(FluidSamples& fluid, const double* const* arrays) const;
};
const std::vector<SampleRow>& sample_rows();

/// Arrays in which a field keeps the fluid at the particles: the first component of each. Those of the rows that are averaged come after
/// these, in the order of the rows.
namespace sampled {
enum Array { velocity = 0, gradient = 3, change = 12, response = 15, start = 16, mean_place = 19, edge_distance = 22, n_core = 23 };
/// With those of the rows.
int n_arrays();
/// Calls visit(row, first array) for each row that has arrays.
template <class Visit>
void for_each_row(const Visit& visit) {
  int first = n_core;
  for (const SampleRow& row : sample_rows()) {
    if (!row.of_cells) continue;
    visit(row, first);
    first += row.components();
  }
}
}  // namespace sampled

}  // namespace snag
