#include "coupling/fluid_load.hpp"

#include <algorithm>
#include <tuple>

#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {
enum Sum { impulse_x, impulse_y, impulse_z, slope_integral, screen_integral, unfelt_x, unfelt_y, unfelt_z, n_sums };
enum Array {
  two_way_force = 0,
  slope_sum = 3,
  one_way_force = 4,
  added_mass_sum = 7,
  torque_sum = 8,
  torque_slope_sum = 11,
  relaxation = 12,
  seen_velocity = 13,
  wall_distance = 16,
  wall_normal = 17,
  zero = 20,
  chi = 21,
  rate_on_way = 22,
  seen_acceleration = 25,
  relief_sum = 28,
  step_impulse = 29,
  slip_growth = 32,
  screen_now = 33,
  unfelt_force = 34,
  n_arrays = 37
};

/// A force of the water that does not react on it.
bool is_unfelt(const ForceDescription& description) { return !description.reacts_on_fluid && description.role != Role::weight; }

/// Mean of the relaxation over a sub-step.
inline double mean_relaxation(double theta) { return (1 + theta / 6) / (1 + theta * (2.0 / 3 + theta / 6)); }
}  // namespace

FluidLoad::FluidLoad(const FluidForces& forces, FluidField& field, const std::vector<Rag>& rags) : field_(field), rags_(rags) {
  std::vector<std::pair<ForceDescription, const FluidForce*>> descriptions;
  for (const auto& force : forces) descriptions.emplace_back(force->description(), force.get());
  std::sort(descriptions.begin(), descriptions.end(),
            [](const auto& a, const auto& b) { return std::tie(a.first.role, a.first.name) < std::tie(b.first.role, b.first.name); });
  for (const auto& [description, force] : descriptions) {
    needed_ = needed_ | description.samples;
    forces_.push_back({force, description.reacts_on_fluid, is_unfelt(description), description.role, n_particle_state_});
    n_particle_state_ += description.n_particle_state;
    changes_fluid_ = changes_fluid_ || description.role == Role::fluid;
    all_react_ = all_react_ && description.reacts_on_fluid;
    unfelt_ = unfelt_ || is_unfelt(description);
    torque_ = torque_ || description.gives_torque, added_mass_ = added_mass_ || description.gives_added_mass;
    screen_ = screen_ || description.gives_screen;
    needs_impulse_ = needs_impulse_ || description.needs_impulse, needs_drag_ = needs_drag_ || description.needs_drag;
  }
  impulse_begin_ = n_particle_state_;
  if (needs_impulse_) n_particle_state_ += 3;
  drag_begin_ = n_particle_state_;
  if (needs_drag_) n_particle_state_ += 1;
  if (field.answers()) {
    missed_rate_begin_ = n_particle_state_, step_impulse_begin_ = n_particle_state_ + 3;
    n_particle_state_ += 6;
  }
}

void FluidLoad::set_walls(const WallSet& walls) {
  if (needed_.wall) nearest_wall_.emplace(walls, rags_);
}

void FluidLoad::begin_step(std::span<const Tile> tiles, double time) {
  time_ = time;
  field_.sample(tiles, needed_);
  elapsed_.assign(tiles.size(), 0.0);
  sums_.reset(tiles, n_sums);
  std::size_t largest = 0;
  for (const Tile& tile : tiles) largest = std::max(largest, tile.exists.size());
  if (largest != scratch_size_) scratch_size_ = largest, scratch_.assign(n_arrays * largest, 0.0);
}

void FluidLoad::end_step(std::span<Tile> tiles, std::span<const Vec3> missed_rates) {
  const ParticleList particles(tiles);
  for (std::size_t b = 0; b < particles.size(); ++b) {
    const int t = particles.tile(b), k = particles.place(b);
    for (int i = 0; i < 3; ++i) {
      state(tiles[t], missed_rate_begin_ + i)[k] = missed_rates[b][i];
      state(tiles[t], step_impulse_begin_ + i)[k] = impulse(t, k)[i];
    }
  }
}

void FluidLoad::add(std::size_t index, Tile& tile, double step) {
  const Rag& rag = rags_[tile.rag];
  const FluidSamples fluid = evaluate(index, tile, step);
  elapsed_[index] += step;

  const double m = rag.mass;
  const double *exists = tile.exists.data(), *free = tile.free.data(), *slope = array(slope_sum), *added_mass = array(added_mass_sum);
  const double *none = array(zero), *d = fluid.response ? fluid.response : none, *relief = array(relief_sum);
  const double* rate[] = {fluid.velocity_rate.x, fluid.velocity_rate.y, fluid.velocity_rate.z};
  double *phi = array(relaxation), *driven = array(chi), *slopes = sums_.field(index, slope_integral);
  for (int j = 0; j < tile.ny; ++j) {
    const int first = tile.index(0, j), end = first + tile.nx;
#pragma omp simd
    for (int k = first; k < end; ++k) {
      const double hK = step * slope[k], theta = hK * ((free[k] > 0.5 ? 1 / (m + added_mass[k]) : 0) + d[k] + relief[k]);
      const double over = 1 / (1 + theta * (2.0 / 3 + theta / 6));
      phi[k] = (1 + theta / 6) * over;
      driven[k] = hK * (0.5 + theta / 6) * over;
      slopes[k] += exists[k] * hK;
    }
    for (int i = 0; i < 3; ++i) {
      const double *R = array(two_way_force + i), *N = array(one_way_force + i), *U = array(unfelt_force + i), *r = rate[i];
      double *f = tile.field(Tile::fx + i), *J = sums_.field(index, impulse_x + i);
      double* of_step = needs_impulse_ ? last_impulse(tile, i) : array(step_impulse + i);
      const double* change = tile.held_change.empty() ? none : tile.held_change.data() + static_cast<std::size_t>(i) * tile.exists.size();
#pragma omp simd
      for (int k = first; k < end; ++k) {
        const double other = f[k] + N[k] + U[k], M = m + added_mass[k];
        const double mean = phi[k] * R[k] + driven[k] * (r[k] - (free[k] > 0.5 ? other / M : 0));
        const double total =
            free[k] > 0.5 ? (other + mean) * (m / M) : other + mean - added_mass[k] * change[k] / step;  // m a, or of a hold
        of_step[k] = exists[k] > 0 ? step * (total - other) : 0;
        J[k] += of_step[k];
        f[k] = exists[k] > 0 ? total : f[k];
      }
      if (!unfelt_) continue;
      double* unfelt = sums_.field(index, unfelt_x + i);
#pragma omp simd
      for (int k = first; k < end; ++k) unfelt[k] += exists[k] * step * U[k];
    }
  }
  if (torque_) add_torque(tile, step);
  if (screen_) {
    const double* screen = array(screen_now);
    double* sum = sums_.field(index, screen_integral);
    for_particles(tile, [&](int k, int, int) { sum[k] += step * screen[k]; });
  }
}

/// All forces on the particles of a tile.
FluidSamples FluidLoad::evaluate(std::size_t index, Tile& tile, double step) {
  Particles particles(rags_[tile.rag], tile);
  particles.step = step;
  particles.state_stride = tile.exists.size();
  if (n_particle_state_ > 0 && tile.particle_state.empty()) tile.particle_state.assign(n_particle_state_ * tile.exists.size(), 0.0);
  const auto clear = [&](int f, int count) {
    for (int i = f; i < f + count; ++i) std::fill(array(i) + particles.begin, array(i) + particles.end, 0.0);
  };
  clear(two_way_force, 4);  // with the slope
  if (!all_react_) clear(one_way_force, 3);
  if (unfelt_) clear(unfelt_force, 3);
  if (added_mass_) clear(added_mass_sum, 1);
  if (needs_impulse_) clear(relief_sum, 1);
  if (screen_) clear(screen_now, 1);
  if (torque_) clear(torque_sum, 4);  // with the slope
  const auto vector = [&](int f) { return VectorSum{array(f), array(f + 1), array(f + 2)}; };
  Forces reacting{vector(two_way_force), vector(torque_sum), array(slope_sum), array(added_mass_sum), array(torque_slope_sum)};
  reacting.relief = array(relief_sum);
  if (screen_) reacting.screen = array(screen_now);
  if (needs_impulse_) particles.last_impulse = {last_impulse(tile, 0), last_impulse(tile, 1), last_impulse(tile, 2)};
  if (needs_drag_) particles.last_drag = state(tile, drag_begin_);
  Forces silent = reacting, unfelt = reacting;
  silent.force = vector(one_way_force), unfelt.force = vector(unfelt_force);
  // The integrator evaluates forces where the particles are in the middle of the sub-step, with their velocities at its start.
  FluidSamples fluid = field_.at(index, tile, elapsed_[index], step);
  if (fluid.start.x) follow(fluid, index, tile, particles);
  if (changes_fluid_) {
    if (fluid.velocity.x != array(seen_velocity))
      for (int i = 0; i < 3; ++i) {
        const double* u[] = {fluid.velocity.x, fluid.velocity.y, fluid.velocity.z};
        std::copy(u[i] + particles.begin, u[i] + particles.end, array(seen_velocity + i) + particles.begin);
      }
    std::fill(array(slip_growth) + particles.begin, array(slip_growth) + particles.end, 1.0);
    reacting.fluid_velocity = vector(seen_velocity), reacting.slip_growth = array(slip_growth);
    fluid.velocity = {array(seen_velocity), array(seen_velocity + 1), array(seen_velocity + 2)};
  }
  if (needed_.wall) {
    if (nearest_wall_)
      nearest_wall_->find(particles, time_ + elapsed_[index] + 0.5 * step, array(wall_distance), vector(wall_normal));
    else
      std::fill(array(wall_distance) + particles.begin, array(wall_distance) + particles.end, 1e9);
    fluid.wall_distance = array(wall_distance);
    fluid.wall_normal = {array(wall_normal), array(wall_normal + 1), array(wall_normal + 2)};
  }
  const auto act = [&](bool drag) {
    for (const Member& member : forces_) {
      if ((member.role < Role::force) != drag) continue;
      particles.state = tile.particle_state.data() + member.state_begin * particles.state_stride;
      member.force->add(fluid, particles, member.reacts ? reacting : member.is_unfelt ? unfelt : silent);
    }
  };
  act(true);
  if (needs_drag_) keep_drag(tile, fluid, particles);
  act(false);
  if (changes_fluid_) {
    double* slope = array(slope_sum);
    const double* growth = array(slip_growth);
#pragma omp simd
    for (int k = particles.begin; k < particles.end; ++k) slope[k] *= growth[k];
  }
  return fluid;
}

/// |F|/|w| of the drag, for the next sub-step.
void FluidLoad::keep_drag(Tile& tile, const FluidSamples& fluid, const Particles& particles) {
  double* drag = state(tile, drag_begin_);
  const double *slope = array(slope_sum), *fx = array(two_way_force), *fy = array(two_way_force + 1), *fz = array(two_way_force + 2);
  const VectorArray u = fluid.velocity, v = particles.velocity;
#pragma omp simd
  for (int k = particles.begin; k < particles.end; ++k) {
    const double slip = norm_squared(u[k] - v[k]), force = norm_squared(Vec3{fx[k], fy[k], fz[k]});
    drag[k] = slip > 0 ? std::sqrt(force / slip) : slope[k];
  }
}

/// The water on the way of the particles at the start of the sub-step, the time of their velocities: u + c t + G (x - h/2 v - x_0) - d J,
/// its rate r = c + G v without the answer, and Du/Dt in the middle of the sub-step, where that water has u + h/2 r. c: of the water
/// itself, of what the last answers were missed by and of what is left of the answer to the last impulse.
void FluidLoad::follow(FluidSamples& fluid, std::size_t index, Tile& tile, const Particles& particles) {
  const auto component = [](const VectorArray& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; };
  const double elapsed = elapsed_[index], half = 0.5 * particles.step, *d = fluid.response ? fluid.response : array(zero);
  const VectorArray x = particles.position, x_0 = fluid.start, v = particles.velocity;
  for (int i = 0; i < 3; ++i) {
    const double *u = component(fluid.velocity, i), *c = component(fluid.velocity_rate, i), *J = sums_.field(index, impulse_x + i);
    const bool answers = missed_rate_begin_ >= 0;
    const double *e = answers ? state(tile, missed_rate_begin_ + i) : array(zero), left = fluid.response_left;
    const double* last = answers ? state(tile, step_impulse_begin_ + i) : array(zero);
    const VectorArray G = fluid.velocity_gradient[i];
    double *seen = array(seen_velocity + i), *rate = array(rate_on_way + i);
#pragma omp simd
    for (int k = particles.begin; k < particles.end; ++k) {
      const double of_water = c[k] + e[k] + left * d[k] * last[k];
      seen[k] = u[k] + elapsed * of_water + dot(G[k], x[k] - half * v[k] - x_0[k]) - d[k] * J[k];
      rate[k] = of_water + dot(G[k], v[k]);
    }
  }
  const auto vector = [&](int f) { return VectorArray{array(f), array(f + 1), array(f + 2)}; };
  if (needed_.material_acceleration) {
    const VectorArray u = fluid.velocity, seen = vector(seen_velocity), rate = vector(rate_on_way);
    for (int i = 0; i < 3; ++i) {
      const double* at_start = component(fluid.material_acceleration, i);
      const VectorArray G = fluid.velocity_gradient[i];
      double* a = array(seen_acceleration + i);
#pragma omp simd
      for (int k = particles.begin; k < particles.end; ++k) a[k] = at_start[k] + dot(G[k], seen[k] + half * rate[k] - u[k]);
    }
    fluid.material_acceleration = vector(seen_acceleration);
  }
  fluid.velocity = vector(seen_velocity), fluid.velocity_rate = vector(rate_on_way);
}

void FluidLoad::add_torque(Tile& tile, double step) {
  const double over_inertia = step / rags_[tile.rag].inertia;
  const double *exists = tile.exists.data(), *free = tile.free.data(), *slope = array(torque_slope_sum);
  for (int j = 0; j < tile.ny; ++j)
    for (int i = 0; i < 3; ++i) {
      const double* T = array(torque_sum + i);
      double* t = tile.field(Tile::tx + i);
#pragma omp simd
      for (int k = tile.index(0, j); k < tile.index(tile.nx, j); ++k) {
        const double phi = free[k] > 0 ? mean_relaxation(over_inertia * slope[k]) : 1;
        t[k] = exists[k] > 0 ? (t[k] + T[k]) * phi : t[k];
      }
    }
}

Vec3 FluidLoad::impulse(std::size_t index, int k) const {
  return {sums_.field(index, impulse_x)[k], sums_.field(index, impulse_y)[k], sums_.field(index, impulse_z)[k]};
}

double FluidLoad::slope(std::size_t index, int k) const { return sums_.field(index, slope_integral)[k]; }

double FluidLoad::screen(std::size_t index, int k) const { return sums_.field(index, screen_integral)[k] / elapsed_[index]; }

std::vector<Vec3> FluidLoad::impulses(std::span<const Tile> tiles) const {
  const ParticleList particles(tiles);
  std::vector<Vec3> all(particles.size());
  for (std::size_t b = 0; b < all.size(); ++b) all[b] = impulse(particles.tile(b), particles.place(b));
  return all;
}

std::vector<Vec3> FluidLoad::given(std::span<const Tile> tiles, const TimeScheme& time) const {
  const ParticleList particles(tiles);
  std::vector<Vec3> all = impulses(tiles);
  for (std::size_t b = 0; b < all.size(); ++b) {
    const Tile& tile = tiles[particles.tile(b)];
    if (tile.particle_state.empty()) continue;
    const double* last = tile.particle_state.data() + step_impulse_begin_ * tile.exists.size() + particles.place(b);
    const std::size_t stride = tile.exists.size();
    all[b] = time.now * all[b] - time.older * Vec3{last[0], last[stride], last[2 * stride]};
  }
  return all;
}

std::vector<Vec3> FluidLoad::impulses_with_unfelt(std::span<const Tile> tiles) const {
  std::vector<Vec3> all = impulses(tiles);
  const ParticleList particles(tiles);
  for (std::size_t b = 0; b < all.size() && unfelt_; ++b) {
    const auto of = [&](int f) { return sums_.field(particles.tile(b), f)[particles.place(b)]; };
    all[b] += {of(unfelt_x), of(unfelt_y), of(unfelt_z)};
  }
  return all;
}

double FluidLoad::max_stiffness(std::span<const Tile> tiles) const {
  double largest = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const double* Q = sums_.field(t, slope_integral);
    largest = std::max(largest, *std::max_element(Q, Q + tiles[t].exists.size()) / rags_[tiles[t].rag].mass);
  }
  return largest;
}

}  // namespace snag
