#include "coupling/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/flat.hpp"
#include "coupling/kernel.hpp"
#include "coupling/particle_list.hpp"
#include "coupling/prescribed_field.hpp"
#include "coupling/water_prediction.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

namespace {

constexpr double undisturbed = 1e9;  // disturbance width where the particle's own force is not in the fluid, m

/// grad k by Gauss over the faces of the cells. At boundaries k of the cell counts: the slope towards a wall is that on the side of the
/// fluid.
const double* turbulence_gradient(const CellSource& source, std::vector<double>& made) {
  const Mesh& mesh = source.flow.mesh;
  const std::vector<double>& value = source.flow.turbulent_kinetic_energy;
  made.assign(3 * static_cast<std::size_t>(mesh.n_cells), 0.0);
  const auto add = [&](int cell, const Vec3& v) {
    for (int i = 0; i < 3; ++i) made[3 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(i)] += v[i];
  };
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int owner = mesh.owner[f], neighbour = f < mesh.n_interior ? mesh.neighbour[f] : -1;
    const double at_face = neighbour < 0 ? value[owner] : mesh.weight[f] * value[owner] + (1 - mesh.weight[f]) * value[neighbour];
    if (owner < mesh.n_cells) add(owner, at_face / mesh.cell_volume[owner] * mesh.face_vector[f]);
    if (neighbour >= 0 && neighbour < mesh.n_cells) add(neighbour, -(at_face / mesh.cell_volume[neighbour] * mesh.face_vector[f]));
  }
  return made.data();
}

/// Kernel and cell together.
const double* disturbance_width(const CellSource& source, std::vector<double>& made) {
  const Mesh& mesh = source.flow.mesh;
  made.resize(static_cast<std::size_t>(mesh.n_cells), undisturbed);
  if (!source.two_way) return made.data();
  for (const int c : source.cells) made[c] = source.kernel.shape().disturbance_width(source.kernel.width(), std::cbrt(mesh.cell_volume[c]));
  return made.data();
}

const double* point_disturbance(const CellSource& source, std::vector<double>& made) {
  const Mesh& mesh = source.flow.mesh;
  made.resize(static_cast<std::size_t>(mesh.n_cells), 0.0);
  if (!source.two_way) return made.data();
  for (const int c : source.cells) made[c] = source.kernel.shape().point_disturbance(source.kernel.width(), std::cbrt(mesh.cell_volume[c]));
  return made.data();
}

const double* point_width(const CellSource& source, std::vector<double>& made) {
  const Mesh& mesh = source.flow.mesh;
  made.resize(static_cast<std::size_t>(mesh.n_cells));
  for (const int c : source.cells) made[c] = width_of_cell(std::cbrt(mesh.cell_volume[c]));
  return made.data();
}

/// `of_rag` of each particle, spread to the cells.
void spread(const CellSource& source, double (*of_rag)(const Rag&), std::vector<double>& cells) {
  std::vector<double> values(source.particles.size());
  for (std::size_t b = 0; b < values.size(); ++b) values[b] = of_rag(source.rags[source.tiles[source.particles.tile(b)].rag]);
  cells.assign(static_cast<std::size_t>(source.flow.mesh.n_cells), 0.0);
  source.kernel.spread(values, 1, cells);
}

const double* solid_fraction(const CellSource& source, std::vector<double>& made) {
  spread(
      source, [](const Rag& rag) { return rag.hydrodynamic_volume; }, made);
  return made.data();
}

/// Areas spread by the kernel, times the thickness that a flat sheet is smeared over: averaged back they are 1 inside a flat sheet. A cell
/// adds its own size to the kernel's.
const double* coverage(const CellSource& source, std::vector<double>& made) {
  const Mesh& mesh = source.flow.mesh;
  const double own = 2 * std::sqrt(std::numbers::pi) * source.kernel.shape().overlap_width(source.kernel.width());
  spread(
      source, [](const Rag& rag) { return 2 * rag.radius * (2 * rag.radius); }, made);
  for (const int c : source.cells) {
    const double size = std::cbrt(mesh.cell_volume[c]);
    made[c] *= std::sqrt(own * own + size * size);
  }
  return made.data();
}

/// Du/Dt of the formula, times a factor.
void accelerations(const FormulaSource& source, double factor, double* const* a_at) {
  const Mat3 G = source.flow.gradient;
  const VectorArray u = source.velocity;
  const Vec3 rate = source.rate;
#pragma omp simd
  for (int p = source.begin; p < source.end; ++p) {
    const Vec3 a = rate + G * Vec3{u.x[p], u.y[p], u.z[p]};
    a_at[0][p] = factor * a.x, a_at[1][p] = factor * a.y, a_at[2][p] = factor * a.z;
  }
  const PipeFlow& pipe = source.flow.pipe;
  if (!pipe.changes_water()) return;
  for (int p = source.begin; p < source.end; ++p) {
    const Vec3 a = pipe.gradient(source.position[p], source.flow.pipe_speed()) * u[p];
    a_at[0][p] += factor * a.x, a_at[1][p] += factor * a.y, a_at[2][p] += factor * a.z;
  }
}

double k_of(const FormulaSource& source, int p) {
  const Vec3 &slope = source.flow.turbulent_kinetic_energy_gradient, x = source.position[p];
  return source.flow.turbulent_kinetic_energy + slope.x * x.x + slope.y * x.y + slope.z * x.z;
}

void fill(const FormulaSource& source, double value, double* to) { std::fill(to + source.begin, to + source.end, value); }

}  // namespace

const std::vector<SampleRow>& sample_rows() {
  using Made = std::vector<double>&;
  static const std::vector<SampleRow> rows{
      {.needed = &SampleSet::pressure_gradient,
       .target = &FluidSamples::pressure_gradient,
       .of_cells = [](const CellSource& source, Made) { return flat(source.flow.pressure_gradient).data(); },
       .of_formula = [](const FormulaSource& source, double* const* to) { accelerations(source, -source.flow.density, to); },
       .of_sphere = [](const SphereState& state) { return state.pressure_gradient; }},
      {.needed = &SampleSet::material_acceleration,
       .target = &FluidSamples::material_acceleration,
       .of_cells = [](const CellSource& source, Made) { return flat(source.prediction.acceleration()).data(); },
       .of_formula = [](const FormulaSource& source, double* const* to) { accelerations(source, 1, to); },
       .of_sphere = [](const SphereState& state) { return state.material_acceleration; }},
      {.needed = &SampleSet::turbulence,
       .target = &FluidSamples::turbulent_kinetic_energy,
       .of_cells = [](const CellSource& source, Made) { return source.flow.turbulent_kinetic_energy.data(); },
       .of_formula =
           [](const FormulaSource& source, double* const* to) {
             for (int p = source.begin; p < source.end; ++p) to[0][p] = std::max(k_of(source, p), 0.0);
           },
       .of_sphere = [](const SphereState& state) { return Vec3{state.turbulent_kinetic_energy}; }},
      {.needed = &SampleSet::turbulence,
       .target = &FluidSamples::dissipation_rate,
       .of_cells = [](const CellSource& source, Made) { return source.flow.dissipation_rate.data(); },
       .of_formula = [](const FormulaSource& source, double* const* to) { fill(source, source.flow.dissipation_rate, to[0]); },
       .of_sphere = [](const SphereState& state) { return Vec3{state.dissipation_rate}; }},
      {.needed = &SampleSet::turbulence,
       .target = &FluidSamples::turbulent_kinetic_energy_gradient,
       .of_cells = turbulence_gradient,
       .of_formula =
           [](const FormulaSource& source, double* const* to) {
             for (int p = source.begin; p < source.end; ++p)
               for (int i = 0; i < 3; ++i) to[i][p] = k_of(source, p) > 0 ? source.flow.turbulent_kinetic_energy_gradient[i] : 0;
           },
       .of_sphere = [](const SphereState& state) { return state.turbulent_kinetic_energy_gradient; }},
      {.needed = &SampleSet::solid_fraction,
       .target = &FluidSamples::solid_fraction,
       .of_cells = solid_fraction,
       .of_sphere = [](const SphereState& state) { return Vec3{state.solid_fraction}; }},
      {.needed = &SampleSet::disturbance,
       .target = &FluidSamples::disturbance_width,
       .of_cells = disturbance_width,
       .of_formula = [](const FormulaSource& source, double* const* to) { fill(source, undisturbed, to[0]); },
       .of_sphere = [](const SphereState& state) { return Vec3{state.disturbance_width}; }},
      {.needed = &SampleSet::point_disturbance,
       .target = &FluidSamples::point_disturbance,
       .of_cells = point_disturbance,
       .of_formula = [](const FormulaSource& source, double* const* to) { fill(source, 0, to[0]); },
       .of_sphere = [](const SphereState& state) { return Vec3{state.point_disturbance}; }},
      {.needed = &SampleSet::point_disturbance,
       .target = &FluidSamples::point_width,
       .of_cells = point_width,
       .of_sphere = [](const SphereState& state) { return Vec3{state.point_width}; }},
      {.needed = &SampleSet::coverage, .target = &FluidSamples::coverage, .of_cells = coverage},
      {.needed = &SampleSet::wall,
       .target = &FluidSamples::wall_distance,
       .of_sphere = [](const SphereState& state) { return Vec3{state.wall_distance}; }},
      {.needed = &SampleSet::wall, .target = &FluidSamples::wall_normal, .of_sphere = [](const SphereState& state) {
         return state.wall_normal;
       }}};
  return rows;
}

SampleSet SampleSet::operator|(const SampleSet& b) const {
  SampleSet either = *this;
  either.velocity_gradient = velocity_gradient || b.velocity_gradient;
  for (const SampleRow& row : sample_rows()) either.*row.needed = this->*row.needed || b.*row.needed;
  return either;
}

void SampleRow::point(FluidSamples& fluid, const double* const* arrays) const {
  if (const auto* scalar = std::get_if<const double * FluidSamples::*>(&target))
    fluid.** scalar = arrays[0];
  else
    fluid.*std::get<VectorArray FluidSamples::*>(target) = {arrays[0], arrays[1], arrays[2]};
}

int sampled::n_arrays() {
  int n = n_core;
  for_each_row([&](const SampleRow& row, int) { n += row.components(); });
  return n;
}

}  // namespace snag
