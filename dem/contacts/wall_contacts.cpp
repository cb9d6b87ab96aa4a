// A particle with centre x, at distance s of a wall with direction e (unit, into the fluid):
//
//   overlap = min(r - s, 2 r),  n = -e,  contact point c = x - s e
//   u = v + w x s n - u_wall(c),  force F on the particle by the law, torque s n x F + M,  -F on the wall
//
// The slip is kept in the frame of the wall: so it turns with a turning wall. Laws are evaluated in blocks of contacts, so that they
// vectorise; loads are added in the order of the contacts.
#include "dem/contacts/wall_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace snag {

namespace {
// How far a moving wall may come, and a particle may go, before the list is made anew: longer lists against rarer ones.
constexpr double allowance_over_radius = 4, path_over_radius = 1;
}  // namespace

struct WallContacts::Block : ContactBlock {
  struct Place {
    int particle, body, part;
    std::int64_t id;
    Vec3 direction;  // frame of the wall
    Vec3 point;      // of the contact, m
    Vec3 arm;        // from the particle to it, m
  };
  const ContactPair* pair = nullptr;
  Place place[contact_block_size];
};

WallContacts::~WallContacts() = default;
WallContacts::WallContacts(WallContacts&&) noexcept = default;

WallContacts::WallContacts(const std::vector<Rag>& rags, const ContactSettings& settings, const WallSet& walls)
    : rags_(&rags), walls_(&walls), block_(std::make_unique<Block>()) {
  for (const Rag& rag : rags) {
    largest_radius_ = std::max(largest_radius_, rag.radius);
    pairs.push_back(wall_pair(rag, settings));
  }
  for (const WallBody& body : walls.bodies()) {
    surfaces_.push_back(body.triangles.empty() ? TriangleSurface() : TriangleSurface(body.triangles, reach(body).near, reach(body).far));
    fastest_.push_back(fastest(body));
    axes_.push_back(unit(body.motion.axis));
  }
  poses_.resize(walls.bodies().size());
  max_overlap_over_radius.assign(rags.size(), 0);
  touched.assign(rags.size() * n_contact_regions, {});
  start_loads();
}

void WallContacts::start_loads() {
  impulses.assign(walls_->parts().size(), {});
  duration = 0;
}

WallContacts::Reach WallContacts::reach(const WallBody& body) const {
  return {largest_radius_, (1 + path_over_radius + (body.motion.moves() ? allowance_over_radius : 0)) * largest_radius_};
}

double WallContacts::fastest(const WallBody& body) const {
  const Vec3 axis = unit(body.motion.axis);
  double arm = 0;
  for (const WallTriangle& t : body.triangles)
    for (const Vec3& x : t.node) arm = std::max(arm, norm(cross(axis, x - body.motion.origin)));
  return norm(body.motion.velocity) + std::abs(body.motion.speed) * (arm + reach(body).far);
}

bool WallContacts::due(double time, double path) const {
  if (path > path_over_radius * largest_radius_) return true;
  for (std::size_t b = 0; b < fastest_.size(); ++b)
    if (!walls_->bodies()[b].triangles.empty() && fastest_[b] * std::abs(time - listed_) > allowance_over_radius * largest_radius_)
      return true;
  return false;
}

bool WallContacts::near(std::size_t b, const Vec3& x, double radius) const {
  const WallBody& body = walls_->bodies()[b];
  if (!body.planes.empty() && body.motion.moves()) return true;  // planes have no end: a turning one has no greatest speed
  for (const WallPlane& plane : body.planes)
    if (dot(x - plane.point, plane.normal) < radius + path_over_radius * largest_radius_) return true;
  return !body.triangles.empty() && surfaces_[b].may_be_near(body.motion.moves() ? poses_[b].in_wall(x) : x);
}

void WallContacts::list(ContactParticles& particles, double time) {
  listed_ = time;
  candidates_.clear();
  for (std::size_t b = 0; b < poses_.size(); ++b) poses_[b] = wall_pose(walls_->bodies()[b].motion, time);
  for (ParticleRow& row : particles.rows) {
    row.at_wall = false;
    if (!row.owned) continue;
    const std::size_t before = candidates_.size();
    for (int i = 0; i < row.count; ++i) {
      if (!particles.present[row.first + i]) continue;
      const Vec3 x = row.tile->vector(Tile::x, row.place + i);
      for (std::size_t b = 0; b < poses_.size(); ++b)
        if (near(b, x, (*rags_)[row.tile->rag].wall_reach())) candidates_.push_back({row.first + i, static_cast<int>(b)});
    }
    row.at_wall = candidates_.size() > before;
  }
}

void WallContacts::sort_unpacked() {
  std::stable_sort(slips.begin(), slips.end(), [](const WallSlip& a, const WallSlip& b) { return a.id < b.id; });
  slips.erase(std::unique(slips.begin(), slips.end()), slips.end());
  std::sort(beyond.begin(), beyond.end());
  beyond.erase(std::unique(beyond.begin(), beyond.end()), beyond.end());
}

void WallContacts::add(ContactParticles& particles, double time, double step, std::vector<HeldParticle>* held) {
  step_ = step, held_ = held, n_contacts = 0, duration += step;
  for (std::size_t b = 0; b < poses_.size(); ++b) poses_[b] = wall_pose(walls_->bodies()[b].motion, time);
  for (WallTouch& touch : touched) touch.now = 0;
  block_->n = 0, block_->pair = nullptr;
  old_slips_.swap(slips), slips.clear();
  old_beyond_.swap(beyond), beyond.clear();
  old_end_ = 0;
  std::size_t next_beyond = 0;
  for (std::size_t i = 0; i < candidates_.size();) {
    const Particle p = particle(particles, candidates_[i].particle);
    touches_.clear();
    for (; i < candidates_.size() && candidates_[i].particle == p.number; ++i) find_touches(p, candidates_[i].body);
    keep_beyond(particles, p.id, next_beyond);
    note_beyond(p, next_beyond);
    if (touches_.empty()) continue;
    old_begin_ = old_end_;
    while (old_begin_ < old_slips_.size() && old_slips_[old_begin_].id < p.id) ++old_begin_;
    old_end_ = old_begin_;
    while (old_end_ < old_slips_.size() && old_slips_[old_end_].id == p.id) ++old_end_;
    used_.assign(old_end_ - old_begin_, 0);
    select_touches();
    for (const Touch& touch : acting_) put(particles, p, touch);
    count_touches(p);
  }
  evaluate(particles);
  keep_beyond(particles, std::numeric_limits<std::int64_t>::max(), next_beyond);
}

WallContacts::Particle WallContacts::particle(const ContactParticles& particles, int number) const {
  const ParticleRow& row = particles.rows[particles.row_of[number]];
  const int k = row.place + number - row.first;
  const Tile& tile = *row.tile;
  return {number, tile.rag, row.id + number - row.first, tile.vector(Tile::x, k), tile.vector(Tile::vx, k), tile.vector(Tile::wx, k)};
}

void WallContacts::find_touches(const Particle& p, int b) {
  const WallBody& body = walls_->bodies()[b];
  const bool moves = body.motion.moves();
  const Vec3 X = moves ? poses_[b].in_wall(p.x) : p.x;
  const double radius = (*rags_)[p.rag].wall_reach();
  for (std::size_t k = 0; k < body.planes.size(); ++k) {
    const WallPlane& plane = body.planes[k];
    const double s = dot(X - plane.point, plane.normal);
    if (s < radius) touches_.push_back({s, moves ? poses_[b].turned(plane.normal) : plane.normal, b, static_cast<int>(k)});
  }
  if (body.triangles.empty()) return;
  for (int t : surfaces_[b].near(X)) {
    if (!surfaces_[b].within(t, X, radius)) continue;
    const TriangleDistance seen = surfaces_[b].distance(t, X);
    if (!(std::abs(seen.distance) < radius)) continue;
    Touch& touch = touches_.emplace_back();
    touch.distance = seen.distance, touch.feature = seen.feature, touch.node = seen.node;
    touch.direction = moves ? poses_[b].turned(seen.direction) : seen.direction;
    touch.body = b, touch.triangle = t;
  }
}

/// True if an edge or corner belongs to a nearer triangle, or the direction is nearly that of a contact that acts.
bool WallContacts::repeats(const Touch& touch, std::size_t before) const {
  if (touch.feature != TriangleFeature::face) {
    for (std::size_t i = 0; i < before; ++i) {
      if (touches_[i].body != touch.body || walls_->bodies()[touch.body].triangles.empty()) continue;
      const std::array<int, 3>& nodes = surfaces_[touch.body].nodes(touches_[i].triangle);
      const auto has = [&nodes](int node) { return node < 0 || std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
      if (has(touch.node[0]) && has(touch.node[1])) return true;
    }
  }
  return std::any_of(acting_.begin(), acting_.end(), [&](const Touch& a) { return dot(a.direction, touch.direction) > smooth_cosine; });
}

void WallContacts::select_touches() {
  std::sort(touches_.begin(), touches_.end(), [](const Touch& a, const Touch& b) {
    const double s = std::abs(a.distance), t = std::abs(b.distance);
    if (s != t) return s < t;
    if (a.feature != b.feature) return a.feature < b.feature;
    return a.body != b.body ? a.body < b.body : a.triangle < b.triangle;
  });
  acting_.clear();
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    // Planes have no back: each of them pushes back what is beyond it.
    const bool behind = i > 0 && touches_[i].distance < 0 && walls_->bodies()[touches_[i].body].planes.empty();
    if (!behind && !repeats(touches_[i], i)) acting_.push_back(touches_[i]);
  }
}

/// Slip of the old contact of the particle at work with the same wall and nearly the same direction (frame of the wall); none: zero.
Vec3 WallContacts::old_slip(int body, const Vec3& direction) {
  double best = smooth_cosine;
  std::size_t found = old_end_;
  for (std::size_t i = old_begin_; i < old_end_; ++i) {
    const double cosine = dot(old_slips_[i].normal, direction);
    if (old_slips_[i].body == body && !used_[i - old_begin_] && cosine > best) best = cosine, found = i;
  }
  if (found == old_end_) return {};
  used_[found - old_begin_] = 1;
  return old_slips_[found].slip;
}

void WallContacts::put(ContactParticles& particles, const Particle& p, const Touch& touch) {
  Block& block = *block_;
  if (block.n == contact_block_size || block.pair != &pairs[p.rag]) {
    evaluate(particles);
    block.pair = &pairs[p.rag];
  }
  const WallPose& pose = poses_[touch.body];
  const bool moves = walls_->bodies()[touch.body].motion.moves();
  const double s = touch.distance, radius = pairs[p.rag].reach;
  const Vec3 n = -touch.direction, arm = s * n;
  const Vec3 direction = moves ? pose.turned_back(touch.direction) : touch.direction, slip = old_slip(touch.body, direction);
  const int c = block.n++;
  const WallBody& body = walls_->bodies()[touch.body];
  const int part = body.planes.empty() ? surfaces_[touch.body].part(touch.triangle) : body.planes[touch.triangle].part;
  block.place[c] = {p.number, touch.body, part, p.id, direction, p.x + arm, arm};
  block.overlap[c] = std::min(radius - s, 2 * radius), block.weight[c] = 1;
  snag::put(block.normal, c, n);
  snag::put(block.velocity, c, p.v + cross(p.w, arm) - (moves ? pose.velocity_at(p.x + arm) : Vec3{}));
  snag::put(block.spin, c, p.w - pose.spin);
  snag::put(block.slip, c, moves ? pose.turned(slip) : slip);
  max_overlap_over_radius[p.rag] = std::max(max_overlap_over_radius[p.rag], (radius - s) / radius);
  ++n_contacts;
}

void WallContacts::evaluate(ContactParticles& particles) {
  Block& block = *block_;
  if (block.n == 0) return;
  block.pair->law->evaluate(block, block.pair->rolling, step_);
  for (int c = 0; c < block.n; ++c) {
    const Block::Place& place = block.place[c];
    ParticleLoad& load = particles.load[place.particle];
    const Vec3 normal = snag::get(block.normal, c), force = snag::get(block.force, c), rolling = snag::get(block.rolling, c);
    load.add(force, cross(place.arm, force) + rolling);
    if (step_ > 0)
      impulses[place.part].add({.point = place.point, .normal = normal, .force = force, .rolling_torque = rolling}, poses_[place.body],
                               axes_[place.body], step_);
    if (held_)
      (*held_)[place.particle].add(normal, block.pair->law->rates(block.overlap[c], step_), (1 / block.pair->radius_1) * place.arm);
    const Vec3 slip = snag::get(block.slip, c);
    slips.push_back(
        {place.id, place.body, place.direction, walls_->bodies()[place.body].motion.moves() ? poses_[place.body].turned_back(slip) : slip});
  }
  block.n = 0;
}

ContactRegion WallContacts::region_of(const Touch& touch, const Vec3& centre) const {
  if (walls_->bodies()[touch.body].motion.moves()) return ContactRegion::moving;
  if (!tongue) return ContactRegion::other;
  const Vec3 away = centre - touch.distance * touch.direction - tongue->point;
  return norm(away - dot(away, tongue->direction) * tongue->direction) <= tongue->reach ? ContactRegion::tongue : ContactRegion::other;
}

void WallContacts::count_touches(const Particle& p) {
  std::array<bool, n_contact_regions> here{};
  for (const Touch& touch : acting_) here[static_cast<int>(region_of(touch, p.x))] = true;
  for (int region = 0; region < n_contact_regions; ++region) {
    if (!here[region]) continue;
    WallTouch& touch = touched[p.rag * n_contact_regions + region];
    ++touch.now, ++touch.since_reset;
  }
}

/// Particles found beyond a wall earlier and out of reach of it now are beyond it still; those with a smaller id than the one at work come
/// first.
void WallContacts::keep_beyond(const ContactParticles& particles, std::int64_t before, std::size_t& next_old) {
  for (; next_old < old_beyond_.size() && old_beyond_[next_old] < before; ++next_old) {
    const std::int64_t id = old_beyond_[next_old];
    auto row =
        std::upper_bound(particles.rows.begin(), particles.rows.end(), id, [](std::int64_t i, const ParticleRow& r) { return i < r.id; });
    if (row == particles.rows.begin()) continue;
    --row;
    if (row->owned && id < row->id + row->count) beyond.push_back(id);
  }
}

void WallContacts::note_beyond(const Particle& p, std::size_t& next_old) {
  const bool was = next_old < old_beyond_.size() && old_beyond_[next_old] == p.id;
  if (was) ++next_old;
  bool past_plane = false, past_nearest = false;
  double nearest = infinity;
  for (const Touch& touch : touches_) {
    const bool past = touch.distance < 0;
    past_plane = past_plane || (past && !walls_->bodies()[touch.body].planes.empty());
    if (std::abs(touch.distance) < nearest) nearest = std::abs(touch.distance), past_nearest = past;
  }
  const bool is = touches_.empty() ? was : past_plane || past_nearest;
  if (is) beyond.push_back(p.id);
}

}  // namespace snag
