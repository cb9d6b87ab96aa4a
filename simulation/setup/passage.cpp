#include "simulation/setup/passage.hpp"

#include <algorithm>
#include <cmath>

#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

/// What is counted of the particles of one rag; contacts follow.
enum Count {
  upstream,
  out,
  left_mesh,
  discharge,
  outside_impeller,
  past_inside,
  past_outside,
  touching,
  touched = touching + n_contact_regions,
  n_counts = touched + n_contact_regions
};

bool is_beyond(const Vec3& x, const std::vector<Opening>& openings, bool is_outlet) {
  return std::any_of(openings.begin(), openings.end(),
                     [&](const Opening& opening) { return opening.is_outlet == is_outlet && opening.beyond(x) > 0; });
}

/// In a pump the walls that move are the impeller's.
WallRegion region_of(ContactRegion region) {
  switch (region) {
    case ContactRegion::moving:
      return WallRegion::impeller;
    case ContactRegion::tongue:
      return WallRegion::tongue;
    case ContactRegion::other:
      break;
  }
  return WallRegion::other;
}

void count_contacts(const ContactSolver& contacts, std::vector<std::int64_t>& counts) {
  const std::vector<WallTouch>& touches = contacts.wall_touches();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::size_t rag = i / n_contact_regions, region = i % n_contact_regions;
    counts[rag * n_counts + touching + region] = touches[i].now;
    counts[rag * n_counts + touched + region] = touches[i].since_reset;
  }
}

RagSnapshot sighting(const std::int64_t* counts, const RagState& state, const std::optional<PassageGeometry>& geometry) {
  RagSnapshot seen;
  seen.n = state.n_particles, seen.n_upstream = counts[upstream], seen.n_out = counts[out];
  seen.n_in_discharge = counts[discharge], seen.n_outside_impeller = counts[outside_impeller];
  seen.n_past_inside = counts[past_inside], seen.n_past_outside = counts[past_outside];
  for (int i = 0; i < n_contact_regions; ++i) {
    const WallRegion region = region_of(static_cast<ContactRegion>(i));
    seen.touching[region] = counts[touching + i], seen.touched[region] = counts[touched + i] > 0;
  }
  seen.tension = state.max_bond_tension, seen.tension_place = state.max_bond_tension_place;
  if (!geometry) return seen;
  seen.angle = geometry->angle(state.centre), seen.radius = geometry->radius(state.centre), seen.height = geometry->height(state.centre);
  seen.tension_angle = geometry->angle(state.max_bond_tension_place);
  return seen;
}

}  // namespace

Passage::Passage(MPI_Comm comm, std::vector<Opening> openings, std::optional<PassageGeometry> geometry, std::size_t n_rags)
    : comm_(comm),
      openings_(std::move(openings)),
      geometry_(std::move(geometry)),
      trackers_(n_rags, geometry_ ? PassageTracker(Passageway::pump, geometry_->sense(), geometry_->speed())
                                  : PassageTracker(Passageway::openings)),
      sightings_(n_rags),
      states_(n_rags),
      n_out_(n_rags),
      last_elongation_(n_rags) {}

void Passage::look_at(const Vec3& x, std::int64_t* counts) const {
  const bool has_left = is_beyond(x, openings_, true);
  if (has_left) ++counts[left_mesh];
  if (!geometry_) {
    if (has_left) ++counts[out];
    if (is_beyond(x, openings_, false)) ++counts[upstream];
    return;
  }
  const PlaceInPump place = geometry_->place_of(x);
  counts[upstream] += place.upstream, counts[out] += place.out, counts[discharge] += place.in_discharge;
  counts[outside_impeller] += place.outside_impeller;
  if (place.just_past_tongue) ++counts[place.in_discharge ? past_outside : past_inside];
}

void Passage::observe(RagSystem& rags, double time, double step) {
  std::vector<std::int64_t> counts(trackers_.size() * n_counts);
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int, int) { look_at(tile.vector(Tile::x, k), &counts[tile.rag * n_counts]); });
  if (rags.contacts()) count_contacts(*rags.contacts(), counts);
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM, comm_);
  states_ = rag_states(rags);
  for (std::size_t rag = 0; rag < trackers_.size(); ++rag) {
    n_out_[rag] = counts[rag * n_counts + left_mesh];
    sightings_[rag] = sighting(&counts[rag * n_counts], states_[rag], geometry_);
    trackers_[rag].add(sightings_[rag], time, step);
    if (states_[rag].n_particles > 0) last_elongation_[rag] = states_[rag].elongation_ratio;
  }
}

std::optional<double> Passage::all_exited_at() const {
  std::optional<double> last;
  for (const PassageTracker& rag : trackers_) {
    if (!rag.exited_at()) return {};
    last = std::max(last.value_or(0), *rag.exited_at());
  }
  return last;
}

/// [rag by rag: particles beyond an outlet, elongation ratio, length of the tracker's state, that state]
std::vector<double> Passage::state() const {
  std::vector<double> all;
  for (std::size_t rag = 0; rag < trackers_.size(); ++rag) {
    const std::vector<double> tracked = trackers_[rag].state();
    all.insert(all.end(), {static_cast<double>(n_out_[rag]), last_elongation_[rag], static_cast<double>(tracked.size())});
    all.insert(all.end(), tracked.begin(), tracked.end());
  }
  return all;
}

void Passage::restore(const std::vector<double>& state) {
  auto next = state.begin();
  for (std::size_t rag = 0; rag < trackers_.size(); ++rag) {
    n_out_[rag] = static_cast<std::int64_t>(*next++);
    last_elongation_[rag] = *next++;
    const auto length = static_cast<std::ptrdiff_t>(*next++);
    trackers_[rag].restore({next, next + length});
    next += length;
  }
}

}  // namespace snag
