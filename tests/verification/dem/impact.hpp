#pragma once
// Single impacts of spheres, followed from touching to parting.
#include "dem/contacts/contact_pair.hpp"
#include "dem/walls/walls.hpp"
#include "tests/unit/dem/contact_pieces.hpp"

namespace snag::testing_impact {

using test::Pieces;

struct Impact {
  double duration = 0, deepest = 0, speed_after = 0;
  Vec3 velocity, spin;  // of the last sphere
};

/// Advance until the two spheres (or sphere and plane) part; `gap` is the overlap now, positive in contact. The times of touching and
/// parting are interpolated linearly.
inline Impact run_impact(Pieces& pieces, ContactSolver& contacts, double step, const std::function<double()>& overlap) {
  Impact impact;
  double before = overlap(), start = 0;
  bool touched = false;
  for (int k = 1; k < 1000000; ++k) {
    pieces.advance(contacts, step);
    const double now = overlap();
    if (!touched && now > 0) touched = true, start = (k - now / (now - before)) * step;
    impact.deepest = std::max(impact.deepest, now);
    if (touched && now <= 0) {
      impact.duration = (k - now / (now - before)) * step - start;
      break;
    }
    before = now;
  }
  const int last = static_cast<int>(pieces.tiles.size()) - 1;
  impact.velocity = pieces.get(last, Tile::vx), impact.spin = pieces.get(last, Tile::wx);
  return impact;
}

inline ContactSettings settings_of(double restitution, double friction) {
  ContactSettings s;
  s.restitution = s.wall_restitution = restitution;
  s.static_friction = s.wall_friction = friction;
  s.rolling_friction = 0;
  return s;
}

}  // namespace snag::testing_impact
