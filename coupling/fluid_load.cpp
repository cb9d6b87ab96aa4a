#include "coupling/fluid_load.hpp"

#include <algorithm>

namespace snag {

namespace {
enum Sum { impulse_x, impulse_y, impulse_z, sensitivity_sum, n_sums };
constexpr int n_arrays = 12;  // force with reaction, force without, torque, slope, added mass, phi
}  // namespace

FluidLoad::FluidLoad(const FluidForces& forces, FluidField& field, const std::vector<Rag>& rags)
    : forces_(forces), field_(field), rags_(rags) {
  for (const auto& force : forces_) {
    const Card card = force->card();
    needed_ = needed_ | card.samples;
    reacts_.push_back(card.reacts_on_fluid);
  }
}

void FluidLoad::begin_step(std::span<const Tile> tiles) {
  field_.sample(tiles, needed_);
  elapsed_.assign(tiles.size(), 0.0);
  sums_.reset(tiles, n_sums);
}

void FluidLoad::add(std::size_t index, Tile& tile, double step) {
  const Rag& rag = rags_[tile.rag];
  const std::size_t size = tile.exists.size();
  scratch_.assign(n_arrays * size, 0.0);
  const auto array = [&](int f) { return scratch_.data() + f * size; };
  const VectorSum torque{array(6), array(7), array(8)};
  const Forces reacting{{array(0), array(1), array(2)}, torque, array(9), array(10)};
  const Forces silent{{array(3), array(4), array(5)}, torque, array(9), array(10)};
  // The middle of the sub-step is where the integrator evaluates forces.
  const FluidSamples fluid = field_.at(index, tile, elapsed_[index] + 0.5 * step);
  const Particles particles(rag, tile);
  for (std::size_t i = 0; i < forces_.size(); ++i) forces_[i]->add(fluid, particles, reacts_[i] ? reacting : silent);
  elapsed_[index] += step;

  const double m = rag.mass;
  const double *exists = tile.exists.data(), *free = tile.free.data(), *slope = array(9), *added_mass = array(10);
  double *phi = array(11), *Q = sums_.field(index, sensitivity_sum);
  for (int j = 0; j < tile.ny; ++j) {
    const int first = tile.index(0, j), end = first + tile.nx;
#pragma omp simd
    for (int k = first; k < end; ++k) {
      const double theta = step * slope[k] / (m + added_mass[k]);
      phi[k] = free[k] > 0 ? (1 + theta / 6) / (1 + theta * (2.0 / 3 + theta / 6)) : 1;
      Q[k] += exists[k] > 0 ? step * slope[k] * phi[k] : 0;
    }
    for (int i = 0; i < 3; ++i) {
      const double *R = array(i), *N = array(3 + i), *T = array(6 + i);
      double *f = tile.field(Tile::fx + i), *t = tile.field(Tile::tx + i), *J = sums_.field(index, impulse_x + i);
#pragma omp simd
      for (int k = first; k < end; ++k) {
        const bool here = exists[k] > 0;
        const double inertia_share = free[k] > 0 ? m / (m + added_mass[k]) : 1;
        const double total = (f[k] + R[k] + N[k]) * phi[k] * inertia_share;  // m a
        J[k] += here ? step * (total - f[k] - N[k]) : 0;
        f[k] = here ? total : f[k];
        t[k] += here ? T[k] : 0;
      }
    }
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
