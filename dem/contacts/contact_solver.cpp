#include "dem/contacts/contact_solver.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "base/words.hpp"
#include "dem/contacts/contact_list.hpp"
#include "dem/contacts/pair_forces.hpp"
#include "dem/contacts/wall_contacts.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

constexpr double rayleigh_fraction = 1.0 / 3;

double largest_radius(const std::vector<Rag>& rags) {
  double largest = 0;
  for (const Rag& rag : rags) largest = std::max(largest, rag.radius);
  return largest;
}

void check_rag(const Rag& rag) {
  const auto demand = [&](bool holds, const char* what, double value, const char* rule) {
    if (!holds)
      throw Error(ExitCode::usage,
                  "rag \"" + rag.name + "\": " + what + " = " + number_text(value) + ", contacts need " + rule + "; correct it");
  };
  demand(rag.radius > 0, "radius", rag.radius, "a positive one");
  demand(rag.mass > 0, "mass", rag.mass, "a positive one");
  demand(rag.inertia > 0, "inertia", rag.inertia, "a positive one");
  demand(rag.shear_modulus > 0, "shear_modulus", rag.shear_modulus, "a positive one");
  demand(rag.poisson_ratio > -1 && rag.poisson_ratio <= 0.5, "poisson_ratio", rag.poisson_ratio, "-1 < nu <= 0.5");
}

}  // namespace

struct ContactSolver::State {
  State(const ContactSettings& s, const std::vector<Rag>& r, const WallSet* w)
      : settings(s), rags(&r), skin(s.skin_over_radius * largest_radius(r)), particles(r), list(r, skin), forces(r, s) {
    if (w && !w->empty()) walls.emplace(r, s, *w);
    measures.max_wall_overlap_over_radius.assign(r.size(), 0);
    measures.beyond_walls.assign(r.size(), 0);
  }

  void update_lists(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, const Box* moved);
  void evaluate(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved, bool with_held);
  void add_wall_forces(double step, std::vector<HeldParticle>* to);
  void sort_slips();

  ContactSettings settings;
  const std::vector<Rag>* rags;
  double skin = 0, time = 0;
  bool unpacked = false;  // something waits to be put into the lists
  bool outdated = false;  // other particles exist
  ContactParticles particles;
  ContactList list;
  PairForces forces;
  std::optional<WallContacts> walls;
  ContactMeasures measures;
  std::vector<HeldParticle> held;  // [particles], while it is asked for
  std::vector<WallTouch> no_touches;

  // The touching pairs by their lower and by their higher id, made when the first tile is packed after a step.
  bool slips_sorted = false;
  std::vector<StoredSlip> by_low, by_high;
};

ContactSolver::ContactSolver(const ContactSettings& settings, const std::vector<Rag>& rags, const WallSet* walls) {
  for (const Rag& rag : rags) check_rag(rag);
  state_ = std::make_unique<State>(settings, rags, walls);
}
ContactSolver::~ContactSolver() = default;
ContactSolver::ContactSolver(ContactSolver&&) noexcept = default;
ContactSolver& ContactSolver::operator=(ContactSolver&&) noexcept = default;

void ContactSolver::renew_lists() { state_->outdated = true; }
void ContactSolver::set_time(double time) { state_->time = time; }

void ContactSolver::State::update_lists(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, const Box* moved) {
  const bool same_tiles = particles.holds(owned, ghosts);
  if (same_tiles && !unpacked && !outdated && !particles.bonds_changed() && particles.keeps_distances(0.5 * skin, moved)) {
    if (walls && walls->due(time, particles.path())) walls->list(particles, time), particles.reset_path();
    return;
  }
  list.store(list.touching(particles));
  if (!same_tiles) particles.assign(owned, ghosts);
  particles.mark_positions();
  list.build(particles, {.within_pieces = settings.self_contact, .between_pieces = settings.mutual_contact});
  if (walls && unpacked) walls->sort_unpacked();
  if (walls) walls->list(particles, time);
  particles.reset_path();
  unpacked = outdated = false;
  measures.n_not_finite = particles.n_not_finite;
  ++measures.n_lists;
}

void ContactSolver::add_forces(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step) {
  evaluate(owned, ghosts, step);
  for (std::size_t i = 0; i < owned.size(); ++i) add_to_tile(i);
}

void ContactSolver::add_to_tile(std::size_t i) const { state_->particles.add_loads(i); }

void ContactSolver::evaluate(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved) {
  state_->evaluate(owned, ghosts, step, moved, false);
}

double ContactSolver::evaluate_with_limit(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved,
                                          std::span<const StepRates> of_rag, double largest) {
  State& s = *state_;
  s.evaluate(owned, ghosts, step, moved, true);
  double limit = largest;
  for (const ParticleRow& row : s.particles.rows) {
    if (!row.owned || (!row.near && !row.at_wall)) continue;
    for (int i = row.first; i < row.first + row.count; ++i) {
      const HeldParticle& particle = s.held[i];
      if (!particle.is_held()) continue;  // near others or a wall: what the bonds alone allow is known better
      const StepRates& others = of_rag[row.tile->rag];
      if ((others + particle.coarse_rates()).step() < limit) limit = std::min(limit, (others + particle.rates()).step());
    }
  }
  return limit;
}

void ContactSolver::State::evaluate(std::span<Tile* const> owned, std::span<const Tile* const> ghosts, double step, const Box* moved,
                                    bool with_held) {
  update_lists(owned, ghosts, moved);
  if (with_held) held.assign(particles.size(), {});
  std::vector<HeldParticle>* const to = with_held ? &held : nullptr;
  slips_sorted = false;
  measures.n_contacts = 0;
  particles.clear_loads();
  if (!list.pairs.empty()) {
    particles.gather();
    const PairMeasures pairs = forces.add(particles, list, step, to);
    measures.n_contacts = pairs.n_contacts;
    measures.max_overlap_over_radius = std::max(measures.max_overlap_over_radius, pairs.max_overlap_over_radius);
  }
  if (walls) add_wall_forces(step, to);
  time += step;
}

void ContactSolver::State::add_wall_forces(double step, std::vector<HeldParticle>* to) {
  walls->add(particles, time, step, to);
  measures.n_wall_contacts = walls->n_contacts;
  measures.max_wall_overlap_over_radius = walls->max_overlap_over_radius;
  measures.beyond_walls.assign(rags->size(), 0);
  auto row = particles.rows.begin();
  for (const std::int64_t id : walls->beyond) {
    while (id >= row->id + row->count) ++row;
    ++measures.beyond_walls[row->tile->rag];
  }
}

double ContactSolver::cutoff() const { return state_->list.cutoff(); }
double ContactSolver::skin() const { return state_->skin; }

namespace {

struct StepLimit {
  double step = infinity;
  std::string reason = "no contact";
  void lower(double limit, const std::string& why) {
    if (limit < step) step = limit, reason = why;
  }
};

StepLimit step_limit(const std::vector<Rag>& rags, const std::vector<ContactPair>& pairs, const std::vector<ContactPair>& walls,
                     double speed) {
  StepLimit limit;
  for (const Rag& rag : rags)
    limit.lower(rayleigh_fraction * rayleigh_time(rag), "Rayleigh time of the particles of rag \"" + rag.name + "\"");
  const std::string impact = " at impact_speed = " + number_text(speed) + " m/s";
  for (const ContactPair& pair : pairs)
    limit.lower(pair.law->stable_step(speed),
                "contact of particles of radius " + number_text(std::min(pair.radius_1, pair.radius_2)) + " m" + impact);
  for (std::size_t i = 0; i < walls.size(); ++i)
    limit.lower(walls[i].law->stable_step(speed), "contact of rag \"" + rags[i].name + "\" with a wall" + impact);
  return limit;
}

}  // namespace

double ContactSolver::stable_step() const {
  const State& s = *state_;
  return step_limit(*s.rags, s.forces.pairs(), s.walls ? s.walls->pairs : std::vector<ContactPair>{}, s.settings.impact_speed).step;
}

std::string ContactSolver::stable_step_reason() const {
  const State& s = *state_;
  return step_limit(*s.rags, s.forces.pairs(), s.walls ? s.walls->pairs : std::vector<ContactPair>{}, s.settings.impact_speed).reason;
}

namespace {

bool before_by_high(const StoredSlip& a, const StoredSlip& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }

/// Calls visit(first id, end of ids) for each row of a tile.
template <class Visit>
void for_rows(const Tile& tile, const Rag& rag, const Visit& visit) {
  for (int j = 0; j < tile.ny; ++j) {
    const std::int64_t first = rag.first_particle + std::int64_t(tile.row + j) * rag.n_columns + tile.column;
    visit(first, first + tile.nx);
  }
}

constexpr std::size_t pair_length = 5, wall_length = 8;  // doubles of a packed slip; ids are exact as doubles up to 2^53

}  // namespace

void ContactSolver::State::sort_slips() {
  if (slips_sorted) return;
  by_low = list.touching(particles);
  by_low.insert(by_low.end(), list.stored().begin(), list.stored().end());  // unpacked, not yet in the list
  std::sort(by_low.begin(), by_low.end());
  by_low.erase(std::unique(by_low.begin(), by_low.end(), [](const StoredSlip& a, const StoredSlip& b) { return !(a < b) && !(b < a); }),
               by_low.end());
  by_high = by_low;
  if (walls && unpacked) walls->sort_unpacked();
  std::sort(by_high.begin(), by_high.end(), before_by_high);
  slips_sorted = true;
}

/// [number of pairs, of walls, of particles beyond walls, (low id, high id, slip) ..., (id, wall, normal, slip) ..., id ...]
std::vector<double> ContactSolver::pack(const Tile& tile) const {
  State& s = *state_;
  s.sort_slips();
  std::vector<double> pairs, walls, beyond;
  const auto put_pair = [&pairs](const StoredSlip& c) {
    pairs.insert(pairs.end(), {double(c.low), double(c.high), c.slip.x, c.slip.y, c.slip.z});
  };
  for_rows(tile, (*s.rags)[tile.rag], [&](std::int64_t first, std::int64_t end) {
    for (auto c = std::lower_bound(s.by_low.begin(), s.by_low.end(), StoredSlip{first, 0, {}}); c != s.by_low.end() && c->low < end; ++c)
      put_pair(*c);
    for (auto c = std::lower_bound(s.by_high.begin(), s.by_high.end(), StoredSlip{0, first, {}}, before_by_high);
         c != s.by_high.end() && c->high < end; ++c)
      if (c->low < first || c->low >= end) put_pair(*c);
    if (!s.walls) return;
    const auto earlier = [](const WallSlip& c, std::int64_t id) { return c.id < id; };
    for (auto c = std::lower_bound(s.walls->slips.begin(), s.walls->slips.end(), first, earlier); c != s.walls->slips.end() && c->id < end;
         ++c)
      walls.insert(walls.end(), {double(c->id), double(c->body), c->normal.x, c->normal.y, c->normal.z, c->slip.x, c->slip.y, c->slip.z});
    for (auto id = std::lower_bound(s.walls->beyond.begin(), s.walls->beyond.end(), first); id != s.walls->beyond.end() && *id < end; ++id)
      beyond.push_back(double(*id));
  });
  const std::size_t n_pairs = pairs.size() / pair_length, n_walls = walls.size() / wall_length;
  std::vector<double> all{double(n_pairs), double(n_walls), double(beyond.size())};
  for (const auto* part : {&pairs, &walls, &beyond}) all.insert(all.end(), part->begin(), part->end());
  return all;
}

void ContactSolver::unpack(const Tile& tile, std::span<const double> values) {
  State& s = *state_;
  const std::size_t n_pairs = values.size() < 3 ? 0 : std::size_t(values[0]), n_walls = values.size() < 3 ? 0 : std::size_t(values[1]);
  if (values.size() < 3 || values.size() != 3 + pair_length * n_pairs + wall_length * n_walls + std::size_t(values[2]))
    throw Error(ExitCode::invariant, "contact history of a tile of rag \"" + (*s.rags)[tile.rag].name +
                                         "\": " + std::to_string(values.size()) +
                                         " numbers, not as many as were packed; the message or checkpoint is damaged");
  std::vector<StoredSlip> pairs;
  const double* v = values.data() + 3;
  for (std::size_t i = 0; i < n_pairs; ++i, v += pair_length) pairs.push_back({std::int64_t(v[0]), std::int64_t(v[1]), {v[2], v[3], v[4]}});
  s.list.store(pairs);
  s.unpacked = true, s.slips_sorted = false;
  if (!s.walls) return;
  for (std::size_t i = 0; i < n_walls; ++i, v += wall_length)
    s.walls->slips.push_back({std::int64_t(v[0]), int(v[1]), {v[2], v[3], v[4]}, {v[5], v[6], v[7]}});
  for (; v < values.data() + values.size(); ++v) s.walls->beyond.push_back(std::int64_t(*v));
}

const ContactMeasures& ContactSolver::measures() const { return state_->measures; }
const std::vector<WallTouch>& ContactSolver::wall_touches() const { return state_->walls ? state_->walls->touched : state_->no_touches; }

std::vector<WallLoad> ContactSolver::wall_loads(MPI_Comm comm) const {
  const State& s = *state_;
  return s.walls ? mean_loads(comm, s.walls->impulses, s.walls->duration) : std::vector<WallLoad>{};
}

void ContactSolver::start_wall_loads() {
  if (state_->walls) state_->walls->start_loads();
}

void ContactSolver::set_tongue(const TongueLine& tongue) {
  if (state_->walls) state_->walls->tongue = tongue;
}

std::vector<Vec3> ContactSolver::forces(std::span<const Tile> tiles) const {
  const State& s = *state_;
  std::map<const Tile*, std::vector<Vec3>> at_place;
  for (const Tile& tile : tiles) at_place[&tile].resize(tile.exists.size());
  for (const ParticleRow& row : s.particles.rows) {
    const auto found = at_place.find(row.tile);
    if (!(row.near || row.at_wall) || found == at_place.end()) continue;
    for (int i = 0; i < row.count; ++i) {
      const ParticleLoad& load = s.particles.load[row.first + i];
      found->second[row.place + i] = {load.fx, load.fy, load.fz};
    }
  }
  std::vector<Vec3> all;
  for (const Tile& tile : tiles) for_particles(tile, [&](int k, int, int) { all.push_back(at_place[&tile][k]); });
  return all;
}

void ContactSolver::reset_measures() {
  State& s = *state_;
  s.measures.max_overlap_over_radius = 0;
  std::fill(s.measures.max_wall_overlap_over_radius.begin(), s.measures.max_wall_overlap_over_radius.end(), 0.0);
  if (!s.walls) return;
  std::fill(s.walls->max_overlap_over_radius.begin(), s.walls->max_overlap_over_radius.end(), 0.0);
  for (WallTouch& touch : s.walls->touched) touch.since_reset = 0;
}

}  // namespace snag
