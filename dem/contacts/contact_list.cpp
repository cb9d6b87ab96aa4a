#include "dem/contacts/contact_list.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {
constexpr double most_cells = 4e6;  // 16 MB of cell starts; wider cells beyond that
}

ContactList::ContactList(const std::vector<Rag>& rags, double skin) : rags_(&rags), skin_(skin) {
  double surface = 0, layer = 0;
  for (const Rag& rag : rags) surface = std::max(surface, rag.surface_reach()), layer = std::max(layer, rag.layer_reach());
  furthest_ = std::hypot(surface, 2 * layer);
}

void ContactList::build(ContactParticles& particles, ListedPairs listed) {
  pairs.clear();
  if (listed.within_pieces || listed.between_pieces) sort_into_cells(particles);
  for (ParticleRow& row : particles.rows) row.near = false;
  for (int p = 0; p < particles.size(); ++p) {
    if (!particles.present[p] || !(listed.within_pieces || listed.between_pieces)) continue;
    partners_.clear();
    find_partners(particles, p, listed);
    std::sort(partners_.begin(), partners_.end());
    for (int q : partners_) {
      pairs.push_back({p, q, particles.near_on_lattice(p, q)});
      particles.rows[particles.row_of[q]].near = true;
    }
    if (!partners_.empty()) particles.rows[particles.row_of[p]].near = true;
  }

  std::stable_sort(stored_.begin(), stored_.end());
  slip.assign(pairs.size(), {});
  std::size_t i = 0;
  for (const StoredSlip& old : stored_) {
    const auto before = [&](const NearPair& pair) {
      const std::int64_t low = particles.id(pair.p);
      return low != old.low ? low < old.low : particles.id(pair.q) < old.high;
    };
    while (i < pairs.size() && before(pairs[i])) ++i;
    if (i == pairs.size()) break;
    if (particles.id(pairs[i].p) == old.low && particles.id(pairs[i].q) == old.high) slip[i] = {old.slip.x, old.slip.y, old.slip.z, 1};
  }
  stored_.clear();
}

void ContactList::sort_into_cells(const ContactParticles& particles) {
  Vec3 lower{infinity, infinity, infinity}, upper = -lower;
  for (int p = 0; p < particles.size(); ++p) {
    if (!particles.present[p]) continue;
    const ParticlePosition& x = particles.position[p];
    lower = {std::min(lower.x, x.x), std::min(lower.y, x.y), std::min(lower.z, x.z)};
    upper = {std::max(upper.x, x.x), std::max(upper.y, x.y), std::max(upper.z, x.z)};
  }
  if (!(lower.x <= upper.x)) lower = upper = {};
  cell_width_ = cutoff();
  const double limit = std::max(most_cells, 4.0 * particles.size());
  const auto n_cells = [&] {
    double n = 1;
    for (int d = 0; d < 3; ++d) n *= std::floor((upper[d] - lower[d]) / cell_width_) + 3;
    return n;
  };
  while (n_cells() > limit) cell_width_ *= 1.26;  // cube root of 2
  for (int d = 0; d < 3; ++d) cells_[d] = static_cast<int>((upper[d] - lower[d]) / cell_width_) + 3;
  origin_ = lower - Vec3{cell_width_, cell_width_, cell_width_};

  cell_start_.assign(std::size_t(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  cell_of_.resize(particles.size());
  for (int p = 0; p < particles.size(); ++p) {
    if (!particles.present[p]) continue;
    const ParticlePosition& x = particles.position[p];
    const auto along = [this](double from_origin, int d) {
      return std::clamp(static_cast<int>(from_origin / cell_width_), 1, cells_[d] - 2);
    };
    cell_of_[p] = (along(x.z - origin_.z, 2) * cells_[1] + along(x.y - origin_.y, 1)) * cells_[0] + along(x.x - origin_.x, 0);
    ++cell_start_[cell_of_[p] + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  sorted_.resize(cell_start_.back());
  // Filled from the back: each start ends up where the cell's particles begin.
  for (int p = particles.size() - 1; p >= 0; --p)
    if (particles.present[p]) sorted_[--cell_start_[cell_of_[p] + 1]] = p;
  for (std::size_t c = 0; c + 1 < cell_start_.size(); ++c) cell_start_[c] = cell_start_[c + 1];
  cell_start_.back() = static_cast<int>(sorted_.size());
}

void ContactList::find_partners(const ContactParticles& particles, int p, ListedPairs listed) {
  const ParticlePosition a = particles.position[p];
  const Rag& rag = (*rags_)[particles.rag_of(p)];
  const double furthest = cutoff() * cutoff();
  const bool owned = particles.owned(p);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      const int cell = cell_of_[p] + (dz * cells_[1] + dy) * cells_[0];
      for (int s = cell_start_[cell - 1]; s < cell_start_[cell + 2]; ++s) {
        const int q = sorted_[s];
        if (q <= p) continue;
        const ParticlePosition& b = particles.position[q];
        const double dx = b.x - a.x, dy_ = b.y - a.y, dz_ = b.z - a.z, square = dx * dx + dy_ * dy_ + dz_ * dz_;
        if (square >= furthest) continue;
        if (!(particles.rag_of(p) == particles.rag_of(q) ? listed.within_pieces : listed.between_pieces)) continue;
        const Rag& other = (*rags_)[particles.rag_of(q)];
        const double limit =
            skin_ + (particles.near_on_lattice(p, q) ? rag.layer_reach() + other.layer_reach() : contact_distance(rag, other));
        if (square < limit * limit && (owned || particles.owned(q)) && !particles.bonded(p, q)) partners_.push_back(q);
      }
    }
  }
}

std::vector<StoredSlip> ContactList::touching(const ContactParticles& particles) const {
  std::vector<StoredSlip> all;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (slip[i].touching > 0) all.push_back({particles.id(pairs[i].p), particles.id(pairs[i].q), {slip[i].x, slip[i].y, slip[i].z}});
  return all;
}

void ContactList::store(const std::vector<StoredSlip>& slips) { stored_.insert(stored_.end(), slips.begin(), slips.end()); }

}  // namespace snag
