#include "coupling/fluid_load.hpp"

#include <algorithm>

namespace snag {

namespace {
enum Sum { impulse_x, impulse_y, impulse_z, sensitivity_sum, n_sums };
enum Array { reacting_force = 0, slope_sum = 3, silent_force = 4, added_mass_sum = 7, torque_sum = 8, relaxation = 11, n_arrays };
}  // namespace

FluidLoad::FluidLoad(const FluidForces& forces, FluidField& field, const std::vector<Rag>& rags)
    : forces_(forces), field_(field), rags_(rags) {
  for (const auto& force : forces_) {
    const Card card = force->card();
    needed_ = needed_ | card.samples;
    reacts_.push_back(card.reacts_on_fluid);
    all_react_ = all_react_ && card.reacts_on_fluid;
    torque_ = torque_ || card.gives_torque, added_mass_ = added_mass_ || card.gives_added_mass;
  }
}

void FluidLoad::begin_step(std::span<const Tile> tiles) {
  field_.sample(tiles, needed_);
  elapsed_.assign(tiles.size(), 0.0);
  sums_.reset(tiles, n_sums);
  scratch_size_ = 0;
  for (const Tile& tile : tiles) scratch_size_ = std::max(scratch_size_, tile.exists.size());
  scratch_.assign(n_arrays * scratch_size_, 0.0);
}

void FluidLoad::add(std::size_t index, Tile& tile, double step) {
  const Rag& rag = rags_[tile.rag];
  evaluate(index, tile, step);
  elapsed_[index] += step;

  const double m = rag.mass;
  const double *exists = tile.exists.data(), *free = tile.free.data(), *slope = array(slope_sum), *added_mass = array(added_mass_sum);
  double *phi = array(relaxation), *Q = sums_.field(index, sensitivity_sum);
  for (int j = 0; j < tile.ny; ++j) {
    const int first = tile.index(0, j), end = first + tile.nx;
#pragma omp simd
    for (int k = first; k < end; ++k) {
      const double theta = step * slope[k] / (m + added_mass[k]);
      const double mean = (1 + theta / 6) / (1 + theta * (2.0 / 3 + theta / 6));
      Q[k] += exists[k] * step * slope[k] * (free[k] > 0 ? mean : 1);
      phi[k] = free[k] > 0 ? mean * m / (m + added_mass[k]) : 1;  // m a over the sum of all forces
    }
    for (int i = 0; i < 3; ++i) {
      const double *R = array(reacting_force + i), *N = array(silent_force + i);
      double *f = tile.field(Tile::fx + i), *J = sums_.field(index, impulse_x + i);
#pragma omp simd
      for (int k = first; k < end; ++k) {
        const double total = (f[k] + R[k] + N[k]) * phi[k];  // m a
        J[k] += exists[k] > 0 ? step * (total - f[k] - N[k]) : 0;
        f[k] = exists[k] > 0 ? total : f[k];
      }
    }
  }
  if (torque_) add_torque(tile);
}

/// All forces on the particles of a tile.
void FluidLoad::evaluate(std::size_t index, const Tile& tile, double step) {
  const Particles particles(rags_[tile.rag], tile);
  const auto clear = [&](int f, int count) {
    for (int i = f; i < f + count; ++i) std::fill(array(i) + particles.begin, array(i) + particles.end, 0.0);
  };
  clear(reacting_force, 4);  // with the slope
  if (!all_react_) clear(silent_force, 3);
  if (added_mass_) clear(added_mass_sum, 1);
  if (torque_) clear(torque_sum, 3);
  const auto vector = [&](int f) { return VectorSum{array(f), array(f + 1), array(f + 2)}; };
  const Forces reacting{vector(reacting_force), vector(torque_sum), array(slope_sum), array(added_mass_sum)};
  const Forces silent{vector(silent_force), vector(torque_sum), array(slope_sum), array(added_mass_sum)};
  // The middle of the sub-step is where the integrator evaluates forces.
  const FluidSamples fluid = field_.at(index, tile, elapsed_[index] + 0.5 * step);
  for (std::size_t i = 0; i < forces_.size(); ++i) forces_[i]->add(fluid, particles, reacts_[i] ? reacting : silent);
}

void FluidLoad::add_torque(Tile& tile) {
  for (int j = 0; j < tile.ny; ++j)
    for (int i = 0; i < 3; ++i) {
      const double* T = array(torque_sum + i);
      double* t = tile.field(Tile::tx + i);
      for (int k = tile.index(0, j); k < tile.index(tile.nx, j); ++k) t[k] += tile.exists[k] > 0 ? T[k] : 0;
    }
}

Vec3 FluidLoad::impulse(std::size_t index, int k) const {
  return {sums_.field(index, impulse_x)[k], sums_.field(index, impulse_y)[k], sums_.field(index, impulse_z)[k]};
}

double FluidLoad::sensitivity(std::size_t index, int k) const { return sums_.field(index, sensitivity_sum)[k]; }

std::vector<Vec3> FluidLoad::impulses(std::span<const Tile> tiles) const {
  const ParticleList particles(tiles);
  std::vector<Vec3> all(particles.size());
  for (std::size_t b = 0; b < all.size(); ++b) all[b] = impulse(particles.tile(b), particles.place(b));
  return all;
}

double FluidLoad::max_stiffness(std::span<const Tile> tiles) const {
  double largest = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const double* Q = sums_.field(t, sensitivity_sum);
    largest = std::max(largest, *std::max_element(Q, Q + tiles[t].exists.size()) / rags_[tiles[t].rag].mass);
  }
  return largest;
}

}  // namespace snag
